"""How coarse pictures have to be while something moves."""

from __future__ import annotations

LONGEST = 0.04  # seconds that a picture may take while something moves
DIVISORS = (1, 2, 4, 8)  # of width and height


class Pace:
    """Learns from each picture what a pixel costs."""

    def __init__(self) -> None:
        self._cost = 0.0  # seconds a pixel; 0 while nothing is known

    def learn(self, seconds: float, pixels: int) -> None:
        """A picture was finished."""
        self._cost = seconds / pixels

    def give_up(self, seconds: float, pixels: int) -> None:
        """A picture was not finished in that time: it costs that much or more."""
        self._cost = max(self._cost, seconds / pixels)

    def divisor(self, width: int, height: int) -> int:
        """The least one that is quick enough, or the greatest."""
        estimate = self._cost * width * height
        return next((each for each in DIVISORS if estimate <= LONGEST * each * each), DIVISORS[-1])
