"""Pipes to and from the helper process, with a limit on the time that this program waits for it.

A process that an attacker controls may stop, or sleep, or write a byte a minute. What it does not do in time counts as
not done. Time in which this program itself is stopped, as by Ctrl+Z, does not count.
"""

from __future__ import annotations

import os
import select
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import IO

LONGEST_WAIT = 120.0  # seconds for a file: twice the processor time that its decoder may take
SLICE = 1.0  # seconds; of a longer time between two looks at the clock, this program was stopped for the rest
WRITTEN_AT_ONCE = 2**16  # bytes


class LateError(Exception):
    """The helper process has not answered in time."""


class Patience:
    """Time that is left for a file."""

    def __init__(self) -> None:
        self.left = LONGEST_WAIT
        self.last = monotonic()

    def until_ready(self, pipe: IO[bytes], event: int) -> None:
        """Wait until a pipe can be read or written; LateError when there is no time left."""
        poll = select.poll()
        poll.register(pipe, event)
        while not poll.poll(1000 * min(SLICE, max(self.left, 0.0))):
            self.count()
        self.count()

    def count(self) -> None:
        """Count the time since the last call, as `SLICE` at most; LateError when none is left."""
        now = monotonic()
        self.left -= min(now - self.last, SLICE)
        self.last = now
        if self.left <= 0:
            raise LateError

    def write(self, pipe: IO[bytes], data: bytes) -> None:
        """Write all bytes to an unbuffered pipe; LateError, or OSError when nobody reads it."""
        rest = memoryview(data)
        while rest:
            if sys.platform != "win32":
                self.until_ready(pipe, select.POLLOUT)
            rest = rest[pipe.write(rest[:WRITTEN_AT_ONCE]) or 0 :]

    def read(self, pipe: IO[bytes], size: int) -> bytearray:
        """Read as many bytes from an unbuffered pipe, or fewer where it ends; LateError."""
        data = bytearray(size)
        at = 0
        with memoryview(data) as view:
            while at < size:
                if sys.platform != "win32":
                    self.until_ready(pipe, select.POLLIN)
                count = pipe.readinto(view[at:])  # type: ignore[attr-defined]
                if count == 0:
                    break
                at += count or 0
        del data[at:]
        return data


def prepare(*pipes: IO[bytes]) -> None:
    """Let a pipe that is full or empty return at once, where waiting for it can be limited."""
    if sys.platform != "win32":
        for pipe in pipes:
            os.set_blocking(pipe.fileno(), False)


@contextmanager
def ended_when_late(end: Callable[[], object]) -> Iterator[None]:
    """On Windows, where waiting for a pipe cannot be limited, call `end` when the block takes too long."""
    if sys.platform != "win32":
        yield
        return
    timer = threading.Timer(LONGEST_WAIT, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
