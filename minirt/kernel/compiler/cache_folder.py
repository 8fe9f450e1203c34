"""Where compiled kernels are kept from one run to the next.

numba finds a kernel again by the file of the function that it was asked to compile, and by nothing else that went into
it: after a change of a shape's formula the old machine code would be used. So the folder's name is a hash of all the
sources that a kernel is made of, and of the versions of the compiler.
"""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import llvmlite
import numba
from llvmlite.binding import get_host_cpu_name
from numba.core import config

if sys.platform != "win32":
    import fcntl

PACKAGE = Path(__file__).parents[2]
SOURCES = ("kernel", "lanes", "shapes")  # all that a kernel is made of
KEPT = 8  # folders of other versions that stay, so that two of them can be used in turn


def user_folder() -> Path:
    """Where the system keeps files of this user that may be deleted at any time."""
    if os.environ.get("XDG_CACHE_HOME"):
        return Path(os.environ["XDG_CACHE_HOME"])
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    if sys.platform == "win32" and os.environ.get("LOCALAPPDATA"):
        return Path(os.environ["LOCALAPPDATA"])
    return Path.home() / ".cache"


def fingerprint() -> str:
    """A hash of the sources, of the compiler's versions and of the processor."""
    versions = sys.version, numba.__version__, llvmlite.__version__, get_host_cpu_name()
    digest = hashlib.sha256(" ".join(versions).encode())
    for folder in SOURCES:
        for source in sorted((PACKAGE / folder).rglob("*.py")):
            digest.update(source.relative_to(PACKAGE).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]


def folder() -> Path | None:
    """The folder of the kernels of these sources, made where it does not exist; None where that is not possible."""
    try:
        place = user_folder() / "minirt" / f"kernels-{fingerprint()}"
        place.mkdir(parents=True, exist_ok=True)
        os.utime(place)
        probe = place / f"probe-{os.getpid()}"
        probe.touch()
        probe.unlink()
    except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
        logging.getLogger(__name__).warning("notice: every run compiles anew, kernels cannot be kept: %s", error)
        return None
    with suppress(OSError):
        forget(place)
    return place


def forget(place: Path) -> None:
    """Delete the folders of other sources, but for those used last."""
    others = sorted(
        (each for each in place.parent.glob("kernels-*") if each != place), key=lambda each: each.stat().st_mtime
    )
    for each in others[: max(0, len(others) - KEPT)]:
        shutil.rmtree(each, ignore_errors=True)


@contextmanager
def numba_cache(place: Path | None) -> Iterator[None]:
    """Functions that are decorated inside keep their machine code in `place`; numba's own setting is put back."""
    before = config.CACHE_DIR
    config.CACHE_DIR = str(place or before)
    try:
        yield
    finally:
        config.CACHE_DIR = before


@contextmanager
def locked(place: Path) -> Iterator[None]:
    """Hold the lock of a folder: no other process has it before the block ends.

    numba reads a folder's index, adds an entry and writes it again: of two processes that do so at once one could be
    given the machine code of the other. Without a lock where the system has none, as on Windows, or refuses it.
    """
    with ExitStack() as held:
        if sys.platform != "win32":
            with suppress(OSError):
                folder = os.open(place, os.O_RDONLY)
                held.callback(os.close, folder)
                fcntl.flock(folder, fcntl.LOCK_EX)
        yield
