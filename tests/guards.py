"""Work that must end, and files that must not be opened."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

from tests.waiting import HANG_LIMIT

forbidden: set[str] = set()  # files that nobody may open now


@contextmanager
def must_end() -> Iterator[None]:
    """TimeoutError where the block, in the main thread, takes longer than `HANG_LIMIT`."""

    def too_long(number: int, frame: FrameType | None) -> None:
        raise TimeoutError(f"it did not end within {HANG_LIMIT:.0f} s")

    before = signal.signal(signal.SIGALRM, too_long)
    signal.setitimer(signal.ITIMER_REAL, HANG_LIMIT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@contextmanager
def must_not_open(*paths: Path) -> Iterator[None]:
    """AssertionError where the block opens one of these files, by whatever name."""
    names = {os.path.realpath(path) for path in paths}
    forbidden.update(names)
    try:
        yield
    finally:
        forbidden.difference_update(names)


def audit_open(event: str, given: tuple[Any, ...]) -> None:
    """Python calls this before it does anything that has to do with the system."""
    if forbidden and event == "open" and isinstance(given[0], (str, bytes)):
        assert os.path.realpath(os.fsdecode(given[0])) not in forbidden, f"{given[0]!r} was opened"


sys.addaudithook(audit_open)
