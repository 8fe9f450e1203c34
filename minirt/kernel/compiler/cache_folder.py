"""Folder of compiled kernels, which later runs load.

numba identifies a kernel on disk by the file of the compiled function alone, not by the functions that it calls: after
a change of a shape's formula it would load the old machine code. So the name of the folder is a hash of all sources of
a kernel and of the versions of the compiler.
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
SOURCES = ("kernel", "lanes", "shapes")  # folders of all sources of a kernel
OTHER_VERSIONS = 8  # folders of other versions that are not deleted, so that versions can be used in turn


def user_folder() -> Path:
    """Return the folder for this user's files that may be deleted at any time."""
    if os.environ.get("XDG_CACHE_HOME"):
        return Path(os.environ["XDG_CACHE_HOME"])
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    if sys.platform == "win32" and os.environ.get("LOCALAPPDATA"):
        return Path(os.environ["LOCALAPPDATA"])
    return Path.home() / ".cache"


def fingerprint() -> str:
    """Return a hash of the sources, of the compiler's versions and of the name of the processor."""
    versions = sys.version, numba.__version__, llvmlite.__version__, get_host_cpu_name()
    digest = hashlib.sha256(" ".join(versions).encode())
    for folder in SOURCES:
        for source in sorted((PACKAGE / folder).rglob("*.py")):
            digest.update(source.relative_to(PACKAGE).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]


def folder() -> Path | None:
    """Return the folder for kernels of these sources, made if need be; None, with a notice, if it cannot be written."""
    try:
        path = user_folder() / "minirt" / f"kernels-{fingerprint()}"
        path.mkdir(parents=True, exist_ok=True)
        os.utime(path)
        probe = path / f"probe-{os.getpid()}"
        probe.touch()
        probe.unlink()
    except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
        logging.getLogger(__name__).warning("notice: every run compiles anew, kernels cannot be kept: %s", error)
        return None
    with suppress(OSError):
        delete_old_folders(path)
    return path


def delete_old_folders(current: Path) -> None:
    """Delete the folders of other sources, except the `OTHER_VERSIONS` that were used last."""
    others = [each for each in current.parent.glob("kernels-*") if each != current]
    others.sort(key=lambda each: each.stat().st_mtime)
    for each in others[: max(0, len(others) - OTHER_VERSIONS)]:
        shutil.rmtree(each, ignore_errors=True)


@contextmanager
def numba_cache(path: Path | None) -> Iterator[None]:
    """Let numba keep functions that are made in this block in a folder, and restore its setting afterwards."""
    before = config.CACHE_DIR
    config.CACHE_DIR = str(path or before)
    try:
        yield
    finally:
        config.CACHE_DIR = before


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a folder during this block: other processes wait.

    numba reads a folder's index, adds an entry and writes it again: of two processes that do so at once one could be
    given the machine code of the other. There is no lock where the system has none, as on Windows, or refuses it.
    """
    with ExitStack() as stack:
        if sys.platform != "win32":
            with suppress(OSError):
                descriptor = os.open(path, os.O_RDONLY)
                stack.callback(os.close, descriptor)
                fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
