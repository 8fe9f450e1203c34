"""Specular highlights by Phong and by Blinn, against closed forms of the angles."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

from minirt.kernel.shading.lights import specular
from minirt.lanes import Vec

UP = Vec(*(np.full(16, each) for each in (0.0, 1.0, 0.0)))
LIT = np.ones(16, bool)


def highlight(light: float, eye: float, k: float, n: float, blinn: bool, lit: np.ndarray = LIT) -> float:
    """Return the highlight of a floor; light and eye are so many degrees from its normal, on opposite sides of it."""
    to_light = Vec(*(np.full(16, each) for each in (-sin(radians(light)), cos(radians(light)), 0.0)))
    direction = Vec(*(np.full(16, each) for each in (-sin(radians(eye)), -cos(radians(eye)), 0.0)))
    material = Vec(*(np.full(16, each) for each in (k, n, float(blinn))))
    share = specular(material, UP, to_light, direction, lit)
    assert np.array_equal(share, np.full(16, share[0]))
    return float(share[0])


@pytest.mark.parametrize("blinn", [False, True])
def test_highlight_in_the_mirrored_direction_is_the_coefficient(blinn: bool) -> None:
    assert highlight(35, 35, 0.7, 50, blinn) == pytest.approx(0.7, rel=1e-12)


@pytest.mark.parametrize("n", [1.0, 2.5, 50.0, 1000.0])
@pytest.mark.parametrize("eye", [20.0, 33.0, 50.0])
def test_highlight_beside_the_mirrored_direction_follows_the_power_of_the_cosine(eye: float, n: float) -> None:
    # Phong: the angle between mirrored light and eye; Blinn: half of that, between the normal and the halfway vector.
    assert highlight(35, eye, 0.7, n, False) == pytest.approx(0.7 * cos(radians(eye - 35)) ** n, rel=1e-10)
    assert highlight(35, eye, 0.7, n, True) == pytest.approx(0.7 * cos(radians((eye - 35) / 2)) ** n, rel=1e-10)


def test_no_highlight_behind_the_mirrored_direction_or_in_shadow() -> None:
    assert highlight(60, -40, 1, 1, False) == 0  # 100 degrees apart
    assert highlight(60, -40, 1, 1, True) == pytest.approx(cos(radians(50)))
    assert highlight(35, 35, 0.7, 50, False, ~LIT) == 0
    assert highlight(35, 35, 0, 50, False) == 0
