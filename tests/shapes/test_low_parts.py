"""What rounded numbers of packed shapes lack, against 420 bits."""

from __future__ import annotations

import numpy as np
import pytest
from gmpy2 import mpfr, sqrt

from minirt.fields import cos_and_sin
from minirt.lanes import Vec
from minirt.shapes.compensated import axis_low, basis_low, quotient_low, root_low
from minirt.shapes.frames import basis
from tests.oracle.body import own_axes, unit
from tests.shapes.regimes import random_directions

AXES = [(0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1e-300, 1.0), (0.6, 0.8, 0.0)]
AXES += map(tuple, random_directions(np.random.default_rng(1), 50).tolist())
LENGTHS = np.random.default_rng(2).uniform(0.5, 2, (100, 2)) * 10.0 ** np.random.default_rng(3).integers(
    -9, 9, (100, 2)
)


def missing(exact: list[mpfr], high: Vec, low: Vec) -> float:
    """The largest difference between an exact vector and the sum of its rounded one and what that lacks."""
    parts = zip(exact, (high.x, high.y, high.z), (low.x, low.y, low.z), strict=True)
    return max(float(abs(x - mpfr(a) - mpfr(b))) for x, a, b in parts)


def test_an_axis_is_known_to_32_digits() -> None:
    for axis in AXES:
        assert missing(unit(axis), Vec(*axis), axis_low(axis)) <= 2.0**-104


@pytest.mark.parametrize("roll", [0.0, 90.0, -270.0, 1e-7, 33.3, -200.0])
def test_a_basis_is_known_to_32_digits(roll: float) -> None:
    c, s = unit((*cos_and_sin(roll), 0.0))[:2]  # the turn that is meant has exactly this tangent
    for axis in AXES:
        z, x, y = basis(axis, roll)
        z_low, x_low, y_low = basis_low(axis, roll, z, x, y)
        found = (x, x_low), (y, y_low), (z, z_low)
        own_x, own_y, own_z = own_axes(axis, 0.0)
        rolled_x = [c * a - s * b for a, b in zip(own_x, own_z, strict=True)]
        rolled_z = [c * b + s * a for a, b in zip(own_x, own_z, strict=True)]
        for exact, (high, low) in zip((rolled_x, own_y, rolled_z), found, strict=True):
            opposite = [-part for part in exact]  # may be meant just as well
            assert min(missing(exact, high, low), missing(opposite, high, low)) <= 2.0**-102


def test_slopes_are_known_to_32_digits() -> None:
    for a, b in LENGTHS.tolist():
        slope = a / 2 / b
        low = quotient_low((a,), (2.0, b), slope)
        assert abs(mpfr(a) / mpfr(b) / 2 - mpfr(slope) - mpfr(low)) <= slope * 2.0**-104
        exact = sqrt(mpfr(3 * a) ** 2 - mpfr(a) ** 2) / mpfr(b)
        low = root_low(3 * a, a, b, float(exact))
        assert abs(exact - mpfr(float(exact)) - mpfr(low)) <= exact * 2.0**-100


def test_numbers_beyond_all_bounds_lack_nothing() -> None:
    assert quotient_low((1e300,), (1e-300,), np.inf) == 0.0
    assert root_low(1.0, 1.0, 2.0, 0.0) == 0.0
