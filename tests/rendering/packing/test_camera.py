"""Primary rays, compared with four other derivations of a pinhole camera."""

from __future__ import annotations

from collections.abc import Callable
from math import atan, degrees, radians, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

import minirt
from minirt.kernel.frame import ray_direction
from minirt.rendering.packing.camera import camera_numbers, pixel_rays
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
    rays = pixel_rays(camera_numbers(camera, width, height), width, height)
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


def vertical_angle(camera: Camera, width: int, height: int) -> float:
    """The vertical field of view, in degrees, for the horizontal one of the camera."""
    return degrees(2 * atan(tan(radians(camera.fov) / 2) * height / width))


def by_normalized_coordinates(camera: Camera, width: int, height: int) -> Array:
    """Pixel to normalized device coordinates in [0, 1], to the screen in [-1, 1], to the camera's plane z = -1, whose
    half height is the tangent of half of the vertical angle; then the matrix from camera to world, for row vectors."""
    column, row = pixels(width, height)
    device_x, device_y = (column + 0.5) / width, (row + 0.5) / height
    screen_x, screen_y = 2 * device_x - 1, 1 - 2 * device_y
    aspect, half = width / height, tan(radians(vertical_angle(camera, width, height)) / 2)
    forward = np.array(camera.direction)
    right = normalized(np.cross(UP, -forward))
    camera_to_world = np.eye(4)
    camera_to_world[:3, :3] = right, np.cross(-forward, right), -forward
    camera_to_world[3, :3] = camera.position
    points = np.stack([screen_x * aspect * half, screen_y * half, -np.ones_like(row), np.ones_like(row)], axis=-1)
    moved = points @ camera_to_world
    return normalized(moved[..., :3] - camera_to_world[3, :3])


def by_look_at_matrix(camera: Camera, width: int, height: int) -> Array:
    """Points of the plane z = -1, taken to world space by the inverse of the look-at matrix."""
    column, row = pixels(width, height)
    half = tan(radians(camera.fov) / 2)
    x = (2 * (column + 0.5) / width - 1) * half
    y = (1 - 2 * (row + 0.5) / height) * half * height / width
    return from_points(np.linalg.inv(look_at(camera)), np.stack([x, y, -np.ones_like(x), np.ones_like(x)], axis=-1))


def by_viewport_vectors(camera: Camera, width: int, height: int) -> Array:
    """Lower left corner + u horizontal + v vertical, rows from below. u = i / width is the left edge of a pixel; its
    centre is half a pixel further."""
    column, row = pixels(width, height)
    eye, w = np.array(camera.position), -normalized(np.array(camera.direction))
    right = normalized(np.cross(UP, w))
    half_height = tan(radians(vertical_angle(camera, width, height)) / 2)
    half_width = half_height * width / height
    horizontal, vertical = 2 * half_width * right, 2 * half_height * np.cross(w, right)
    lower_left_corner = eye - horizontal / 2 - vertical / 2 - w
    u, v = (column + 0.5) / width, (height - 1 - row + 0.5) / height
    return normalized(lower_left_corner + u[..., None] * horizontal + v[..., None] * vertical - eye)


def by_screen_to_camera(camera: Camera, width: int, height: int) -> Array:
    """A matrix from screen space, (column, row, 0, 1) in pixels, to camera space; another one from there to the
    world."""
    column, row = pixels(width, height)
    half = tan(radians(camera.fov) / 2)
    pixel = 2 * half / width
    screen_to_camera = np.array(
        [[pixel, 0, 0, -half], [0, -pixel, 0, half * height / width], [0, 0, 1, -1], [0, 0, 0, 1]]
    )
    centres = np.stack([column + 0.5, row + 0.5, np.zeros_like(row), np.ones_like(row)], axis=-1)
    return from_points(np.linalg.inv(look_at(camera)), centres @ screen_to_camera.T)


MODELS = [by_normalized_coordinates, by_look_at_matrix, by_viewport_vectors, by_screen_to_camera]
Model = Callable[[Camera, int, int], Array]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("size", SIZES)
def test_other_models_of_a_camera_have_the_same_rays(model: Model, camera: Camera, size: tuple[int, int]) -> None:
    assert_allclose(model(camera, *size), ours(camera, *size), atol=1e-10)


@pytest.mark.parametrize("model", MODELS)
def test_left_handed_models_have_the_mirrored_picture(model: Model) -> None:
    # Left-handed coordinates are those of the scene with the sign of z changed.
    camera, size = CAMERAS[3], (16, 9)
    x, y, z = camera.position
    a, b, c = camera.direction
    through_the_mirror = model(Camera((x, y, -z), (a, b, -c), camera.fov), *size) * [1, 1, -1]
    assert_allclose(through_the_mirror, ours(camera.replace(left_handed=True), *size), atol=1e-12)
    assert_allclose(through_the_mirror, ours(camera, *size)[:, ::-1], atol=1e-12)


def test_rays_go_through_the_centres_of_pixels_not_their_corners() -> None:
    # Rays through the corners, u = i / width, are found in a picture of twice the size.
    fine = ours(CAMERAS[1], 32, 18)
    coarse = ours(CAMERAS[1], 16, 9)
    assert np.abs(coarse - fine[::2, ::2]).max() > 0.01
    assert_allclose(normalized(fine[8:10, 14:16].sum(axis=(0, 1))), coarse[4, 7], atol=1e-3)


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


def test_a_left_handed_picture_is_mirrored() -> None:
    path = "scenes/figure-v4-everything.rt"
    right, left = minirt.load(path), minirt.load(path, left_handed=True)
    assert left.camera.left_handed
    assert not right.camera.left_handed
    shown = minirt.render(left, 64, 36).array[:, ::-1].astype(int)
    assert (np.abs(shown - minirt.render(right, 64, 36).array).max(axis=-1) > 1).mean() < 0.01
    assert left.replace(left.camera, left_handed=False) == right
