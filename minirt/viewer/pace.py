"""How coarse pictures have to be while something moves."""

from __future__ import annotations

import math

from minirt.viewer.painter import Outcome

LONGEST = 0.04  # seconds that a picture may take while something moves
DIVISORS = (1, 2, 4, 8)  # of width and height


class Pace:
    """Learns from each picture what a pixel costs."""

    def __init__(self) -> None:
        self._cost: float | None = None  # seconds a pixel; None while nothing is known

    def learn(self, outcome: Outcome) -> None:
        """A picture was finished, or was cancelled and would have taken longer."""
        cost = outcome.seconds / outcome.job.pixels
        if outcome.pixels is not None or (self._cost is not None and cost > self._cost):
            self._cost = cost

    def divisor(self, width: int, height: int) -> int:
        """The least one that is quick enough, or the greatest; that, too, while nothing is known."""
        estimate = math.inf if self._cost is None else self._cost * width * height
        return next((each for each in DIVISORS if estimate <= LONGEST * each * each), DIVISORS[-1])
