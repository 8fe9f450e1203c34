"""The camera frame: right, up and forward, compared with values derived by hand from the format's definition."""

from __future__ import annotations

from math import hypot, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Camera

ROOT = sqrt(0.5)


@pytest.mark.parametrize(
    ("direction", "right", "up"),
    [
        ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
        ((0, 0, 1), (-1, 0, 0), (0, 1, 0)),
        ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
        ((0, 1, 0), (1, 0, 0), (0, 0, 1)),
        ((0, -1, 0), (1, 0, 0), (0, 0, -1)),
        ((1e-300, 1, 0), (0, 0, 1), (-1, 0, 0)),
        ((0, -1, 5e-324), (-1, 0, 0), (0, 0, 1)),
        ((5e-324, 1, 5e-324), (-ROOT, 0, ROOT), (-ROOT, 0, -ROOT)),
        ((0, ROOT, -ROOT), (1, 0, 0), (0, ROOT, ROOT)),
    ],
)
def test_the_axes_of_the_camera_frame(direction, right, up):
    got_right, got_up, got_forward = camera_frame(Camera((0, 0, 0), direction, 60))
    assert got_right == pytest.approx(right, abs=1e-15)
    assert got_up == pytest.approx(up, abs=1e-15)
    assert got_forward == pytest.approx(direction, abs=1e-15)


def test_a_roll_is_clockwise_from_the_camera():
    right, up, _ = camera_frame(Camera((0, 0, 0), (0, 0, -1), 60, roll=90))
    assert up == pytest.approx((1, 0, 0), abs=1e-15)
    assert right == pytest.approx((0, -1, 0), abs=1e-15)


component = st.floats(-1, 1)


@given(st.tuples(component, component, component).filter(any), st.floats(-360, 360))
def test_the_camera_frame_is_orthonormal_and_right_handed(direction, roll):
    right, up, forward = camera_frame(Camera((0, 0, 0), direction, 60, roll=roll))
    for one in (right, up, forward):
        assert hypot(*one) == pytest.approx(1, abs=1e-14)
    for one, other in ((right, up), (up, forward), (forward, right)):
        assert sum(a * b for a, b in zip(one, other, strict=True)) == pytest.approx(0, abs=1e-14)
    (a, b, c), (d, e, f) = right, forward
    assert up == pytest.approx((b * f - c * e, c * d - a * f, a * e - b * d), abs=1e-14)
