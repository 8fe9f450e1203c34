"""Read regular files of limited size; FIFOs and devices are refused without waiting for them."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from minirt.errors import FileError

LARGEST_ASSET = 256 * 2**20  # bytes of a picture or mesh file that a scene names


def reason(error: OSError | ValueError) -> str:
    """Return the system's reason for a failure; a ValueError is about a path that no file can have."""
    return str(error.strerror).lower() if isinstance(error, OSError) else "no file can have this name"


def status(path: str | os.PathLike[str], largest: int) -> os.stat_result:
    """Return the status of a regular file of at most `largest` bytes; FileError for anything else."""
    try:
        return check_regular(path, Path(path).stat(), largest)
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None


def read(path: str | os.PathLike[str], largest: int) -> bytes:
    """Return the bytes of a regular file; FileError when it has more than `largest` or cannot be read.

    Anything but a regular file is refused before it is opened, and opening does not block: a FIFO or a device that
    takes the file's place in between cannot hang the program.
    """
    status(path, largest)
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(descriptor, "rb") as file:
            size = check_regular(path, os.fstat(descriptor), largest).st_size
            data = read_at_once(file, size + 1)  # Python reserves memory for as many bytes as it is asked for
            if len(data) > size:  # the file grows
                data += read_at_once(file, largest + 1 - len(data))
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None
    check_size(path, len(data), largest)
    return data


def read_at_once(file: BinaryIO, size: int) -> bytes:
    """Return at most `size` bytes of an open file; OSError where it has none yet, as some files of /proc."""
    data: bytes | None = file.read(size)
    if data is None:
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
    return data


def check_regular(path: str | os.PathLike[str], status: os.stat_result, largest: int) -> os.stat_result:
    """Return `status`; FileError unless it is that of a regular file of at most `largest` bytes."""
    if stat.S_ISDIR(status.st_mode):
        raise FileError(path, "is a folder")
    if not stat.S_ISREG(status.st_mode):
        raise FileError(path, "is not a regular file")
    check_size(path, status.st_size, largest)
    return status


def check_size(path: str | os.PathLike[str], size: int, largest: int) -> None:
    """Check that a file has at most `largest` bytes; FileError otherwise."""
    if size > largest:
        raise FileError(path, f"larger than {largest // 2**20} MiB")
