"""Folder of journals: the journals of one scene file, and locks that tell which of them a running program writes."""

from __future__ import annotations

import hashlib
import os
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from minirt.helpers.file_io import lock

PRIVATE_FILE, PRIVATE_FOLDER = 0o600, 0o700
KEPT = 30 * 24 * 3600  # seconds that a journal is kept which nobody asks for
EARLIEST = 1.7e9  # seconds since 1970, in November 2023: no journal is older, and a clock that said so was wrong


def journal_folder() -> Path:
    """Return the folder of this user's journals: XDG_STATE_HOME, or what the system has in its place.

    RuntimeError where the user has no home.
    """
    named = Path(os.environ.get("XDG_STATE_HOME", ""))
    if named.is_absolute():
        state = named
    elif sys.platform == "darwin":
        state = Path.home() / "Library" / "Application Support"
    elif sys.platform == "win32" and os.environ.get("LOCALAPPDATA"):
        state = Path(os.environ["LOCALAPPDATA"])
    else:
        state = Path.home() / ".local" / "state"
    return state / "minirt" / "journals"


def name_of(file: Path) -> str:
    """Return how the names of the journals of a scene file begin."""
    return hashlib.sha256(os.fsencode(os.path.realpath(file))).hexdigest()[:24]


def create_journal(file: Path) -> tuple[Path, BinaryIO]:
    """Create a journal for a scene file, and lock it as long as it is open. OSError, RuntimeError."""
    folder = journal_folder()
    folder.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
    path = folder / f"{name_of(file)}-{os.urandom(6).hex()}.journal"
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), PRIVATE_FILE)
    opened = os.fdopen(descriptor, "wb", buffering=0)
    lock(descriptor)
    return path, opened


def abandoned_journals(file: Path) -> Iterator[Path]:
    """Yield the journals of a scene file that no running program writes. Very old ones are deleted."""
    with suppress(OSError, RuntimeError):
        for path in sorted(journal_folder().glob(f"{name_of(file)}-*.journal")):
            with suppress(OSError):
                if is_abandoned(path):
                    if is_old(path):
                        path.unlink()
                    else:
                        yield path


def is_old(path: Path) -> bool:
    """Whether a journal is so old that it is not kept. OSError.

    The time of one that a wrong clock has dated begins now.
    """
    changed, now = path.stat().st_mtime, time.time()
    if not EARLIEST <= changed <= now + KEPT:
        os.utime(path)
        return False
    return now - changed > KEPT


def is_abandoned(path: Path) -> bool:
    """Whether no running program writes a journal. OSError."""
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    try:
        return lock(descriptor)
    finally:
        os.close(descriptor)  # which also frees the lock
