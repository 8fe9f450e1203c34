"""A regime: rays that are hard in one way, the exact answers, and the accuracy that is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np
from gmpy2 import mpfr
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.shapes import Shape
from minirt.shapes.triangle import Triangle
from tests import oracle
from tests.oracle.body import body, inside
from tests.shapes.regimes import Rays

Array = NDArray[np.float64]
U = 2.0**-53


class Regime(NamedTuple):
    """A recipe for rays, and the error that an answer may have.

    An answer passes if its relative error is at most `tolerance`. Where the surface ends or turns away from the ray,
    rounding the ray's own numbers changes the exact answer. There an answer passes if it lies between those for a shape
    thicker and a shape thinner by `slack` roundings of t, of the distance between origin and shape and of the shape's
    size; if all three hit, it must agree with one within `blur`. If the ray misses the thinner shape, and it
    is a solid, any hit in the thicker one passes: along a straight side its ends may be far away.

    Flat shapes are made larger and smaller instead of thicker and thinner, and have no chosen tolerance: for a ray at a
    slope s, the error of t is at most 4 roundings of t, of the distance from origin to shape and of its `lever`,
    divided by s. The exact answer changes by as much when the origin moves by these roundings.
    """

    name: str
    make: Callable[[], Rays]
    tolerance: float = 1e-13
    slack: float = 64.0
    blur: float = 1e-13


class Right:
    """The rays of a regime and the exact answers, computed on demand."""

    def __init__(self, regime: Regime, rays: Rays) -> None:
        self.regime, self.rays = regime, rays
        self.solid = body(rays.shapes[0]).solid
        self.normal = lru_cache(None)(lambda i: oracle.normal(rays.shapes[i], rays.origins[i, 0]))  # of a sheet
        self.t = np.array([[self.at(i, j) for j in range(rays.origins.shape[1])] for i in range(len(rays.shapes))])
        self.around = lru_cache(None)(self.thicker_and_thinner)

    def at(self, i: int, j: int, swell: float = 0.0) -> float:
        t = oracle.nearest(self.rays.shapes[i], self.rays.origins[i, j], self.rays.directions[i, j], mpfr(swell))
        return np.inf if t is None else float(t)

    def thicker_and_thinner(self, i: int, j: int) -> tuple[float, float]:
        swell = self.swell(i, j)
        return self.at(i, j, swell), self.at(i, j, -swell)

    def swell(self, i: int, j: int) -> float:
        t = self.t[i, j]
        return self.regime.slack * U * ((t if np.isfinite(t) else 0.0) + self.away(i, j) + size(self.rays.shapes[i]))

    def away(self, i: int, j: int) -> float:
        return float(np.linalg.norm(self.rays.origins[i, j] - points(self.rays.shapes[i])[0]))

    def sheet_error(self, i: int, j: int, t: float) -> float:
        """Return the allowed error of a hit at t on a flat shape."""
        slope = float(abs(oracle.dot(self.normal(i), self.rays.directions[i, j])))
        return 4 * U * (t + self.away(i, j) + lever(self.rays.shapes[i])) / slope

    def within_thicker(self, i: int, j: int, t: float) -> bool:
        origin, direction = self.rays.origins[i, j], self.rays.directions[i, j]
        point = [mpfr(o) + mpfr(t) * mpfr(d) for o, d in zip(origin, direction, strict=True)]
        return inside(body(self.rays.shapes[i], mpfr(self.swell(i, j))), point)

    def wrong(self, t: Array, every: int = 1) -> list[str]:
        """List the errors in the answers t for every n-th ray of a shape; infinity is a miss."""
        return list(self.errors(t, every))

    def errors(self, t: Array, every: int = 1) -> Iterator[str]:
        """Yield the errors of `wrong` one by one, as each takes some time to find."""
        right = self.t[:, ::every]
        with np.errstate(invalid="ignore"):
            near = np.isfinite(right) & (np.abs(t - right) <= self.regime.tolerance * right)
        exact = (t == right) | (near & self.solid)
        found = (self.verdict(i, j * every, t[i, j]) for i, j in np.argwhere(~exact).tolist())
        return (each for each in found if each)

    def verdict(self, i: int, j: int, t: float) -> str:
        """Describe the error of an answer; empty if the answer is accurate enough."""
        if not self.solid and abs(t - self.t[i, j]) < self.sheet_error(i, j, self.t[i, j]):  # not inf < inf
            return ""
        sides = [self.t[i, j], *self.around(i, j)]
        hits = [side for side in sides if np.isfinite(side)]
        if np.isinf(t):
            fine = len(hits) < 3
        elif not self.solid:
            fine = 0 < len(hits) < 3 and abs(t - hits[0]) <= self.sheet_error(i, j, hits[0])
        else:
            fine = bool(hits) and min(hits) * (1 - U) <= t <= max(hits) * (1 + self.regime.blur)
            fine &= len(hits) < 3 or min(abs(t - side) / side for side in sides) <= self.regime.blur
            fine |= len(hits) < 3 and self.within_thicker(i, j, t)
        if fine:
            return ""
        ray = f"{self.rays.origins[i, j].tolist()}, {self.rays.directions[i, j].tolist()}"
        return f"t = {t!r}, not {sides[0]!r}, with slack {sides[1:]}: {self.rays.shapes[i]} from {ray}"


@cache
def posed(regime: Regime) -> Right:
    """Return the rays of a regime with their exact answers, computed once."""
    return Right(regime, regime.make())


def points(shape: Shape) -> list[Array]:
    """Return the points that define a shape."""
    return [np.array(getattr(shape, each.name)) for each in fields_of(type(shape)) if isinstance(each, Point)]


def lever(shape: Shape) -> float:
    """Return the length of which a hit's position in a triangle is known up to roundings.

    The position is the mean of the corners weighted by areas, which are known up to roundings of the square of the
    longest edge. For a sliver that error is large, and along the sliver.
    """
    if not isinstance(shape, Triangle):
        return 0.0
    longest = max(float(np.linalg.norm(edge)) for edge in shape.edges())
    twice_the_area = float(np.linalg.norm(np.cross(*shape.edges()[:2])))
    return longest**3 / twice_the_area


def size(shape: Shape) -> float:
    """Return the sum of the lengths that define a shape, and of the distances between its points."""
    lengths = [np.sum(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, (Length, Lengths))]
    first, *others = points(shape)
    return float(sum(lengths) + sum(np.linalg.norm(other - first) for other in others))
