"""Degenerate rays of every kind of shape, generated from its special places, and the answers that are wrong.

    python -m tests.stability.degenerate [--rays 1000000] [--seed 1] [--mode arrays] [sphere cylinder ...]

Prints a line for each kind and a few of the wrong rays; the status is 1 if there are any. First all rays are judged in
numbers of 106 bits, then those that seem wrong in 60 digits.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from minirt.shapes import KINDS, Kind, Shape
from tests.shapes.execution_modes import Array, Intersect
from tests.stability.band import facts_of_each, facts_of_many, right
from tests.stability.execution_modes import MODES
from tests.stability.poses import pose
from tests.stability.snapping import snapped

CLEAR = 2.0**-50  # relative difference from the exact answer below which nothing else is asked


class Wrong(NamedTuple):
    """A ray with a wrong answer."""

    shape: Shape
    origin: list[float]
    direction: list[float]
    t: float
    exact: float

    def __str__(self) -> str:
        return f"t = {self.t!r}, not {self.exact!r}: {self.shape} from {self.origin} along {self.direction}"


def groups(kind: Kind, seed: int, shapes: int, rays: int) -> Iterator[tuple[Shape, Array, Array]]:
    """Shapes of a kind in random poses, and for each its snapped rays."""
    random = np.random.default_rng(seed)
    for _ in range(shapes):
        shape = pose(kind, random)
        with np.errstate(all="ignore"):
            yield shape, *snapped(shape, random, rays)


def wrong(intersect: Intersect, shape: Shape, origins: Array, directions: Array) -> list[Wrong]:
    """The rays whose answer is wrong."""
    t = intersect([shape], origins[None], directions[None])[0]
    with np.errstate(all="ignore"):
        facts = facts_of_many(shape, origins, directions, t)
        seem = np.flatnonzero(~right(shape, directions, t, facts))
        if not seem.size:
            return []
        o, d, t = origins[seem], directions[seem], t[seem]
        exact = facts_of_each(shape, o, d, t)
        sure = ~right(shape, d, t, exact)
    return [
        Wrong(shape, o[i].tolist(), d[i].tolist(), float(t[i]), float(exact.exact[i])) for i in np.flatnonzero(sure)
    ]
