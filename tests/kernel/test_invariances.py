"""Invariances of pictures: scaling, moving, mirroring or rotating a scene has a known effect on its picture."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.element import Element, fields_of
from minirt.fields import Direction, Length, Lengths, Point
from minirt.scene import FurtherLight, Scene
from minirt.shapes.box import Box
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.square import Square
from tests import reference
from tests.kernel.pictures import ALL, AMBIENT, EVERY, EYE, LAMP, SHAPES, linear

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
