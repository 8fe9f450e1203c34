"""Files and folders that nobody but this user can have written, and locks between processes.

Machine code from a file of another user would run with the rights of this user. Windows has neither owners nor modes
in this sense: there the folder of the user protects its files.
"""

from __future__ import annotations

import os
import stat
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from minirt.helpers import file_io
from minirt.helpers.file_io import PRIVATE_FILE, PRIVATE_FOLDER, is_private
from minirt.kernel.machine_code.container import KEY_SIZE

if sys.platform != "win32":
    import fcntl

OTHERS_USE = stat.S_IRWXG | stat.S_IRWXO
PATIENCE = 60.0  # seconds; no kernel takes as long to compile
POLL = 0.01  # seconds between two attempts to lock a file
READ = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)  # does not wait for a pipe's writer


def require_own(path: Path, status: os.stat_result) -> None:
    """PermissionError where a file or a folder belongs to another user, or where others may write it."""
    if is_private(status):
        return
    if status.st_uid != os.geteuid():
        raise PermissionError(f"{path} belongs to another user; XDG_CACHE_HOME can name a folder of yours")
    raise PermissionError(f"other users may write {path}; chmod go-w '{path}' mends that")


def make_private_folder(path: Path) -> None:
    """Make a folder for this user alone, or close an existing one to others.

    PermissionError where others could have written to it before."""
    path.mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
    if sys.platform == "win32":
        return
    link = path.lstat()
    is_link = stat.S_ISLNK(link.st_mode)
    if is_link and link.st_uid != os.geteuid():  # it may lead to any folder of this user, `/` of root for one
        raise PermissionError(f"{path} is a link of another user; XDG_CACHE_HOME can name a folder of yours")
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | (0 if is_link else os.O_NOFOLLOW))
    try:
        status = os.fstat(descriptor)  # of the folder that is closed, whatever has the name by now
        require_own(path, status)
        if status.st_mode & OTHERS_USE:
            os.fchmod(descriptor, PRIVATE_FOLDER)
    finally:
        os.close(descriptor)


def read(path: Path) -> bytes:
    """Return the content of a regular file that only this user can have written; OSError for any other."""
    with os.fdopen(os.open(path, READ), "rb") as file:
        status = os.fstat(file.fileno())  # of the file that is read, whatever has the name by now
        require_own(path, status)
        if not stat.S_ISREG(status.st_mode):
            raise OSError(f"{path} is not a regular file")
        return file.read()


def write(path: Path, data: bytes) -> None:
    """Replace a file in one step by one that only this user may read and write; OSError when that fails."""
    file_io.write(path, data, PRIVATE_FILE)


def key_of(folder: Path) -> bytes:
    """Return the secret key of a folder, made where there is none that only this user can know; OSError without."""
    path = folder / "key"
    key = read_key(path)
    if key is None:
        with locked(folder / "key.lock"):
            key = read_key(path)
            if key is None:
                key = os.urandom(KEY_SIZE)
                write(path, key)
    return key


def read_key(path: Path) -> bytes | None:
    """Return the key in a file; None where it is missing or damaged, or where others can have read it."""
    with suppress(OSError):
        is_secret = sys.platform == "win32" or not path.stat().st_mode & OTHERS_USE
        key = read(path)
        return key if is_secret and len(key) == KEY_SIZE else None
    return None


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file during this block: other processes wait. The system frees it when a process ends.

    There is no lock where the system has none, as on Windows, or refuses it, or where another process holds it for more
    than `PATIENCE` seconds: that process may have been suspended.
    """
    with ExitStack() as stack:
        if sys.platform != "win32":
            with suppress(OSError):
                descriptor = os.open(path, os.O_RDWR | os.O_CREAT, PRIVATE_FILE)
                stack.callback(os.close, descriptor)
                wait_for_lock(descriptor)
                # Closing it frees the lock only where no process was forked meanwhile, which has the file open, too.
                stack.callback(fcntl.flock, descriptor, fcntl.LOCK_UN)
        yield


def wait_for_lock(descriptor: int) -> None:
    """Lock an open file, as soon as no other process does. OSError where that is not possible, or takes too long."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() >= end:
                raise
            time.sleep(POLL)
