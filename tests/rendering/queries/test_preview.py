"""Previews: the interpreted picture equals the compiled one, in a resolution that fits the time."""

from __future__ import annotations

from random import Random
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.kernel import trace
from minirt.kernel.scene_arrays import intersect
from minirt.lanes import Vec
from minirt.rendering.packing.features import features
from minirt.rendering.queries.preview import (
    BUDGET,
    FEWEST,
    RAY,
    SHAPE,
    preview,
    render_interpreted,
)
from minirt.rendering.renderer import Renderer
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes.sphere import Sphere
from tests.kernel import pictures
from tests.paths import scene_files
from tests.seeds import seed_of

MIRRORS = ("material-mirror",)
PLAIN = Renderer(2, depth=0)
SOME = Random(seed_of("previews")).sample(scene_files(), 12)  # others each run


@pytest.mark.parametrize("number", range(len(SOME)))
def test_every_interpreted_picture_equals_the_compiled_one(number: int) -> None:
    path = SOME[number]
    scene = minirt.load(path, lenient=True)
    if "reflective" in features(scene) and path.stem not in MIRRORS:
        return  # a preview has no reflections; compiling for one such scene is enough
    pixels, light = pictures.picture(scene, 64, 36, renderer=PLAIN)
    made, seen = render_interpreted(scene, 64, 36)
    np.testing.assert_allclose(seen, light, rtol=0, atol=1e-12, err_msg=path.stem)
    assert (made == pixels).all(), path


def balls(count: int) -> Scene:
    row = (Sphere((x, 0, 0), 0.9, (255, 0, 0)) for x in range(count))
    return Scene((Ambient(0.2, (255, 255, 255)), Camera((0, 0, -9), (0, 0, 1), 70), Light((0, 9, 0), 1), *row))


def test_a_preview_has_the_proportions_of_the_window_and_is_not_larger() -> None:
    small = preview(balls(1), 30, 20)
    assert small is not None
    assert small.shape == (20, 30, 4)
    large = preview(balls(20), 1600, 900)
    assert large is not None
    height, width, _ = large.shape
    assert height < 450
    assert width / height == pytest.approx(16 / 9, rel=0.05)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The number of rays in each call of the formula of a shape."""
    counts: list[int] = []

    def counted(shape: Any, origin: Vec, direction: Vec) -> Any:
        counts.append(np.size(direction.x))
        return intersect(shape, origin, direction)

    monkeypatch.setattr(trace, "intersect", counted)
    return counts


@pytest.mark.parametrize("count", [1, 30, 150])
def test_a_preview_uses_its_budget(count: int, calls: list[int]) -> None:
    """The work is counted in rays and in calls for a shape; the budget is in seconds that they are assumed to take."""
    made = preview(balls(count), 1920, 1080)
    assert made is not None
    height, width, _ = made.shape
    assert FEWEST <= width * height <= 1920 * 1080
    assert 0 < len(calls) <= 2 * count <= 300  # for the eye and for the light
    assert max(calls) <= width * height
    assert sum(calls) < 600_000
    work = 2 * count * (SHAPE + RAY * width * height)
    assert 0.7 * BUDGET < work <= 1.01 * BUDGET


def test_a_scene_that_exceeds_the_budget_has_no_preview(calls: list[int]) -> None:
    assert preview(balls(10_000), 1920, 1080) is None
    assert not calls
