"""Files: written as a whole or not at all, read if they are regular, locked, and kept for this user alone."""

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

from minirt.errors import FileError

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
    temporary, descriptor = create_temporary(target.parent, 0o666 if mode is None else mode & PRIVATE_FILE)
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
        if lock(descriptor) and path.exists():
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
                free = is_free(descriptor)  # and taken, so that a program that has just created it sees that
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


if sys.platform != "win32":
    import fcntl


def lock(descriptor: int) -> bool:
    """Lock an open file until it is closed or the process ends, unless another program has; whether none has.

    A system or file system without locks never has another program's.
    """
    return is_free(descriptor) is not False


def is_free(descriptor: int) -> bool | None:
    """Lock an open file as `lock` does; None where there are no locks."""
    if sys.platform == "win32":
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


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


OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
PRIVATE_FILE, PRIVATE_FOLDER = 0o600, 0o700


def user_folder(variable: str = "XDG_CACHE_HOME", on_macos: str = "Caches", usual: str = ".cache") -> Path:
    """Return the folder of this user's files that may be deleted at any time, or of another kind that XDG names;
    RuntimeError where the user has no home.

    The XDG Base Directory Specification tells programs to ignore an XDG_CACHE_HOME that is relative."""
    named = Path(os.environ.get(variable, ""))
    if named.is_absolute():
        return named
    if sys.platform == "darwin":
        return Path.home() / "Library" / on_macos
    if sys.platform == "win32" and os.environ.get("LOCALAPPDATA"):
        return Path(os.environ["LOCALAPPDATA"])
    return Path.home() / usual


def is_private(status: os.stat_result) -> bool:
    """Whether nobody but this user can have written a file or a folder; on Windows the user's folder protects them."""
    return sys.platform == "win32" or (status.st_uid == os.geteuid() and not status.st_mode & OTHERS_WRITE)
