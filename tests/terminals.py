"""Pseudo-terminal for programs in tests, whose output shows their progress."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from tests.waiting import until


class Terminal:
    """A pseudo-terminal: programs write to the descriptor `end`, and `text` collects their output."""

    def __init__(self, reader: int, end: int) -> None:
        self.reader, self.end = reader, end
        self.text = b""
        self.seen = 0  # length of the text up to the last awaited words
        self.is_open = True

    def read(self) -> bytes:
        """Read and return all output until now."""
        part = b"."
        while part:
            try:
                part = os.read(self.reader, 4096)
            except BlockingIOError:
                break
            except OSError:  # Linux: the other end is closed
                part = b""
            self.text += part
            self.is_open = bool(part)
        return self.text

    def wait_for(self, words: bytes) -> None:
        """Wait until a program has written these words after those of the last wait.

        AssertionError if it ends without them.
        """

        def written() -> bool:
            self.read()
            index = self.text.find(words, self.seen)
            assert index >= 0 or self.is_open, self.text
            self.seen = self.seen if index < 0 else index + len(words)
            return index >= 0

        until(written, repr(words))

    def wait_for_end(self) -> bytes:
        """Wait until all programs have closed the terminal, and return all output."""

        def is_closed() -> bool:
            self.read()
            return not self.is_open

        until(is_closed, "the end of the output")
        return self.text

    def leave(self) -> None:
        """Close this process's copy of the programs' end. Call this after they were started."""
        os.close(self.end)


@contextmanager
def terminal() -> Iterator[Terminal]:
    """Open a pseudo-terminal; `leave` must be called after the program was started."""
    reader, end = os.openpty()
    os.set_blocking(reader, False)
    try:
        yield Terminal(reader, end)
    finally:
        os.close(reader)
