"""Highlights in both forms, against angles."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

from minirt.kernel.shading.specular import specular
from minirt.lanes import Vec

UP = Vec(*(np.full(16, each) for each in (0.0, 1.0, 0.0)))
LIT = np.ones(16, bool)


def seen(lamp: float, eye: float, k: float, n: float, blinn: bool, lit: np.ndarray = LIT) -> float:
    """The highlight of a floor, lamp and eye so many degrees from its normal, the eye on the other side of it."""
    towards = Vec(*(np.full(16, each) for each in (-sin(radians(lamp)), cos(radians(lamp)), 0.0)))
    gaze = Vec(*(np.full(16, each) for each in (-sin(radians(eye)), -cos(radians(eye)), 0.0)))
    look = Vec(*(np.full(16, each) for each in (k, n, float(blinn))))
    share = specular(look, UP, towards, gaze, lit)
    assert np.array_equal(share, np.full(16, share[0]))
    return float(share[0])


@pytest.mark.parametrize("blinn", [False, True])
def test_in_the_mirrored_direction_it_is_the_coefficient(blinn: bool) -> None:
    assert seen(35, 35, 0.7, 50, blinn) == pytest.approx(0.7, rel=1e-12)


@pytest.mark.parametrize("n", [1.0, 2.5, 50.0, 1000.0])
@pytest.mark.parametrize("eye", [20.0, 33.0, 50.0])
def test_aside_of_it(eye: float, n: float) -> None:
    # Phong: the angle between the mirrored lamp and the eye; Blinn: half of it, between the normal and the halfway one.
    assert seen(35, eye, 0.7, n, False) == pytest.approx(0.7 * cos(radians(eye - 35)) ** n, rel=1e-10)
    assert seen(35, eye, 0.7, n, True) == pytest.approx(0.7 * cos(radians((eye - 35) / 2)) ** n, rel=1e-10)


def test_none_behind_the_mirrored_direction_and_none_in_the_shadow() -> None:
    assert seen(60, -40, 1, 1, False) == 0  # 100 degrees apart
    assert seen(60, -40, 1, 1, True) == pytest.approx(cos(radians(50)))
    assert seen(35, 35, 0.7, 50, False, ~LIT) == 0
    assert seen(35, 35, 0, 50, False) == 0
