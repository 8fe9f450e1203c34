"""Division of a picture into bands: runs of whole rows of tiles, which depend on the size of the picture alone.

So does the estimated error of a picture that is made of bands, whoever renders them.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt

from minirt.cluster.task import Region
from minirt.kernel.pixels import TILE
from minirt.rendering.outcome import Outcome

ROWS = 64  # of a band, where the next two leave the choice
MOST_PIXELS = 2**21  # of a band, whose light takes 48 MiB; but at least one row of tiles
LEAST_PIXELS = 2**15  # of a band: twice those from which on the estimated error of a picture is promised


def bands_of(region: Region) -> list[Region]:
    """Return the bands of a region (x, y, width, height) of a picture."""
    x, y, width, height = region
    return [(x, y + first, width, end - first) for first, end in runs(width, height)]


def runs(width: int, height: int) -> list[tuple[int, int]]:
    """Return the first row of each band, and the one behind its last."""
    rows = min(max(ROWS, LEAST_PIXELS // width), max(TILE, MOST_PIXELS // width))
    tiles = -(-height // TILE)
    count = max(1, round(height / rows))
    ends = [min(height, TILE * (tiles * number // count)) for number in range(count + 1)]
    return [(first, end) for first, end in pairwise(ends) if end > first]


def whole(parts: Sequence[tuple[int, Outcome | None]]) -> Outcome | None:
    """Return the outcome of a picture that consists of bands, by their rows and outcomes; None where one has none.

    The square of an error is a mean over pixels: that of the whole is the mean of the squares of its bands. Where each
    of them is at most the goal the whole is, too. Seconds are those of all workers together.
    """
    known = [(rows, each) for rows, each in parts if each is not None]
    rows = sum(rows for rows, _ in parts)
    if not known or len(known) < len(parts):
        return None

    def mean(values: list[float]) -> float:
        return sum(count * value for (count, _), value in zip(known, values, strict=True)) / rows

    outcomes = [each for _, each in known]
    return Outcome(
        samples=mean([each.samples for each in outcomes]),
        most=max(each.most for each in outcomes),
        error=sqrt(mean([each.error**2 for each in outcomes])),
        seconds=sum(each.seconds for each in outcomes),
        goal=outcomes[0].goal,
        rounded=any(each.rounded for each in outcomes) and not all(each.is_reached for each in outcomes),
        rounding=sqrt(mean([each.rounding**2 for each in outcomes])),
    )
