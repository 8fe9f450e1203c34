"""Checks of the answers of `intersect` against those of the oracle."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests import oracle
from tests.shapes.execution_modes import Intersect
from tests.shapes.regimes import Rays

Array = NDArray[np.float64]
U = 2.0**-53


class Answers(NamedTuple):
    """t of each ray, infinity for a miss: for the shape, and for shapes thicker and thinner by a slack of roundings."""

    t: Array
    thicker: Array
    thinner: Array


@cache
def solved(make: Callable[..., Rays], *how: object, **more: object) -> tuple[Rays, Answers]:
    """The rays of a regime and the exact answers."""
    rays = make(*how, **more)
    return rays, answers(rays)


def answers(rays: Rays) -> Answers:
    table = np.full((3, *rays.origins.shape[:2]), np.inf)
    for i, shape in enumerate(rays.shapes):
        point = next(value for value in vars(shape).values() if isinstance(value, tuple))
        lengths = [getattr(shape, name) for name in ("diameter", "height") if hasattr(shape, name)]
        for j, (origin, direction) in enumerate(zip(rays.origins[i], rays.directions[i], strict=True)):
            t = oracle.nearest(shape, origin, direction)
            slack = 64 * U * (float(t or 0) + float(np.linalg.norm(origin - point)) + sum(lengths))
            for row, swell in enumerate((0.0, slack, -slack)):
                at = oracle.nearest(shape, origin, direction, swell)
                table[row, i, j] = np.inf if at is None else float(at)
    return Answers(*table)


def relative_errors(t: Array, right: Answers) -> Array:
    """|t - exact| / exact for the rays that hit both the thicker and the thinner shape."""
    sure = np.isfinite(right.thicker) & np.isfinite(right.thinner) & np.isfinite(t)
    return np.abs(t[sure] - right.t[sure]) / right.t[sure]


def assert_verdicts(t: Array, right: Answers) -> None:
    """Assert that there is no false miss or hit, unless the thicker or the thinner shape has the same verdict."""
    missed, hit = np.isinf(t), np.isfinite(t)
    assert not (missed & np.isfinite(right.thinner) & np.isfinite(right.thicker)).any(), "false miss"
    assert not (hit & np.isinf(right.thicker) & np.isinf(right.thinner)).any(), "false hit"


def assert_near(t: Array, right: Answers, tolerance: float) -> None:
    """Assert that the verdicts are right and t is exact within the relative `tolerance`."""
    assert_verdicts(t, right)
    errors = relative_errors(t, right)
    assert errors.size > 50, "too few of these rays hit"
    assert errors.max() <= tolerance


def errors_of(intersect: Intersect, rays: Rays, right: Answers) -> Array:
    return relative_errors(intersect(*rays), right)
