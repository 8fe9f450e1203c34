"""How far something is, on standard error where that is a terminal."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

BAR = 24  # characters


class Progress:
    """A line that is drawn over and over."""

    def __init__(self, steps: int, out: TextIO) -> None:
        self.steps, self.done, self.out, self.shown = steps, 0, out, out.isatty()

    def step(self, what: str) -> None:
        """The next of the steps begins."""
        if self.shown:
            share = min(1.0, self.done / self.steps)
            bar = "#" * round(BAR * share)
            line = f"{bar:-<{BAR}} {share:4.0%} {what}"
            self.out.write("\r\x1b[K" + line[: shutil.get_terminal_size().columns - 1])
            self.out.flush()
        self.done += 1

    def clear(self) -> None:
        """Leave no trace."""
        if self.shown:
            self.out.write("\r\x1b[K")
            self.out.flush()


@contextmanager
def progress(steps: int) -> Iterator[Progress]:
    """The progress of something that takes so many steps."""
    shown = Progress(steps, sys.stderr)
    try:
        yield shown
    finally:
        shown.clear()
