"""Blue noise: a square of thresholds for dithering, without low frequencies, that repeats without a seam.

It is made at first use, in a tenth of a second, by Ulichney's void-and-cluster method (The void-and-cluster method for
dither array generation, 1993).
"""

from __future__ import annotations

from functools import cache
from math import exp

import numpy as np

SIZE = 64  # pixels along an edge
SIGMA = 1.5  # pixels: width of the Gaussian that measures how crowded a place is
FIRST = SIZE * SIZE // 10  # points of the first pattern
UNIT = 2**40  # crowding is counted in whole numbers, whose sums have no rounding: the same order on every machine


@cache
def blue_noise() -> np.ndarray:
    """Return the thresholds, (SIZE, SIZE), evenly spaced in (0, 1); the same at each call."""
    pattern = Pattern()
    pattern.even_out()
    ranks = np.zeros(SIZE * SIZE, np.int64)
    later = pattern.copy()
    for rank in range(FIRST - 1, -1, -1):  # the first points: those that go last are the least crowded
        ranks[pattern.remove(pattern.tightest())] = rank
    for rank in range(FIRST, SIZE * SIZE):
        ranks[later.add(later.emptiest())] = rank
    return (ranks.reshape(SIZE, SIZE) + 0.5) / (SIZE * SIZE)


@cache
def crowding_of_point() -> np.ndarray:
    """Crowding of each place by a point at SIZE, SIZE, (2 SIZE, 2 SIZE): a Gaussian of the distance around the
    square."""
    around = [min(i, SIZE - i) ** 2 for i in range(SIZE)]
    one = [[round(UNIT * exp(-(x + y) / (2 * SIGMA**2))) for x in around] for y in around]
    return np.tile(np.array(one, np.int64), (2, 2))


class Pattern:
    """Points in the square, and how much they crowd each place."""

    def __init__(self) -> None:
        self.points = np.zeros(SIZE * SIZE, bool)
        self.crowding = np.zeros((SIZE, SIZE), np.int64)
        order = np.random.PCG64(3).random_raw(SIZE * SIZE).argsort(kind="stable")
        for place in order[:FIRST].tolist():
            self.add(place)

    def copy(self) -> Pattern:
        """Return a pattern with the same points."""
        other = object.__new__(Pattern)
        other.points, other.crowding = self.points.copy(), self.crowding.copy()
        return other

    def even_out(self) -> None:
        """Move the point in the tightest cluster to the largest void, until it is moved back to where it was."""
        while True:
            place = self.remove(self.tightest())
            if self.add(self.emptiest()) == place:
                return

    def tightest(self) -> int:
        """Return the place of the most crowded point."""
        return int(np.where(self.points, self.crowding.ravel(), -1).argmax())

    def emptiest(self) -> int:
        """Return the least crowded place without a point."""
        return int(np.where(self.points, UNIT * SIZE * SIZE, self.crowding.ravel()).argmin())

    def add(self, place: int) -> int:
        """Add a point, and return its place."""
        self.points[place] = True
        self.crowding += self.crowding_around(place)
        return place

    def remove(self, place: int) -> int:
        """Remove a point, and return its place."""
        self.points[place] = False
        self.crowding -= self.crowding_around(place)
        return place

    def crowding_around(self, place: int) -> np.ndarray:
        """Return how much a point crowds each place."""
        y, x = divmod(place, SIZE)
        return crowding_of_point()[SIZE - y : 2 * SIZE - y, SIZE - x : 2 * SIZE - x]
