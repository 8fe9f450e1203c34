"""A terminal for programs that tests start: what they write on it tells how far they are."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from tests.waiting import until


class Terminal:
    """`end` is where a program writes; what it wrote is kept in `text`."""

    def __init__(self, reader: int, end: int) -> None:
        self.reader, self.end = reader, end
        self.text = b""
        self.seen = 0  # characters of it that were waited for
        self.is_open = True

    def read(self) -> bytes:
        """All that was written until now."""
        part = b"."
        while part:
            try:
                part = os.read(self.reader, 4096)
            except BlockingIOError:
                break
            except OSError:  # nobody has the other end any more: Linux
                part = b""
            self.text += part
            self.is_open = bool(part)
        return self.text

    def wait_for(self, words: bytes) -> None:
        """Wait until a program has written these words, after those of the last wait; AssertionError where it ends
        without them."""

        def are_there() -> bool:
            self.read()
            found = self.text.find(words, self.seen)
            assert found >= 0 or self.is_open, self.text
            self.seen = self.seen if found < 0 else found + len(words)
            return found >= 0

        until(are_there, repr(words))

    def wait_for_end(self) -> bytes:
        """Wait until no program can write any more, and return all that was written."""

        def is_over() -> bool:
            self.read()
            return not self.is_open

        until(is_over, "the end of what is written")
        return self.text

    def leave(self) -> None:
        """Let go of the end that programs have, after they were started."""
        os.close(self.end)


@contextmanager
def terminal() -> Iterator[Terminal]:
    """A terminal; `leave` must be called when the program has been started."""
    reader, end = os.openpty()
    os.set_blocking(reader, False)
    try:
        yield Terminal(reader, end)
    finally:
        os.close(reader)
