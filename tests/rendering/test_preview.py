"""A preview is the compiled picture, at a lower resolution."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.rendering import Renderer
from minirt.rendering.preview import picture, preview
from minirt.rendering.traits import traits
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes.sphere import Sphere
from tests.kernel import pictures

MIRRORS = ("material-mirror",)
PLAIN = Renderer(2, depth=0)
SCENES = sorted((Path(__file__).parents[2] / "scenes").glob("*.rt"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_is_as_compiled(path: Path) -> None:
    scene = minirt.load(path, lenient=True)
    if "bounces" in traits(scene) and path.stem not in MIRRORS:
        return  # a preview has none, and one such scene is enough to wait for the compiler
    pixels, light = pictures.picture(scene, 64, 36, renderer=PLAIN)
    made, seen = picture(scene, 64, 36)
    np.testing.assert_allclose(seen, light, rtol=0, atol=1e-12)
    assert (made == pixels).all()


def test_without_shapes_it_is_black() -> None:
    made = preview(Scene((Camera((0, 0, 0), (0, 0, 1), 70),)), 64, 48)
    assert made is not None
    assert (made == (0, 0, 0, 255)).all()


def balls(count: int) -> Scene:
    row = (Sphere((x, 0, 0), 0.9, (255, 0, 0)) for x in range(count))
    return Scene((Ambient(0.2, (255, 255, 255)), Camera((0, 0, -9), (0, 0, 1), 70), Light((0, 9, 0), 1), *row))


def test_it_has_the_proportions_of_the_window_and_is_no_larger() -> None:
    small = preview(balls(1), 30, 20)
    assert small is not None
    assert small.shape == (20, 30, 4)
    large = preview(balls(20), 1600, 900)
    assert large is not None
    height, width, _ = large.shape
    assert height < 450
    assert width / height == pytest.approx(16 / 9, rel=0.05)


def test_it_takes_little_time_or_is_left_out() -> None:
    for count in (1, 30, 150):
        start = time.thread_time()
        assert preview(balls(count), 1920, 1080) is not None
        assert time.thread_time() - start < 0.5
    assert preview(balls(10_000), 1920, 1080) is None
