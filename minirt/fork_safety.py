"""Fork safety: renews in a child process what `os.fork()` leaves unusable there.

Of all threads a child process has only the one that forked. Thread pools are therefore without threads, and a lock that
another thread held stays locked for ever. Spawned child processes import everything anew and need none of this.
"""

from __future__ import annotations

import os
from threading import Lock
from typing import Protocol
from weakref import WeakSet


class Renewable(Protocol):
    """An object with locks or threads."""

    def after_fork(self) -> None:
        """Replace the locks and drop the threads, in the child process."""


renewables: WeakSet[Renewable] = WeakSet()


def renew_after_fork(owner: Renewable) -> None:
    """Call `owner.after_fork` in each child process, for as long as `owner` is alive."""
    renewables.add(owner)


def renew_all() -> None:
    """Renew all objects, in a child process."""
    for owner in renewables:
        owner.after_fork()


class ForkSafeLock:
    """Lock of a module, for `with`: a new one, not held by anybody, in each child process."""

    def __init__(self) -> None:
        self.after_fork()
        renew_after_fork(self)

    def after_fork(self) -> None:
        """Replace the lock, which a thread that is gone may hold."""
        self.lock = Lock()

    def __enter__(self) -> None:
        self.lock.acquire()

    def __exit__(self, *error: object) -> None:
        self.lock.release()


if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(after_in_child=renew_all)
