"""Limit of the memory that the program may take: the user's, or that of the control group, process or machine.

Large needs are compared with it before memory is allocated, since the system would end the program without a word.
The limit is one of the process, because all renderers share its memory.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

from minirt.errors import RenderError

MARGIN = 1 / 8  # of a limit that nobody chose, for what nobody counts
SMALL = 256 * 2**20  # bytes: needs below are not compared
SMALL_SHARE = 32  # nor is one part in so many of the limit
UNLIMITED = 2**60  # bytes: control groups without a limit have such numbers
GROUP = Path("/sys/fs/cgroup")
GROUPS_OF_PROCESS = Path("/proc/self/cgroup")
STATUS = Path("/proc/self/statm")
MACHINE = Path("/proc/meminfo")
AVAILABLE = "MemAvailable:"
FEWER_PIXELS = "a smaller picture needs less, and a .tif file only bands of rows (in the library: render_to)"

chosen: list[int] = []  # the limit that was set last, if any


def limit_memory(size: int | None) -> None:
    """Allow this process so many bytes of memory; None restores the default.

    By default the process may take seven eighths of the memory of its control group, or of the machine. Pictures,
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
    """Return the memory of the machine, or the limit of the control group where that is less, less a margin."""
    limits = [UNLIMITED, *group_limits()]
    with suppress(AttributeError, ValueError, OSError):
        limits.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    return less_margin(min(limits))


def less_margin(size: int) -> int:
    """Return what is left of some memory without the margin."""
    return int(size * (1 - MARGIN))


def group_limits() -> list[int]:
    """Return the limits of the control group (version 1 or 2) of this process and of the groups around it."""
    found = []
    with suppress(OSError):
        for line in GROUPS_OF_PROCESS.read_text().splitlines():
            _, controllers, name = line.split(":", 2)
            if controllers not in ("", "memory"):
                continue
            root, file = (GROUP / "memory", "memory.limit_in_bytes") if controllers else (GROUP, "memory.max")
            folder = root / name.lstrip("/")
            for each in (folder, *folder.parents):
                with suppress(OSError, ValueError):
                    found.append(int((each / file).read_text()))
                if each == root:
                    break
    return found


def room() -> int:
    """Return the bytes that this process may still take."""
    address_space, resident = sizes()
    least = total() - resident
    if not chosen:
        least = min(least, less_margin(available()))
    if sys.platform != "win32":
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            least = min(least, less_margin(limit - address_space))
    return max(0, least)


def sizes() -> tuple[int, int]:
    """Return the bytes of the address space and of the resident memory of this process; 0 where nobody knows."""
    with suppress(OSError, ValueError):
        address_space, resident = (int(each) * os.sysconf("SC_PAGE_SIZE") for each in STATUS.read_text().split()[:2])
        return address_space, resident
    return 0, 0


def available() -> int:
    """Return the bytes of the machine that no process has taken; `UNLIMITED` where nobody knows."""
    with suppress(OSError, ValueError, IndexError):
        lines = MACHINE.read_text().splitlines()
        return next((int(line.split()[1]) * 1024 for line in lines if line.startswith(AVAILABLE)), UNLIMITED)
    return UNLIMITED


def is_small(needed: int) -> bool:
    """Whether nobody need count so few bytes."""
    return needed <= min(SMALL, total() // SMALL_SHARE)


def check(needed: int, what: str, advice: str, largest: int = UNLIMITED) -> None:
    """Check that there is room for something that may have at most `largest` bytes; `TooLargeError` otherwise.

    The sentence of the error begins with `what`, including a verb, and ends with the `advice`.
    """
    if not is_small(needed) and needed > (allowed := min(room(), largest)):
        rest = "" if allowed >= largest else f" (what is left of {in_words(total())})"
        raise TooLargeError(f"{what} about {in_words(needed)} of memory, allowed {in_words(allowed)}{rest}; {advice}")


def check_picture(height: int, width: int, bytes_per_pixel: float) -> None:
    """Check that there is room for a picture; `TooLargeError` otherwise."""
    check(int(height * width * bytes_per_pixel), f"a picture of {width}x{height} pixels needs", FEWER_PIXELS)


class TooLargeError(RenderError):
    """Something needs more memory than is allowed."""


def in_words(size: int) -> str:
    """Return a number of bytes in the unit that suits it."""
    return f"{size / 2**30:.1f} GiB" if size >= 2**30 else f"{size / 2**20:.0f} MiB"
