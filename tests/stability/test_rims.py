"""Rays close to the rim of a solid hit the right part of it, unless they pass the rim within 64 roundings.

The roundings are those of t, of the distance from the origin to the shape and of the shape's size. A ray that close may
miss the rim and hit the shape far behind it, such as the other end of a hyperboloid.
"""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np
import pytest
from gmpy2 import mpfr, sqrt

from minirt.shapes import Shape
from minirt.shapes.hyperboloid import Hyperboloid
from tests.oracle.vectors import cross, dot, exact, minus, unit
from tests.shapes import mutants
from tests.shapes.execution_modes import Intersect
from tests.stability.execution_modes import MODES
from tests.stability.regime import posed
from tests.stability.table import REGIMES

RIMS: dict[str, tuple[tuple[str, float], ...]] = {  # for each rim its height above the point, in heights of the shape
    "cylinder": (("centre", -0.5), ("centre", 0.5)),
    "hyperboloid": (("centre", -0.5), ("centre", 0.5)),
    "cone": (("apex", 1.0),),
    "paraboloid": (("vertex", 1.0),),
}
AT_THE_RIM = {kind.element.title: regime for kind, regime in REGIMES if regime.name == "at the rim"}


def beside_rim(shape: Any, point: str, share: float, origin: Any, direction: Any) -> mpfr:
    """Distance of a ray from a rim, to first order: from the rim's tangent where the ray crosses its plane."""
    axis, d = unit(shape.axis), exact(direction)
    p = minus(exact(origin), exact(getattr(shape, point)))
    s = (mpfr(share) * mpfr(shape.height) - dot(p, axis)) / dot(d, axis)
    crossed = [a + s * b for a, b in zip(p, d, strict=True)]
    radial = minus(crossed, [dot(crossed, axis) * x for x in axis])
    radius = sqrt(dot(radial, radial))
    out = [x / radius for x in radial]
    across = cross(d, cross(axis, out))  # the way and the tangent are both perpendicular to it
    return abs(radius - mpfr(shape.diameter) / 2) * abs(dot(out, across)) / sqrt(dot(across, across))


def beside(shape: Shape, origin: Any, direction: Any) -> float:
    return float(min(beside_rim(shape, *rim, origin, direction) for rim in RIMS[shape.title]))


def wrong(title: str, intersect: Intersect) -> int:
    """Number of rays with a wrong answer that pass all rims farther away than that."""
    right = posed(AT_THE_RIM[title])
    shapes, origins, directions = right.rays
    t = intersect(*right.rays)
    with np.errstate(invalid="ignore"):
        elsewhere = (t != right.t) & ~(np.abs(t - right.t) <= 1e-12 * right.t)
    rays = np.argwhere(elsewhere).tolist()
    return sum(beside(shapes[i], origins[i, j], directions[i, j]) > right.swell(i, j) for i, j in rays)


@pytest.mark.parametrize("way", ["arrays", "compiled"])
@pytest.mark.parametrize("title", RIMS)
def test_only_rays_within_64_roundings_of_a_rim_may_take_it_for_another_place(title: str, way: str) -> None:
    assert wrong(title, MODES[way][0]) == 0


def test_a_crack_is_found() -> None:
    assert wrong("cylinder", mutants.with_formula(mutants.naive_cylinder)) > 0


def sharpness(shape: Hyperboloid) -> float:
    """Distance by which the rim of a hyperboloid moves if its side and its caps move by 1: the sharper, the farther."""
    radius, waist, half = shape.diameter / 2, shape.waist / 2, shape.height / 2
    falling = (radius**2 - waist**2) / half
    steepest = hypot(radius, falling)  # half of the gradient's length at the rim
    mean = (waist * steepest) ** 0.5  # as in the oracle, which moves the rim's side by a little more than 1
    return hypot(1.0, ((steepest**2 / mean + mean) / 2 + falling) / radius)


def test_so_close_to_the_rim_of_a_hyperboloid_rounding_chooses_between_its_ends() -> None:
    right = posed(AT_THE_RIM["hyperboloid"])
    ambiguous = 0
    for i, shape in enumerate(right.rays.shapes):
        for j in range(right.t.shape[1]):
            thicker, thinner = right.thicker_and_thinner(i, j)
            if np.isfinite(thinner) and thinner - thicker > 1e-3 * thicker:
                close = right.swell(i, j) * sharpness(shape)
                assert beside(shape, right.rays.origins[i, j], right.rays.directions[i, j]) <= close
                ambiguous += 1
    assert ambiguous > 0
