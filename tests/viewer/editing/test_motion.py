"""Rotation of directions, and of elements with several points."""

from __future__ import annotations

import pytest

from minirt.shapes.triangle import Triangle
from minirt.viewer.editing.motion import rotate, rotate_direction


def test_a_triangle_turns_right_handed_about_its_centre() -> None:
    triangle = Triangle((0, 0, 7), (3, 0, 7), (0, 3, 7), (9, 9, 9))  # around 1,1,7
    turned = rotate(triangle, (0, 0, 1), 90)
    assert [turned.a, turned.b, turned.c] == [pytest.approx(each) for each in ((2, 0, 7), (2, 3, 7), (-1, 0, 7))]


def test_a_third_of_a_turn_about_the_diagonal_exchanges_the_axes() -> None:
    diagonal, axes = (3**-0.5,) * 3, [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    turned = [rotate_direction(each, diagonal, 120) for each in axes]
    assert turned == [pytest.approx(each, abs=1e-15) for each in (axes[1], axes[2], axes[0])]
