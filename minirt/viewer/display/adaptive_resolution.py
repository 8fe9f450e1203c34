"""How coarse pictures have to be while something moves."""

from __future__ import annotations

from collections import deque
from statistics import median_low

from minirt.viewer.display.painter import Outcome

LONGEST = 0.016  # seconds from a key to its picture on the screen while something moves
DIVISORS = (1, 2, 3, 4, 8)  # of width and height
EASE = 0.8  # of the time: what a finer picture has to fit into before a coarser one gives way to it
DOUBT = 1.5  # times the time: what a finer picture may seem to take when it is tried all the same ...
PATIENCE = 30  # ... after so many pictures in a row


class AdaptiveResolution:
    """Learns from the pictures what they cost, and from showing them what time is left for that.

    A picture that is twice as coarse costs a quarter, and then what every picture costs: so coarse ones tell too much
    of finer ones, which have to be tried now and then, ever less often until nothing moves.
    """

    def __init__(self) -> None:
        # Of the last ones the middle counts: one hiccup changes nothing.
        self._costs: deque[float] = deque(maxlen=3)  # seconds a pixel
        self._showings: deque[float] = deque(maxlen=3)  # seconds a picture
        self._measured = 0  # the divisor that had these costs; 0 while nothing is known
        self._chosen = DIVISORS[-1]
        self._doubts = 0  # pictures in a row after which a finer one seemed possible
        self._patience = PATIENCE

    def learn(self, outcome: Outcome) -> None:
        """A picture was finished, or was cancelled and would have taken longer."""
        job, cost = outcome.job, outcome.seconds / outcome.job.pixels
        if job.samples > 1:
            return
        if outcome.pixels is None:
            if job.divisor == self._measured and cost > median_low(self._costs):
                self._costs.append(cost)
            return
        if job.divisor != self._measured:
            self._costs.clear()
            self._measured = job.divisor
        self._costs.append(cost)
        if not job.urgent:
            self._chosen, self._doubts, self._patience = job.divisor, 0, PATIENCE

    @property
    def rate(self) -> float:
        """Rays from the eye a second, 0 where nothing is known."""
        cost = median_low(self._costs) if self._costs else 0.0
        return 1 / cost if cost else 0.0

    def learn_showing(self, seconds: float) -> None:
        """A picture was brought to the window in that time."""
        self._showings.append(seconds)

    def divisor(self, width: int, height: int) -> int:
        """The least one that is quick enough, or the greatest; that, too, while nothing is known."""
        if self._measured == self._chosen:
            self._chosen = self._better(median_low(self._costs) * width * height)
        return self._chosen

    def _better(self, seconds: float) -> int:
        """What should follow the chosen one, where a whole picture seems to take so long; it stays until it is too slow
        or a finer one is quick enough with ease."""
        better = min(max(self._chosen, least(seconds, self._time)), least(seconds, self._time * EASE))
        possible = least(seconds, self._time * DOUBT)
        self._doubts = self._doubts + 1 if possible < better == self._chosen else 0
        if self._doubts < self._patience:
            return better
        self._doubts, self._patience = 0, 2 * self._patience
        return possible

    @property
    def _time(self) -> float:
        """What is left for rendering: at least a half, since coarser pictures are no remedy for a slow screen."""
        return max(LONGEST - (median_low(self._showings) if self._showings else 0.0), LONGEST / 2)


def least(seconds: float, time: float) -> int:
    """The least divisor that brings `seconds` down to `time`, or the greatest."""
    return next((each for each in DIVISORS if seconds <= time * each * each), DIVISORS[-1])
