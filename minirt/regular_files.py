"""Reads regular files, of a limited size and without waiting for anything."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from minirt.errors import FileError


def reason(error: OSError | ValueError) -> str:
    """Why the system does not do something with a file; a ValueError is about a path that no file can have."""
    return str(error.strerror).lower() if isinstance(error, OSError) else "no file can have this name"


def status(path: str | os.PathLike[str], largest: int) -> os.stat_result:
    """What is known of a regular file of at most `largest` bytes; FileError where it is something else."""
    try:
        return check_regular(path, Path(path).stat(), largest)
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None


def read(path: str | os.PathLike[str], largest: int) -> bytes:
    """The bytes of a regular file; FileError where there are more than `largest`, or none to be had.

    What is not a regular file is refused before it is opened, and opening does not wait, so that a FIFO or a device
    that takes the file's place in between cannot hang the program.
    """
    status(path, largest)
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(descriptor, "rb") as file:
            check_regular(path, os.fstat(descriptor), largest)
            data = file.read(largest + 1)
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None
    check_size(path, len(data), largest)
    return data


def check_regular(path: str | os.PathLike[str], found: os.stat_result, largest: int) -> os.stat_result:
    """The same; FileError where it is not that of a regular file of at most `largest` bytes."""
    if stat.S_ISDIR(found.st_mode):
        raise FileError(path, "is a folder")
    if not stat.S_ISREG(found.st_mode):
        raise FileError(path, "is not a regular file")
    check_size(path, found.st_size, largest)
    return found


def check_size(path: str | os.PathLike[str], size: int, largest: int) -> None:
    """FileError where a file has more bytes than it may."""
    if size > largest:
        raise FileError(path, f"larger than {largest // 2**20} MiB")
