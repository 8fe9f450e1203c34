"""Files that scenes and users name: where they are, and their bytes if they are regular files."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import TypeVar

from minirt.errors import FileError
from minirt.helpers.system import ForkSafeLock, size_in_words

Content = TypeVar("Content")
LFS_POINTER = b"version https://git-lfs.github.com/spec/"
STREAM = re.compile(r"/dev/(?:null|std(?:in|out|err)|fd/[0-9]+)")
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
    """Decorate a reader of a file that a scene names: it returns the same object until the file changes, or one of the
    `libraries`, paths of further files, which the object may name. FileError."""
    entries: dict[str, tuple[list[tuple[int, ...]], Content]] = {}  # by path: the stamps of these files, and the object
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
