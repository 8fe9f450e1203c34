"""Journal file: the text of a scene file as it was opened, and the changes since.

The first line is JSON: the version, the path of the scene file, and the length of its text in bytes. The text follows,
then one line of JSON for each change: [first line, number of lines that it replaces, [new lines]]. A last line that the
program did not finish is ignored.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import NamedTuple

from minirt.helpers import file_io
from minirt.viewer.recovery.splice import Splice

VERSION = 1
LARGEST = 2**30  # bytes


class Contents(NamedTuple):
    """Contents of a journal."""

    file: Path  # the scene file
    base: str  # its text before the changes
    text: str  # its text with all changes


def beginning(file: Path, base: bytes) -> bytes:
    """Return the first bytes of a journal; `base` is the text of the scene file before the changes."""
    header = {"journal": VERSION, "file": os.fspath(file), "bytes": len(base)}
    return json.dumps(header).encode() + b"\n" + base + b"\n"


def record(splice: Splice) -> bytes:
    """Return the line of a change."""
    return json.dumps(splice).encode() + b"\n"


def read(path: Path) -> Contents:
    """Read a journal. FileError where it cannot be read, ValueError where it is damaged before its last line."""
    data = file_io.read(path, LARGEST)
    try:
        return contents(data)
    except (KeyError, OverflowError, RecursionError, TypeError) as error:
        raise ValueError("a line has other values than a journal") from error


def contents(data: bytes) -> Contents:
    """Return the contents of a journal; where it is damaged ValueError, or what values of other types raise."""
    header, _, rest = data.partition(b"\n")
    values = json.loads(header)
    if not isinstance(values, dict) or values.get("journal") != VERSION:
        raise ValueError("not a journal of this version")
    file, length = Path(str(values["file"])), int(values["bytes"])
    if not 0 <= length < len(rest):
        raise ValueError("ends within the text of the scene")
    base = rest[:length].decode()
    lines = base.split("\n")
    for change in rest[length + 1 :].split(b"\n")[:-1]:
        start, removed, new = json.loads(change)
        Splice(int(start), int(removed), [str(line) for line in new]).apply(lines)
    text = "\n".join(lines)
    text.encode()  # a half of a surrogate pair, which JSON can hold, cannot be saved: UnicodeEncodeError
    return Contents(file, base, text)
