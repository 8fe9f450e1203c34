"""Files of this user: the folder of those that may be deleted at any time, and files that nobody else can have written.

Windows has neither owners nor modes in this sense: there the folder of the user protects its files.
"""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
PRIVATE_FILE, PRIVATE_FOLDER = 0o600, 0o700


def user_folder() -> Path:
    """Return the folder for this user's files that may be deleted at any time; RuntimeError where the user has no home.

    The XDG Base Directory Specification tells programs to ignore an XDG_CACHE_HOME that is relative."""
    named = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if named.is_absolute():
        return named
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    if sys.platform == "win32" and os.environ.get("LOCALAPPDATA"):
        return Path(os.environ["LOCALAPPDATA"])
    return Path.home() / ".cache"


def is_private(status: os.stat_result) -> bool:
    """Whether nobody but this user can have written a file or a folder."""
    return sys.platform == "win32" or (status.st_uid == os.geteuid() and not status.st_mode & OTHERS_WRITE)
