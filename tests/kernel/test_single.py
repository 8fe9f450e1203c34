"""Single precision: float32 gives the same picture but for rounding, wherever in the world the scene is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.rendering import Renderer
from minirt.scene import Camera, Scene
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, EYE, WHITE, interpreted, linear
from tests.kernel.test_invariances import changed, interior, scaled
from tests.random_scenes import random_scene

ONE, TWO = Renderer(1, "single"), Renderer(2, "single")


def single(scene: Scene, renderer: Renderer = TWO) -> Any:
    """Render a scene in single precision."""
    return linear(scene, 60, 40, renderer=renderer)


def test_single_precision_differs_from_double_by_rounding_away_from_edges() -> None:
    difference = np.abs(single(ALL) - linear(ALL, 60, 40)).max(axis=-1)
    assert 0 < difference[interior(ALL, 60, 40)].max() < 2e-5
    assert np.quantile(difference, 0.99) < 2e-5


@pytest.mark.parametrize("seed", range(20))
def test_random_scenes_differ_from_double_precision_at_edges_only(seed: int) -> None:
    scene = random_scene(seed)
    difference = np.abs(single(scene) - linear(scene, 60, 40)).max(axis=-1)
    assert np.quantile(difference, 0.98) < 1 / 255


@pytest.mark.parametrize("shift", [(1e8, 0, 0), (-1e6, 1e7, 1e6), (1e4, -1e4, 1e3)])
def test_coordinates_are_relative_to_the_eye(shift: tuple[float, float, float]) -> None:
    moved = changed(ALL, lambda p: tuple(x + y for x, y in zip(p, shift, strict=True)))
    difference = np.abs(single(moved) - single(ALL)).max(axis=-1)
    assert np.quantile(difference, 0.99) < 1e-4


def test_rounding_before_the_eye_is_subtracted_is_noticed() -> None:
    def far(p: Any) -> Any:
        return tuple(float(np.float32(x + 1e6)) for x in p)

    difference = np.abs(single(changed(ALL, far)) - single(ALL)).max(axis=-1)
    assert difference.max() > 0.1


def test_any_number_of_threads_gives_the_same_bits() -> None:
    assert np.array_equal(single(ALL, ONE), single(ALL, TWO))


@pytest.mark.parametrize("power", [-20, -1, 1, 20])
def test_a_scene_scaled_by_a_power_of_two_gives_the_same_bits(power: int) -> None:
    assert np.array_equal(single(scaled(ALL, 2.0**power)), single(ALL))


def test_interpreted_and_compiled_pictures_differ_by_rounding() -> None:
    difference = np.abs(interpreted(ALL, precision="single")[1] - linear(ALL, 24, 16, renderer=TWO)).max(axis=-1)
    assert np.quantile(difference, 0.98) < 2e-5


def test_light_buffers_find_all_of_many_shapes() -> None:
    random = np.random.default_rng(5)
    balls = [Sphere(tuple(random.uniform(-3, 3, 3)), 0.5, WHITE) for _ in range(300)]
    scene = Scene((*ALL.elements[:2], *ALL.lights, *balls))
    assert isinstance(scene.elements[1], Camera)
    difference = np.abs(single(scene) - linear(scene, 60, 40)).max(axis=-1)
    assert np.quantile(difference, 0.97) < 1e-4
    assert EYE in scene.elements
