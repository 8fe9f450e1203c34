"""Primary rays and camera frames derived by hand; `tests/rendering/test_buffers.py` has the rays of the reference."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

import minirt
from minirt.kernel.frame import ray_direction
from minirt.rendering.packing.camera import camera_frame, pixel_rays
from minirt.scene import Ambient, Camera, Scene
from minirt.shapes.sphere import Sphere

Array = np.ndarray


def ours(camera: Camera, width: int, height: int) -> Array:
    """The unit directions of the rays that the program traces, (height, width, 3)."""
    rays = pixel_rays(camera, width, height)
    directions = [ray_direction(rays, i + 0.5, j + 0.5) for j in range(height) for i in range(width)]
    return normalized(np.array([(v.x, v.y, v.z) for v in directions]).reshape(height, width, 3))


def normalized(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_a_left_handed_camera_has_the_mirrored_picture() -> None:
    camera = Camera((3, -2, 11), (-0.4, 0.3, -0.9), 35)
    assert_allclose(ours(camera.replace(left_handed=True), 16, 9), ours(camera, 16, 9)[:, ::-1], atol=1e-12)


@pytest.mark.parametrize("roll", [0.0, 30.0])
def test_look_at_has_the_target_in_the_centre(roll: float) -> None:
    eye, target = (1.0, 2.0, 3.0), (-4.0, 7.0, 11.0)
    camera = Camera.look_at(eye, target, fov=40, roll=roll)
    assert (camera.position, camera.fov, camera.roll) == (eye, 40.0, roll)
    middle = ours(camera, 5, 3)[1, 2]
    assert_allclose(np.cross(middle, np.subtract(target, eye)), 0, atol=1e-12)
    shown = minirt.render(Scene([Ambient(1, (255, 255, 255)), camera, Sphere(target, 1, (255, 0, 0))]), 33, 21).array
    assert_allclose(np.argwhere(shown[..., 0]).mean(axis=0), [10, 16], atol=0.1)


def test_look_at_needs_two_different_points() -> None:
    with pytest.raises(ValueError, match="two different points"):
        Camera.look_at((1, 2, 3), (1, 2, 3))


def test_look_at_works_far_and_near() -> None:
    assert Camera.look_at((0, 0, 0), (0, 0, 1e300)).direction == (0.0, 0.0, 1.0)
    assert_allclose(Camera.look_at((0, 0, 0), (1e-300, 0, 1e-300)).direction, [0.5**0.5, 0, 0.5**0.5])


# The camera frame: right, up and forward, compared with values derived by hand from the format's definition.


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
