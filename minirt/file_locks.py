"""Locks of open files, which end with the process that holds them, however that ends."""

from __future__ import annotations

import sys

if sys.platform != "win32":
    import fcntl


def lock(descriptor: int) -> bool:
    """Lock an open file until it is closed, unless another program has; whether none has.

    A system or file system without locks never has another program's.
    """
    return is_free(descriptor) is not False


def is_free(descriptor: int) -> bool | None:
    """Lock an open file as `lock` does; None where there are no locks."""
    if sys.platform == "win32":
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True
