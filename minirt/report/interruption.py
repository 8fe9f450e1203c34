"""Interruption by Ctrl+C or SIGTERM, which both raise KeyboardInterrupt while a report is being made."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType


class Terminated(KeyboardInterrupt):
    """SIGTERM has come."""


@contextmanager
def sigterm_interrupts() -> Iterator[None]:
    """Let SIGTERM raise `Terminated` in the block, and end the process only when that leaves the block.

    So the block can write what it has. Other threads than the main one cannot set a handler, and do without.
    """
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, terminated)
    try:
        yield
    except Terminated:
        signal.signal(signal.SIGTERM, before)
        signal.raise_signal(signal.SIGTERM)  # as if it came only now: its usual handler ends the process
        raise
    finally:
        signal.signal(signal.SIGTERM, before)


def terminated(number: int, frame: FrameType | None) -> None:
    """Handle SIGTERM; a second one is ignored, so that the files are written."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise Terminated
