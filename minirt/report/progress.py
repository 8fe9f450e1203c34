"""Progress bar on standard error, shown only if that is a terminal."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

BAR = 24  # characters


class Progress:
    """One line of a terminal, redrawn at each step."""

    def __init__(self, steps: int, out: TextIO) -> None:
        self.steps, self.done, self.out, self.shown = steps, 0, out, out.isatty()

    def step(self, what: str) -> None:
        """Show that the next step begins; `what` names it."""
        if self.shown:
            share = min(1.0, self.done / self.steps)
            bar = "#" * round(BAR * share)
            line = f"{bar:-<{BAR}} {share:4.0%} {what}"
            self.out.write("\r\x1b[K" + line[: shutil.get_terminal_size().columns - 1])
            self.out.flush()
        self.done += 1

    def clear(self) -> None:
        """Erase the line."""
        if self.shown:
            self.out.write("\r\x1b[K")
            self.out.flush()


@contextmanager
def progress(steps: int) -> Iterator[Progress]:
    """A progress bar of so many steps, erased at the end of the block."""
    shown = Progress(steps, sys.stderr)
    try:
        yield shown
    finally:
        shown.clear()
