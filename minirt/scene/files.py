"""Read and decode the bytes of a scene file; SceneError when it is unreadable or not text."""

from __future__ import annotations

import os
from pathlib import Path

from minirt.errors import FileError, Problem, SceneError
from minirt.helpers import file_io
from minirt.scene import in_picture

SUFFIX = ".rt"
MAX_BYTES = 64 * 2**20  # 64 MiB
MAX_LINES = MAX_BYTES // 16  # the line of a shape has more than 16 bytes

NO_ELEMENTS = "holds only blanks and comments"

UTF16 = (b"\xff\xfe", b"\xfe\xff")  # byte order marks


def file_error(path: str | os.PathLike[str], message: str) -> SceneError:
    """Return an error about a file as a whole, without a line."""
    return SceneError((Problem(os.fspath(path), 0, 0, "", message),))


def check_name(path: str | os.PathLike[str]) -> None:
    """Check that the file name ends in `.rt` and is more than that; SceneError otherwise."""
    if in_picture.is_picture(path):
        raise file_error(path, "a scene is not written over its picture; Ctrl+Shift+S in the window writes a copy")
    name = Path(path).name
    if not name.endswith(SUFFIX) or name == SUFFIX:
        raise file_error(path, f"the name of a scene file ends in '{SUFFIX}'")


def read(path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a scene file, or of the scene that a PNG picture carries; SceneError when it cannot be
    read."""
    if not in_picture.is_picture(path):
        check_name(path)
    try:
        if in_picture.is_picture(path):
            return in_picture.read(path, MAX_BYTES)
        return file_io.read(path, MAX_BYTES)
    except FileError as error:
        raise file_error(path, error.reason) from None


def decode(data: bytes, file: str) -> str:
    """Return the text of a scene file; SceneError when it is empty, not UTF-8 text, or of too many lines."""
    if not data.strip():
        raise file_error(file, NO_ELEMENTS if data else "is empty")
    if data.startswith(UTF16):
        raise byte_error(data, 0, file, "must be UTF-8, got UTF-16")
    nul = data.find(b"\0")
    if nul >= 0:
        raise byte_error(data, nul, file, "must be text, got a NUL byte")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        raise byte_error(data, error.start, file, f"must be UTF-8, got the byte 0x{data[error.start]:02x}") from None
    if (lines := text.count("\n")) > MAX_LINES:
        raise file_error(file, f"has {lines:,} lines, more than {MAX_LINES:,}")
    return text


def byte_error(data: bytes, index: int, file: str, message: str) -> SceneError:
    """Return an error about the byte at `index`, with its line and column."""
    begin = data.rfind(b"\n", 0, index) + 1
    end = data.find(b"\n", index)
    line = data[begin : end if end >= 0 else len(data)]
    column = len(data[begin:index].decode("utf-8-sig" if begin == 0 else "utf-8", "replace")) + 1
    text = line.decode("utf-8-sig" if begin == 0 else "utf-8", "replace")
    return SceneError((Problem(file, data.count(b"\n", 0, index) + 1, column, text, message),))
