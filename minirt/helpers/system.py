"""The process and its machine: the limit of memory, forks and garbage collection.

The limit of memory is the user's, or that of the container or machine. Large needs are compared with it before
memory is allocated, since the system would end the program without a word.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any
from weakref import WeakSet

from minirt.errors import RenderError

SHARE = 7 / 8  # of a limit that nobody chose; the rest is for what nobody counts
SMALL = 256 * 2**20  # bytes: needs below are not compared
SMALL_SHARE = 32  # nor is one part in so many of the limit
UNLIMITED = 2**60  # bytes: containers without a limit have such numbers
CONTAINER = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))  # version 2, 1
STATUS = Path("/proc/self/statm")
MACHINE = Path("/proc/meminfo")
FEWER_PIXELS = "a smaller picture needs less, and a .tif file only bands of rows (in the library: render_to)"

chosen: list[int] = []  # the limit that was set last, if any


def limit_memory(size: int | None) -> None:
    """Allow this process so many bytes of memory; None restores the default.

    By default the process may take seven eighths of the memory of its container, or of the machine. Pictures,
    textures and lists of shapes that need more raise RenderError before they are made. RenderError for a size below 1.
    """
    if size is not None and size < 1:
        raise RenderError(f"a memory limit must be at least 1 byte, got {size}")
    chosen[:] = [] if size is None else [int(size)]


def total() -> int:
    """Return the bytes that this process may take in all; `UNLIMITED` where the system does not tell."""
    return chosen[0] if chosen else default_total()


@cache
def default_total() -> int:
    """Return the memory of the machine, or the limit of its container where that is less, less a margin."""
    limits = [UNLIMITED]
    with suppress(AttributeError, ValueError, OSError):
        limits.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    for file in CONTAINER:
        with suppress(OSError, ValueError):
            limits.append(int(file.read_text()))
    return int(min(limits) * SHARE)


def room() -> int:
    """Return the bytes that this process may still take."""
    least = total() - resident()
    with suppress(OSError, ValueError, IndexError, StopIteration):  # not on Linux
        if not chosen:
            lines = MACHINE.read_text().splitlines()
            free = next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
            least = min(least, int(free * SHARE))
    return max(0, least)


def resident() -> int:
    """Return the bytes of memory that this process holds; 0 where nobody knows."""
    with suppress(OSError, ValueError):
        return int(STATUS.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return 0


def check_memory(needed: int, what: str, advice: str, largest: int = UNLIMITED) -> None:
    """Check that there is room for something that may have at most `largest` bytes; `TooLargeError` otherwise.

    The sentence of the error begins with `what`, including a verb, and ends with the `advice`.
    """
    if needed > min(SMALL, total() // SMALL_SHARE) and needed > (allowed := min(room(), largest)):
        rest = "" if allowed >= largest else f" (what is left of {size_in_words(total())})"
        raise TooLargeError(
            f"{what} about {size_in_words(needed)} of memory, allowed {size_in_words(allowed)}{rest}; {advice}"
        )


def check_picture(height: int, width: int, bytes_per_pixel: float) -> None:
    """Check that there is room for a picture; `TooLargeError` otherwise."""
    check_memory(int(height * width * bytes_per_pixel), f"a picture of {width}x{height} pixels needs", FEWER_PIXELS)


class TooLargeError(RenderError):
    """Something needs more memory than is allowed."""


def size_in_words(size: float) -> str:
    """Return a number of bytes in the unit that suits it."""
    for unit in ("B", "KiB", "MiB"):
        if size < 1024:
            return f"{size:.0f} {unit}"
        size /= 1024
    return f"{size:.1f} GiB"


# Of all threads a child process has only the one that forked. Thread pools are therefore without threads, and a lock
# that another thread held stays locked for ever. Spawned child processes import everything anew.

renewables: WeakSet[Any] = WeakSet()  # objects whose method `after_fork` renews their locks or threads


class ForkSafeLock:
    """Lock of a module, for `with`: a new one, not held by anybody, in each child process."""

    def __init__(self) -> None:
        self.after_fork()
        renewables.add(self)

    def after_fork(self) -> None:
        """Replace the lock, which a thread that is gone may hold."""
        self.lock = Lock()

    def __enter__(self) -> None:
        self.lock.acquire()

    def __exit__(self, *error: object) -> None:
        self.lock.release()


if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(after_in_child=lambda: [each.after_fork() for each in renewables])


@contextmanager
def gc_paused(freeze: bool = True) -> Iterator[None]:
    """Collect no garbage inside the context; `freeze` excludes the objects that exist at its end from all later
    collections.

    With the modules of numba loaded a collection takes 30 ms, in which no thread runs, and the last one, at the end of
    the program, 100 ms.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if freeze:
            gc.freeze()
        if enabled:
            gc.enable()
