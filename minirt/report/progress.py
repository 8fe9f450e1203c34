"""Progress bar with the remaining time on standard error, shown only if that is a terminal."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import TextIO

from minirt.helpers.system import in_words

BAR = 24  # characters
TRUST = 0.05  # share of the expected time after which the measured pace counts as much as the expected one


class Progress:
    """One line of a terminal, redrawn at each step."""

    def __init__(self, out: TextIO, clock: Callable[[], float]) -> None:
        self.out, self.clock, self.is_shown = out, clock, out.isatty()
        self.seconds: dict[str, float] = {}  # expected of a step with a name
        self.expected = 0.0  # seconds of all steps, 0 as long as nobody knows
        self.done = 0.0  # expected seconds of the steps that have ended
        self.current = 0.0  # expected seconds of the step that runs
        self.start = clock()
        self.what = ""  # name of the step that runs

    def expect(self, steps: Iterable[tuple[str, float]]) -> None:
        """Say which steps will come, and how many seconds each will take; a guess will do."""
        steps = list(steps)
        self.seconds, self.expected = dict(steps), sum(seconds for _, seconds in steps)
        self.done, self.current, self.start = 0.0, 0.0, self.clock()

    def step(self, what: str) -> None:
        """Show that the next step begins; `what` names it."""
        self.done += self.current
        self.what, self.current = what, self.seconds.get(what, 0.0)
        if self.is_shown:
            share = min(1.0, self.done / self.expected) if self.expected else 0.0
            left = f"  {in_words(self.remaining())} left" if self.expected else ""
            line = f"{'#' * round(BAR * share):-<{BAR}} {share:4.0%}{left}  {what}"
            self.out.write("\r\x1b[K" + line[: shutil.get_terminal_size().columns - 1])
            self.out.flush()

    def remaining(self) -> float:
        """Estimate the remaining seconds from the pace until now, and first from what was expected."""
        prior = TRUST * self.expected
        pace = (self.clock() - self.start + prior) / (self.done + prior)
        return max(0.0, self.expected - self.done) * pace

    def clear(self) -> None:
        """Erase the line."""
        if self.is_shown:
            self.out.write("\r\x1b[K")
            self.out.flush()


@contextmanager
def progress(clock: Callable[[], float] = perf_counter) -> Iterator[Progress]:
    """A progress bar, erased at the end of the block."""
    shown = Progress(sys.stderr, clock)
    try:
        yield shown
    finally:
        shown.clear()
