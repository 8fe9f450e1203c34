"""Files that are written as a whole or not at all."""

from __future__ import annotations

import errno
import os
import re
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from minirt.errors import RenderError
from minirt.helpers.file_io.private import PRIVATE_FILE

Data = bytes | Callable[[BinaryIO], object]  # contents, or a function that writes them to a file, which can seek
TEMPORARY = ".minirt-*.tmp"
OF_KILLED = re.compile(r"\.minirt-[0-9a-f]{16}\.tmp")  # names of temporary files, of which a killed program leaves one
KEPT = 24 * 3600  # seconds that such a file is kept, since the program may run
SWEPT: set[str] = set()  # folders that were searched for them
FLAGS = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)  # of a file that must not exist yet


def write(path: str | os.PathLike[str], data: Data, permissions: int | None = None) -> None:
    """Replace the contents of a file by `data` in one step; OSError when that fails, and nothing is left behind.

    A symbolic link stays, and its target is replaced. An existing file keeps its permissions, unless others are asked
    for, and where the system allows it its owner and extended attributes. Other hard links keep the old contents.
    """
    target = Path(os.path.realpath(path))
    existing = status_of_existing(target)
    if existing and permissions is None:
        permissions = stat.S_IMODE(existing.st_mode)
    with temporary_file(target.parent, data, permissions) as temporary:
        if existing and sys.platform == "linux":
            with suppress(OSError):
                os.chown(temporary, existing.st_uid, existing.st_gid)
            with suppress(OSError):
                for name in os.listxattr(target):  # such as access control lists
                    os.setxattr(temporary, name, os.getxattr(target, name))
        if permissions is not None:
            temporary.chmod(permissions)
        temporary.replace(target)


def probe(path: str | os.PathLike[str]) -> None:
    """Check what can be checked of `write` without writing: OSError where the folder or the file rules it out."""
    target = Path(os.path.realpath(path))
    status_of_existing(target)
    if not stat.S_ISDIR(target.parent.stat().st_mode):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


@contextmanager
def told_errors(path: str | os.PathLike[str], what: str = "cannot write") -> Iterator[None]:
    """Raise the system's errors in the block as RenderError: a picture or a film cannot be written to a file."""
    try:
        yield
    except OSError as error:
        reason = "there is no such folder" if isinstance(error, FileNotFoundError) else error.strerror or error
        raise RenderError(f"{os.fspath(path)}: {what}: {reason}") from None


def create(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a new file as a whole; FileExistsError when there is one already, another OSError when that fails.

    Of several programs that create the same file at once, one succeeds, if the file system has hard links.
    """
    target = Path(path)
    with temporary_file(target.parent, data) as temporary:
        try:
            os.link(temporary, target)
        except OSError:
            if os.path.lexists(target):
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target)) from None
            temporary.replace(target)
        delete(temporary)


@contextmanager
def temporary_file(folder: Path, data: Data, permissions: int | None = None) -> Iterator[Path]:
    """Write data to a temporary file in a folder, and give its path to the block, which renames or deletes it.

    The file is deleted when writing or the block fails. The data are bytes, or a function that writes them to the open
    file. With `permissions` nobody but the user can open the file, until the block gives it these.
    """
    sweep(folder)
    path = folder / TEMPORARY.replace("*", os.urandom(8).hex())
    try:  # before the file is there: an interrupt may come behind every instruction
        descriptor = os.open(path, FLAGS, 0o666 if permissions is None else permissions & PRIVATE_FILE)
        with os.fdopen(descriptor, "wb") as file:
            if callable(data):
                data(file)
            else:
                file.write(data)
            file.flush()
            os.fsync(descriptor)
        yield path
    except BaseException:
        delete(path)
        raise


def sweep(folder: Path) -> None:
    """Delete the old temporary files of killed programs in a folder, once in each process."""
    name = os.path.abspath(folder)  # noqa: PTH100 - the folder is written to by this name
    if name in SWEPT:
        return
    SWEPT.add(name)
    with suppress(OSError), os.scandir(name) as entries:
        for each in entries:
            if OF_KILLED.fullmatch(each.name) and each.is_file(follow_symlinks=False):
                written = each.stat(follow_symlinks=False).st_mtime
                if written < time.time() - KEPT:
                    delete(Path(each.path))


def delete(*paths: Path) -> None:
    """Delete files, as far as they are there and can be deleted."""
    for each in paths:
        with suppress(OSError):
            each.unlink()


def status_of_existing(target: Path) -> os.stat_result | None:
    """Return the status of an existing file, None without one; OSError when it must not be replaced."""
    try:
        status = target.stat()
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "it is a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file")
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    return status
