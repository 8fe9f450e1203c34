"""Atomic file writing: as a whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from minirt import file_locks

PRIVATE = 0o600
TEMPORARY = ".minirt-*.tmp"
ABANDONED = 3600  # seconds after which a temporary file belongs to a killed program, where there are no locks
FLAGS = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)  # of a file that must not exist yet
LOOK = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)
CLEANED: set[Path] = set()  # folders in which this process has deleted abandoned files


def write(
    path: str | os.PathLike[str], data: bytes | Callable[[BinaryIO], object], permissions: int | None = None
) -> None:
    """Replace the contents of a file by `data` in one step; OSError when that fails, and nothing is left behind.

    `data` may be a function that writes to the file, which can seek.

    A symbolic link stays, and its target is replaced. An existing file keeps its permissions, unless others are asked
    for, its extended attributes and, where the system allows it, its owner. The file never has more permissions than
    it has in the end. Other hard links keep the old contents.
    """
    target = Path(os.path.realpath(path))
    existing = status_of_existing(target)
    with temporary_file(target, data, existing, permissions) as temporary:
        temporary.replace(target)
    delete_abandoned(target.parent)


def probe(path: str | os.PathLike[str]) -> None:
    """Check what can be checked of `write` without writing: OSError where the folder or the file rules it out."""
    target = Path(os.path.realpath(path))
    status_of_existing(target)
    if not stat.S_ISDIR(target.parent.stat().st_mode):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def create(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a new file as a whole; FileExistsError when there is one already, another OSError when that fails.

    Of several programs that create the same file at once, one succeeds.
    """
    target = Path(path)
    if os.path.lexists(target):
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
    with temporary_file(target, data, None, None) as temporary:
        try:
            os.link(temporary, target)
        except FileExistsError:
            raise
        except OSError:  # a file system without hard links
            create_in_place(target, data)
        temporary.unlink()


def create_in_place(target: Path, data: bytes) -> None:
    """Write a new file under its own name: others may see a part of it for a moment."""
    with target.open("xb") as file:
        try:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        except BaseException:
            target.unlink()
            raise


@contextmanager
def temporary_file(
    target: Path,
    data: bytes | Callable[[BinaryIO], object],
    existing: os.stat_result | None,
    permissions: int | None,
) -> Iterator[Path]:
    """Write a temporary file beside the target, with the permissions and the owner of the existing file, if any.

    It is locked until the block ends, and deleted when the block fails.
    """
    kept = stat.S_IMODE(existing.st_mode) if existing else None
    mode = kept if permissions is None else permissions
    temporary, descriptor = create_temporary(target.parent, 0o666 if mode is None else mode & PRIVATE)
    with ExitStack() as stack:
        try:
            with os.fdopen(descriptor, "wb") as file:
                if sys.platform != "win32":  # where an open file could not be renamed; a duplicate shares the lock
                    stack.callback(os.close, os.dup(descriptor))
                if callable(data):
                    data(file)
                else:
                    file.write(data)
                file.flush()
                os.fsync(file.fileno())
            if existing:
                keep_owner(temporary, existing)
                copy_extended_attributes(target, temporary)
            if mode is not None:
                temporary.chmod(mode)
            yield temporary
        except BaseException:
            with suppress(OSError):
                temporary.unlink()
            raise


def create_temporary(folder: Path, mode: int) -> tuple[Path, int]:
    """Create a temporary file; return its path and its descriptor, which holds its lock."""
    while True:
        path = folder / TEMPORARY.replace("*", os.urandom(8).hex())
        descriptor = os.open(path, FLAGS, mode)
        if file_locks.lock(descriptor) and path.exists():
            return path, descriptor
        os.close(descriptor)  # another program took it for abandoned, before it was locked
        with suppress(OSError):
            path.unlink()


def keep_owner(path: Path, existing: os.stat_result) -> None:
    """Give a file the owner and the group of another one, as far as the system allows it."""
    status = path.stat()
    with suppress(OSError):
        if status.st_gid != existing.st_gid:
            os.chown(path, -1, existing.st_gid)
    with suppress(OSError):
        if status.st_uid != existing.st_uid:
            os.chown(path, existing.st_uid, -1)


def copy_extended_attributes(source: Path, target: Path) -> None:
    """Copy the extended attributes, such as access control lists, as far as the system allows it."""
    if not hasattr(os, "listxattr"):
        return
    with suppress(OSError):
        for name in os.listxattr(source):
            with suppress(OSError):
                os.setxattr(target, name, os.getxattr(source, name))


def delete_abandoned(folder: Path) -> None:
    """Delete temporary files that killed programs have left in a folder; each process looks once."""
    if folder in CLEANED:
        return
    CLEANED.add(folder)
    with suppress(OSError):
        for each in folder.glob(TEMPORARY):
            with suppress(OSError):
                delete_if_abandoned(each)


def delete_if_abandoned(path: Path) -> None:
    """Delete a temporary file that no program writes: its lock is free. OSError.

    Where locks cannot tell, the file is old, or from a future of a clock that was wrong.
    """
    with ExitStack() as stack:
        free = None
        if sys.platform != "win32":
            with suppress(PermissionError):  # of another user's file
                descriptor = os.open(path, LOOK)
                stack.callback(os.close, descriptor)
                free = file_locks.is_free(descriptor)  # and taken, so that a program that has just created it sees that
        if is_old(path) if free is None else free:
            path.unlink()


def is_old(path: Path) -> bool:
    """Whether a file was changed more than `ABANDONED` seconds ago, or is to be changed as late."""
    return abs(time.time() - path.lstat().st_mtime) > ABANDONED


def status_of_existing(target: Path) -> os.stat_result | None:
    """Return the status of an existing file, None without one; OSError when it must not be replaced."""
    try:
        status = target.stat()
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "not a regular file")
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    return status
