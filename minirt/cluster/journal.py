"""Journal beside a picture in the making: which bands are in the file, where, and their digests.

A program that was killed goes on with the bands that are missing. A band counts where the file still has the bytes that
the journal names; so nothing needs to be in order on the disk.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

from minirt.rendering.outcome import Outcome

CHUNK = 2**22  # bytes that are read at once


class Entry(NamedTuple):
    """A band in the file."""

    band: int
    start: int  # byte at which its strips begin
    sizes: list[int]  # bytes of each
    digest: str
    reached: list[float] | None  # the values of its `Outcome`

    @property
    def end(self) -> int:
        """The byte behind the last strip."""
        return self.start + sum(self.sizes)

    @property
    def outcome(self) -> Outcome | None:
        """Samples and estimated error of the band."""
        return None if self.reached is None else Outcome(*self.reached)  # type: ignore[arg-type]


def read(path: Path, key: str, data: BinaryIO, strips: Sequence[int]) -> dict[int, Entry]:
    """Return the bands that a journal names and the file has, by their numbers; none where it is of another picture.

    `strips` are the numbers of strips of all bands."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        return {}
    if not lines or lines[0] != title(key):
        return {}
    possible = (each for each in entries(lines[1:]) if is_possible(each, strips))
    return {each.band: each for each in possible if digest_of(data, each) == each.digest}


def entries(lines: list[str]) -> Iterator[Entry]:
    """Yield the entries of a journal, up to a line that was not written as a whole."""
    for line in lines:
        try:
            yield Entry(**json.loads(line))
        except (ValueError, TypeError):
            return


def is_possible(entry: Entry, strips: Sequence[int]) -> bool:
    """Whether an entry is about a band that the picture has, with as many strips."""
    band, start, sizes, _, reached = entry
    return (
        isinstance(sizes, list)
        and all(isinstance(each, int) and each > 0 for each in (start, *sizes))
        and isinstance(band, int)
        and 0 <= band < len(strips)
        and len(sizes) == strips[band]
        and (reached is None or (isinstance(reached, list) and len(reached) == len(Outcome._fields)))
    )


def title(key: str) -> str:
    """Return the first line of the journal of a picture."""
    return json.dumps({"miniRT journal": 1, "picture": key})


def line(entry: Entry) -> str:
    """Return the line of an entry."""
    return json.dumps(entry._asdict()) + "\n"


def digest_of(file: BinaryIO, entry: Entry) -> str:
    """Return the digest of the bytes of a band in a file."""
    digest, left = hashlib.sha256(), sum(entry.sizes)
    file.seek(entry.start)
    while left > 0 and (data := file.read(min(left, CHUNK))):
        digest.update(data)
        left -= len(data)
    return digest.hexdigest()
