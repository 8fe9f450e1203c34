"""Invariances of pictures: scaling, moving, mirroring or rotating a scene has a known effect on its picture; and
extreme cameras, sizes and positions, which have no effect but the right one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.element import Element, fields_of
from minirt.fields import Direction, Length, Lengths, Point
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Camera, FurtherLight, Light, Scene
from minirt.shapes import Box, Cylinder, Ellipsoid, Plane, Sphere, Square
from tests import reference
from tests.kernel.pictures import ALL, AMBIENT, BLUE, EVERY, EYE, LAMP, SHAPES, WHITE, linear

SCENES = pytest.mark.parametrize("scene", [ALL, EVERY], ids=["some kinds", "every kind"])
UPRIGHT = (Box, Ellipsoid, Square)  # their axis alone does not determine their orientation
FREE = Scene(each for each in EVERY.elements if not isinstance(each, UPRIGHT))


def changed(scene: Scene, point: Any = None, length: Any = None, direction: Any = None) -> Scene:
    """Apply functions to the points, lengths and directions of a scene."""

    def change(element: Element) -> Element:
        changes = {}
        for each in fields_of(type(element)):
            if getattr(element, each.name) is None:
                continue
            lengths = length and (lambda sizes: tuple(map(length, sizes)))
            for kind, function in ((Point, point), (Length, length), (Lengths, lengths), (Direction, direction)):
                if function and isinstance(each, kind):
                    changes[each.name] = function(getattr(element, each.name))
        return element.replace(**changes)

    return Scene(change(element) for element in scene.elements)


def scaled(scene: Scene, factor: float) -> Scene:
    """Scale a scene about the origin."""
    return changed(scene, lambda p: tuple(factor * x for x in p), lambda length: factor * length)


@SCENES
@pytest.mark.parametrize("power", [-40, -30, -20, -10, -1, 1, 10, 20, 30, 40])
def test_a_scene_scaled_by_a_power_of_two_gives_the_same_bits(scene: Scene, power: int) -> None:
    assert np.array_equal(linear(scaled(scene, 2.0**power), 60, 40), linear(scene, 60, 40))


@SCENES
@pytest.mark.parametrize("shift", [(1e8, 0, 0), (-1e8, 1e8, 1e8), (1e4, -1e4, 1e3)])
def test_a_scene_far_from_the_origin_looks_the_same(scene: Scene, shift: tuple[float, float, float]) -> None:
    # Coordinates of 1e8 are known to 1e-8: away from edges the light changes by no more than a multiple of that.
    moved = linear(changed(scene, lambda p: tuple(x + y for x, y in zip(p, shift, strict=True))), 60, 40)
    change = np.abs(moved - linear(scene, 60, 40)).max(axis=-1)
    assert np.quantile(change, 0.995) <= 1e-5  # the rest may be at an edge
    assert (change[interior(scene, 60, 40)] <= 1e-5).all()


def interior(scene: Scene, width: int, height: int) -> np.ndarray:
    """Return a mask of the pixels without edges, over which the light changes little."""
    fine = linear(scene, 3 * width, 3 * height).reshape(height, 3, width, 3, 3)
    without_edges = np.ptp(fine, axis=(1, 3)).max(axis=-1) < 0.02
    assert 0.5 < without_edges.mean() < 1
    return without_edges


@SCENES
def test_a_mirrored_scene_gives_the_mirrored_picture(scene: Scene) -> None:
    mirror = lambda v: (-v[0], v[1], v[2])  # noqa: E731
    mirrored = changed(scene, mirror, None, mirror)
    difference = np.abs(linear(mirrored, 60, 40) - linear(scene, 60, 40)[:, ::-1]).max(axis=-1)
    assert np.quantile(difference, 0.995) <= 1e-12
    assert (difference[interior(scene, 60, 40)[:, ::-1]] <= 1e-12).all()


@pytest.mark.parametrize("scene", [ALL, FREE], ids=["some kinds", "most kinds"])
@pytest.mark.parametrize("seed", range(4))
def test_a_scene_rotated_with_its_camera_by_any_angle_differs_at_edges_only(scene: Scene, seed: int) -> None:
    rotate = random_rotation(np.random.default_rng(seed))
    rotated = changed(scene, lambda p: tuple(rotate @ p), None, lambda d: tuple((rotate @ d).clip(-1, 1)))
    right, up, _ = reference.camera_frame(rotated.camera)
    to_right = rotate @ reference.camera_frame(scene.camera)[0]  # the rotated camera's right; its roll restores it
    rotated = rotated.replace(rotated.camera, roll=float(np.degrees(np.arctan2(-to_right @ up, to_right @ right))))
    difference = np.abs(linear(rotated, 60, 40) - linear(scene, 60, 40)).max(axis=-1)
    assert (difference[interior(scene, 60, 40)] <= 1e-12).all()
    assert np.quantile(difference, 0.995) <= 1e-12


def random_rotation(random: np.random.Generator) -> np.ndarray:
    """Return the matrix of a random rotation."""
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return matrix * np.linalg.det(matrix)


def test_two_lights_of_half_brightness_equal_one() -> None:
    half = FurtherLight(LAMP.position, LAMP.brightness / 2, LAMP.colour)
    twice = linear(Scene((AMBIENT, EYE, half, half, *SHAPES)), 60, 40)
    assert np.abs(twice - linear(Scene((AMBIENT, EYE, LAMP, *SHAPES)), 60, 40)).max() <= 4e-16


# Extreme cameras, sizes and positions that a scene may have.


def finite(scene: Scene, width: int = 24, height: int = 16) -> np.ndarray:
    """Render a scene, and check that its light is finite and not negative."""
    light = linear(scene, width, height)
    assert np.isfinite(light).all()
    assert (light >= 0).all()
    return light


def test_a_field_of_view_of_a_thousandth_of_a_degree_has_as_many_rays_as_pixels() -> None:
    numbers = camera_numbers(EYE.replace(fov=1e-3), 1920, 1)
    x = 2 * (np.arange(1920) + 0.5) / 1920 - 1
    directions = numbers[9:] + x[:, None] * numbers[3:6]
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    assert len(np.unique(directions, axis=0)) == 1920
    # Rays a pixel apart differ: a striped wall 1e6 away would show 1920 stripes.
    wall = Scene((AMBIENT, LAMP, Camera((0, 0, 0), (0, 0, 1), 1e-3), Plane((0, 0, 1), (1, 0, -1), WHITE)))
    assert (np.diff(finite(wall, 192, 1)[0, :, 0]) != 0).all()


@pytest.mark.parametrize(("fov", "same"), [(0, 1e-6), (180, 179.9999)])
def test_extreme_fields_of_view_are_clamped_to_the_nearest_possible(fov: float, same: float) -> None:
    one, other = (finite(Scene((AMBIENT, LAMP, EYE.replace(fov=each), *SHAPES))) for each in (fov, same))
    assert np.array_equal(one, other)


@pytest.mark.parametrize(
    ("eye", "shape"),
    [
        ((0, 0, 0), Sphere((0, 0, 0), 2, WHITE)),  # in the centre
        ((0, 0, -1), Sphere((0, 0, 0), 2, WHITE)),  # on the surface, looking in
        ((0, 0, 1), Sphere((0, 0, 0), 2, WHITE)),  # on it, looking away
        ((0, 0, 0), Cylinder((0, 0, 0), (0, 0, 1), 2, 3, WHITE)),  # on the axis, along it
        ((0, 1, 0), Cylinder((0, 0, 0), (0, 0, 1), 2, 3, WHITE)),  # on the side
        ((0, 0, -1.5), Cylinder((0, 0, 0), (0, 0, 1), 2, 3, WHITE)),  # on a cap
        ((0, 1, -1.5), Cylinder((0, 0, 0), (0, 0, 1), 2, 3, WHITE)),  # on the rim
        ((0, 0, 0), Plane((0, 0, 0), (0, 1, 0), WHITE)),  # in the plane
        ((0, 0, 0), Plane((0, 0, 0), (0, 0, 1), WHITE)),
    ],
)
def test_eye_and_light_in_special_positions_give_finite_light(eye: tuple[float, float, float], shape: object) -> None:
    for lamp in (eye, (0, 0, 0), (0, 5, 0), (0, 0, 1e15)):
        finite(Scene((AMBIENT, Camera(eye, (0, 0, 1), 70), Light(lamp, 1.0), shape)))


def test_a_light_on_a_surface_does_not_light_that_surface() -> None:
    ball = Sphere((0, 0, 0), 2, WHITE)
    light = finite(Scene((AMBIENT, Camera((0, 0, -5), (0, 0, 1), 40), Light((0, 0, -1), 1.0), ball)))
    assert light.max() <= 0.15 + 1e-9
    floor = Plane((0, -1, 0), (0, 1, 0), WHITE)
    lit = finite(Scene((AMBIENT, Camera((0, 3, -5), (0, -0.6, 0.8), 60), Light((0, 1, 0), 1.0), ball, floor)), 48, 32)
    # The top of the sphere occludes the floor from a light that stands on it.
    assert lit.max() == pytest.approx(0.15, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_a_light_on_the_inside_of_a_sphere_lights_all_of_it(seed: int) -> None:
    # From every point of the wall, the cosine of the light's angle is the distance over the diameter.
    random = np.random.default_rng(seed)
    centre, towards = random.normal(size=(2, 3)) * 10
    lamp = centre + 3 * towards / np.linalg.norm(towards)
    eye, ball = Camera(tuple(centre), (0, 0, 1), 120), Sphere(tuple(centre), 6, WHITE)
    light = finite(Scene((eye, Light(tuple(lamp), 0.7), ball)), 48, 32)
    _, directions = reference.camera_rays(eye, 48, 32)
    distance = np.linalg.norm(centre + 3 * directions - lamp, axis=-1)
    assert np.abs(light - 0.7 * distance[..., None] / 6).max() <= 1e-6


def test_a_shape_beyond_a_light_occludes_nothing() -> None:
    floor, ceiling = Plane((0, 0, 0), (0, 1, 0), WHITE), Plane((0, 5, 0), (0, 1, 0), BLUE)
    below, lamp = Camera((0, 2, 0), (0, -1, 0), 60), Light((0, 4.999999, 0), 1.0)
    open_sky, covered = (Scene((AMBIENT, below, lamp, floor, *more)) for more in ((), (ceiling,)))
    assert np.array_equal(finite(open_sky), finite(covered))
    assert np.array_equal(finite(covered), finite(Scene((AMBIENT, below, lamp, ceiling, floor))))
