"""Files: written as a whole or not at all, read if they are regular, locked, and kept for this user alone."""

from __future__ import annotations

import errno
import os
import re
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import wraps
from pathlib import Path
from typing import BinaryIO, TypeVar

from minirt.errors import FileError, RenderError
from minirt.helpers.system import ForkSafeLock, size_in_words

if sys.platform != "win32":
    import fcntl

Content = TypeVar("Content")
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
    """Write a temporary file, with no more than the given permissions, which the block renames; it is deleted when
    that fails."""
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


def lock(descriptor: int) -> bool:
    """Lock an open file until it is closed or the process ends, unless another program has; whether none has.

    A system or file system without locks never has another program's.
    """
    if sys.platform != "win32":
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:
            pass
    return True


def unlock(descriptor: int) -> None:
    """Close a locked file, and free the lock at once, also where a process was forked that has the file open. An error
    of the disk does not matter."""
    if sys.platform != "win32":
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_UN)
    with suppress(OSError):
        os.close(descriptor)


LFS_POINTER = b"version https://git-lfs.github.com/spec/"
LARGEST_ASSET = 256 * 2**20  # bytes of a picture or mesh file that a scene names


def located(folder: Path, name: str) -> Path:
    """Return the path of a file that a scene in a folder names: there, or else in the nearest folder above that has it,
    up to the working folder."""
    path = folder / name
    if found(path):
        return path
    with suppress(OSError):  # the working folder was deleted
        working = Path.cwd()
        for above in Path(os.path.abspath(folder)).parents:  # noqa: PTH100 - links are not followed
            if above.is_relative_to(working) and is_file(above / name):
                return above / name
    return path


def found(path: str | os.PathLike[str]) -> os.stat_result | None:
    """Return the status of a file or folder that somebody names; None where there is none, or where the system does not
    let it be looked at: it has a name of 300 letters, lies in a folder of others or on a failing disk."""
    with suppress(OSError, ValueError):
        return Path(path).stat()
    return None


def is_file(path: str | os.PathLike[str]) -> bool:
    """Whether a name is that of a regular file."""
    return bool((status := found(path)) and stat.S_ISREG(status.st_mode))


def is_folder(path: str | os.PathLike[str]) -> bool:
    """Whether a name is that of a folder."""
    return bool((status := found(path)) and stat.S_ISDIR(status.st_mode))


def is_absent(path: str | os.PathLike[str]) -> bool:
    """Whether a folder that is there has no file of a name, which a file may have."""
    try:
        Path(path).lstat()
    except FileNotFoundError:
        return is_folder(Path(path).parent)
    except (OSError, ValueError):
        return False
    return False


def reason(error: OSError | ValueError) -> str:
    """Return the system's reason for a failure; a ValueError is about a path that no file can have."""
    return str(error.strerror).lower() if isinstance(error, OSError) else "no file can have this name"


def status(path: str | os.PathLike[str], largest: int) -> os.stat_result:
    """Return the status of a regular file of at most `largest` bytes; FileError for anything else."""
    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None
    if not stat.S_ISREG(status.st_mode):
        raise FileError(path, "is a folder" if stat.S_ISDIR(status.st_mode) else "is not a regular file")
    check_size(path, status.st_size, largest)
    return status


def read(path: str | os.PathLike[str], largest: int) -> bytes:
    """Return the bytes of a regular file; FileError when it has more than `largest`, cannot be read, or is a pointer of
    Git LFS.

    Anything but a regular file is refused before it is opened: a FIFO cannot hang the program.
    """
    status(path, largest)
    try:
        data = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None
    check_size(path, len(data), largest)
    if data.startswith(LFS_POINTER):
        raise FileError(path, "is a pointer of Git LFS in place of the file: 'git lfs pull' fetches it")
    return data


STREAM = re.compile(r"/dev/(?:null|std(?:in|out|err)|fd/[0-9]+)")


def is_stream(path: str | os.PathLike[str]) -> bool:
    """Whether a name is that of an open stream of this process, as `<(...)` of a shell gives it, or of none at all.

    It is for names that the user gives: one in a scene must not read what somebody else has opened.
    """
    return STREAM.fullmatch(os.fspath(path)) is not None


def read_given(path: str | os.PathLike[str], largest: int) -> bytes:
    """Return the bytes of a regular file or a stream that the user names, as `read`. FileError."""
    if not is_stream(path):
        return read(path, largest)
    try:
        with Path(path).open("rb") as stream:
            data = stream.read(largest + 1)
    except OSError as error:
        raise FileError(path, f"cannot be read: {reason(error)}") from None
    check_size(path, len(data), largest)
    return data


def read_once(read: Callable[[Path], Content]) -> Callable[[str | os.PathLike[str]], Content]:
    """Decorate a reader of a file that a scene names: it gives the same object until the file changes, or one of the
    `libraries` that the object names. FileError."""
    entries: dict[str, tuple[list[tuple[int, ...]], Content]] = {}
    lock = ForkSafeLock()

    @wraps(read)
    def cached(path: str | os.PathLike[str]) -> Content:
        status(path, LARGEST_ASSET)
        key = os.path.abspath(path)  # noqa: PTH100 - a link is not followed: its target may change
        with lock:
            if key not in entries or entries[key][0] != stamps(path, *getattr(entries[key][1], "libraries", ())):
                entries.pop(key, None)
                content = read(Path(path))
                entries[key] = stamps(path, *getattr(content, "libraries", ())), content
            return entries[key][1]

    return cached


def stamps(*paths: str | os.PathLike[str]) -> list[tuple[int, ...]]:
    """Return numbers that differ when one of some files has changed; a file that is not there has none."""
    return [(each.st_dev, each.st_ino, each.st_size, each.st_mtime_ns) for each in filter(None, map(found, paths))]


def check_size(path: str | os.PathLike[str], size: int, largest: int) -> None:
    """Check that a file has at most `largest` bytes; FileError otherwise."""
    if size > largest:
        raise FileError(path, f"larger than {size_in_words(largest)}")


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
