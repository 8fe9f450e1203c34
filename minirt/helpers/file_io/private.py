"""Files of this user alone: their folders, their permissions, and locks against other programs."""

from __future__ import annotations

import os
import stat
import sys
from contextlib import suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
PRIVATE_FILE = 0o600
PRIVATE_FOLDER = 0o700


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
