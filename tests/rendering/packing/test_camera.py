"""Primary rays, compared with the look-at matrix of a pinhole camera and with frames derived by hand."""

from __future__ import annotations

from math import radians, sqrt, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

import minirt
from minirt.kernel.frame import ray_direction
from minirt.rendering.packing.camera import camera_frame, pixel_rays
from minirt.scene import Ambient, Camera, Scene
from minirt.shapes.sphere import Sphere

Array = np.ndarray
UP = np.array([0.0, 1.0, 0.0])
SIZES = [(16, 9), (7, 13), (5, 5)]
CAMERAS = [
    Camera((0, 0, 0), (0, 0, -1), 90),
    Camera((0, 0, 0), (0, 0, 1), 60),
    Camera((-50, 0, 20), (0, 0, 1), 70),
    Camera((3, -2, 11), (-0.4, 0.3, -0.9), 35),
    Camera((1, 2, 3), (1, 0, 0), 120),
    Camera((1e3, 5, -7), (0.2, -0.95, 0.1), 4),
]


def ours(camera: Camera, width: int, height: int) -> Array:
    """The unit directions of the rays that the program traces, (height, width, 3)."""
    rays = pixel_rays(camera, width, height)
    directions = [ray_direction(rays, i + 0.5, j + 0.5) for j in range(height) for i in range(width)]
    return normalized(np.array([(v.x, v.y, v.z) for v in directions]).reshape(height, width, 3))


def normalized(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def pixels(width: int, height: int) -> tuple[Array, Array]:
    """Column and row of each pixel, from the upper left one."""
    row, column = np.mgrid[:height, :width].astype(float)
    return column, row


def look_at(camera: Camera) -> Array:
    """The matrix from world space to camera space, for column vectors; the camera looks along its -z with +y up."""
    eye, forward = np.array(camera.position), normalized(np.array(camera.direction))
    side = normalized(np.cross(forward, UP))
    matrix = np.eye(4)
    matrix[:3, :3] = side, np.cross(side, forward), -forward
    matrix[:3, 3] = -matrix[:3, :3] @ eye
    return matrix


def from_points(camera_to_world: Array, points: Array) -> Array:
    """Directions from the camera to homogeneous points (..., 4) in camera space."""
    moved = points @ camera_to_world.T
    origin = camera_to_world @ [0, 0, 0, 1]
    return normalized(moved[..., :3] / moved[..., 3:] - origin[:3] / origin[3])


def by_look_at_matrix(camera: Camera, width: int, height: int) -> Array:
    """Points of the plane z = -1, taken to world space by the inverse of the look-at matrix."""
    column, row = pixels(width, height)
    half = tan(radians(camera.fov) / 2)
    x = (2 * (column + 0.5) / width - 1) * half
    y = (1 - 2 * (row + 0.5) / height) * half * height / width
    return from_points(np.linalg.inv(look_at(camera)), np.stack([x, y, -np.ones_like(x), np.ones_like(x)], axis=-1))


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("size", SIZES)
def test_the_look_at_matrix_has_the_same_rays(camera: Camera, size: tuple[int, int]) -> None:
    assert_allclose(by_look_at_matrix(camera, *size), ours(camera, *size), atol=1e-10)


def test_a_left_handed_camera_has_the_mirrored_picture() -> None:
    # Left-handed coordinates are those of the scene with the sign of z changed.
    camera, size = CAMERAS[3], (16, 9)
    x, y, z = camera.position
    a, b, c = camera.direction
    through_the_mirror = by_look_at_matrix(Camera((x, y, -z), (a, b, -c), camera.fov), *size) * [1, 1, -1]
    assert_allclose(through_the_mirror, ours(camera.replace(left_handed=True), *size), atol=1e-12)
    assert_allclose(through_the_mirror, ours(camera, *size)[:, ::-1], atol=1e-12)


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
