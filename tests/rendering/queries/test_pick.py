"""Picking: a click hits the shape that the picture shows."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.pick import pick
from minirt.rendering.renderer import Renderer
from minirt.scene import Ambient, Camera, Scene
from minirt.shapes import Plane, Shape, Sphere
from tests.kernel.pictures import ALL, picture
from tests.kernel.test_frame import ABOVE, SAME
from tests.random_scenes import random_scene

WIDTH, HEIGHT = 36, 24


def owners(scene: Scene) -> tuple[list[Shape], np.ndarray]:
    """The shapes of a scene, each in a unique unshaded colour, and the index of the shape that each pixel shows."""
    shapes = [shape.replace(colour=(index // 16 + 1, index % 16, 255)) for index, shape in enumerate(scene.shapes)]
    flat = Scene((Ambient(1.0, (255, 255, 255)), scene.camera, *shapes))
    pixels, _ = picture(flat, WIDTH, HEIGHT)
    red, green = pixels[..., 2].astype(int), pixels[..., 1].astype(int)
    return list(flat.shapes), np.where(red > 0, (red - 1) * 16 + green, -1)


def assert_picks(scene: Scene, allowed: int = 0) -> None:
    shapes, seen = owners(scene)
    flat, shape_arrays = Scene((scene.camera, *shapes)), ShapeArrays()
    wrong = 0
    for (y, x), index in np.ndenumerate(seen):
        shown = shapes[index] if index >= 0 else None
        wrong += pick(flat, WIDTH, HEIGHT, x, y, shape_arrays)[0] is not shown
    assert wrong <= allowed


def test_a_click_hits_the_shape_that_is_seen() -> None:
    assert_picks(ALL)


@pytest.mark.parametrize("seed", range(6))
def test_clicks_hit_the_shapes_of_random_scenes(seed: int) -> None:
    assert_picks(random_scene(seed), allowed=1)


@pytest.mark.parametrize("name", SAME)
def test_a_click_hits_the_visible_one_of_coincident_surfaces(name: str) -> None:
    assert_picks(Scene((ABOVE, *SAME[name])))
    assert_picks(Scene((ABOVE, *reversed(SAME[name]))))


def test_the_point_on_a_shape() -> None:
    camera = Camera((0, 0, 0), (0, 0, 1), 90)
    ball = Sphere((0, 0, 5), 2, (1, 2, 3))
    assert pick(Scene((camera, ball)), 101, 101, 50, 50)[1] == pytest.approx((0, 0, 4))
    assert pick(Scene((camera, ball)), 101, 101, 0, 0) == (None, None)
    _, (x, y, z) = pick(Scene((camera, Plane((0, -1, 0), (0, 1, 0), (1, 2, 3)))), 100, 100, 75, 99)
    assert (x / z, y, y / z) == pytest.approx((-0.51, -1, -0.99))  # looking along +z, x points to the left


def test_a_click_does_not_wait_for_a_long_picture() -> None:
    scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), Sphere((0, 0, 5), 1, (1, 2, 3))))
    renderer = Renderer()
    renderer.busy.acquire()
    cancelled = threading.Event()
    renderer.cancel = lambda: (cancelled.set(), renderer.busy.release())  # type: ignore[method-assign]
    assert renderer.pick(scene, 11, 11, 5, 5)[0] is scene.shapes[0]
    assert cancelled.is_set()
    assert not renderer.busy.locked()


def test_a_click_does_not_wait_for_the_compiler() -> None:
    scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), Sphere((0, 0, 5), 1, (1, 2, 3))))
    renderer = Renderer()
    renderer.busy.acquire()
    assert renderer.pick(scene, 11, 11, 5, 5)[0] is scene.shapes[0]
    assert renderer.busy.locked()


def test_a_click_on_the_background_hits_nothing() -> None:
    assert pick(Scene((Camera((0, 0, 0), (0, 0, 1), 60),)), 10, 10, 5, 5) == (None, None)
    ball, wall = Sphere((0, 0, 5), 1, (1, 2, 3)), Plane((0, 0, -3), (0, 0, 1), (1, 2, 3))
    scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), wall, ball))
    assert pick(scene, 11, 11, 5, 5)[0] is scene.shapes[1]
    assert pick(scene, 11, 11, 0, 0) == (None, None)
