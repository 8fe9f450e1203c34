"""Guards for blocks of code that must end, or must not open certain files."""

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

forbidden: set[str] = set()  # paths that must not be opened now


@contextmanager
def must_end() -> Iterator[None]:
    """Raise TimeoutError if the block, in the main thread, takes longer than `HANG_LIMIT`."""

    def on_alarm(number: int, frame: FrameType | None) -> None:
        raise TimeoutError(f"it did not end within {HANG_LIMIT:.0f} s")

    before = signal.signal(signal.SIGALRM, on_alarm)
    signal.setitimer(signal.ITIMER_REAL, HANG_LIMIT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@contextmanager
def must_not_open(*paths: Path) -> Iterator[None]:
    """Raise AssertionError if the block opens one of these files, by any name."""
    names = {os.path.realpath(path) for path in paths}
    forbidden.update(names)
    try:
        yield
    finally:
        forbidden.difference_update(names)


def audit_open(event: str, arguments: tuple[Any, ...]) -> None:
    """Audit hook, which Python calls before each system operation: refuse to open forbidden files."""
    if forbidden and event == "open" and isinstance(arguments[0], (str, bytes)):
        assert os.path.realpath(os.fsdecode(arguments[0])) not in forbidden, f"{arguments[0]!r} was opened"


sys.addaudithook(audit_open)
