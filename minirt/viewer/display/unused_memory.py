"""Memory that the C library keeps for later use: given back to the system after a resize and after a file was read.

The frames of a large window come from the C library's heap and return to it, between smaller blocks that stay. Without
this module a window that was full screen (2560x1600) once, and is small again, keeps 70 to 110 MB that nothing uses.
Only Linux's C library (glibc) has these functions; elsewhere nothing happens.
"""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress

M_ARENA_MAX = -8  # the parameter of `mallopt` for the number of heaps


def use_one_heap() -> None:
    """Let all threads allocate from one heap, all of which can be given back. Call it before threads start."""
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1)


def give_back() -> None:
    """Give the unused pages of the heap back to the system, which takes some milliseconds."""
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).malloc_trim(ctypes.c_size_t(0))
