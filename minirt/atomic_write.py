"""Atomic file writing: as a whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from functools import partial
from pathlib import Path


def write(path: str | os.PathLike[str], data: bytes, permissions: int | None = None) -> None:
    """Replace the contents of a file by `data` in one step; OSError when that fails, and nothing is left behind.

    A symbolic link stays, and its target is replaced; an existing file keeps its permissions, unless others are asked
    for: then the file never has more than these.
    """
    target = Path(os.path.realpath(path))
    existing = mode_of_existing(target)
    mode = existing if permissions is None else permissions
    temporary = target.with_name(f".minirt-{os.urandom(8).hex()}.tmp")
    try:
        with open(temporary, "xb", opener=partial(os.open, mode=0o666 if permissions is None else permissions)) as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            temporary.chmod(mode)
        temporary.replace(target)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise


def mode_of_existing(target: Path) -> int | None:
    """Return the permissions of an existing file, None without one; OSError when it must not be replaced."""
    try:
        mode = target.stat().st_mode
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "not a regular file")
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    return stat.S_IMODE(mode)
