"""Brute force tries every shape for every ray and gives the same picture, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.brute_force import BruteForce
from minirt.report.measurements.settings import brute_force
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, SHAPES, linear
from tests.random_scenes import random_scene

WIDTH, HEIGHT = 70, 40  # 5 x 3 tiles


@pytest.mark.parametrize("seed", range(6))
def test_the_picture_is_the_same(seed: int) -> None:
    scene = random_scene(seed) if seed else ALL
    brute = linear(scene, WIDTH, HEIGHT, 3, brute_force(2))
    assert np.array_equal(brute, linear(scene, WIDTH, HEIGHT, 3))


def test_scenes_without_lights() -> None:
    scene = Scene((AMBIENT, EYE, *SHAPES))
    assert np.array_equal(linear(scene, WIDTH, HEIGHT, 1, brute_force(1)), linear(scene, WIDTH, HEIGHT))


def test_every_tile_and_every_light_has_every_shape() -> None:
    traced = BruteForce().pack(ALL, WIDTH, HEIGHT)
    for kind, group in enumerate(traced.groups):
        expected = np.flatnonzero(traced.slots[:, 0] == kind).tolist()
        assert len(group.tile_starts) == 15 + 1
        for a, b in zip(group.tile_starts, group.tile_starts[1:], strict=False):
            assert sorted(traced.tile_shapes[a:b]) == expected
        assert len(group.light_starts) == 2
        for a, b in group.light_starts:
            assert sorted(traced.light_shapes[a:b]) == expected
    assert traced.light_buffer_cells == 1
    assert (traced.cones == [0, 0, 0, -2, 0]).all()  # no cone and no distance keeps a shape from being tried
    assert (traced.light_cones == [0, 0, 0, -2, 0]).all()
    assert len(Packing().pack(ALL, WIDTH, HEIGHT).tile_shapes) < len(traced.tile_shapes)


def test_lists_that_would_fill_the_memory_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.report.measurements.brute_force.MOST", 15 * len(ALL.shapes))
    BruteForce().pack(ALL, WIDTH, HEIGHT)
    with pytest.raises(RenderError, match="6 shapes in each of 18 tiles are too many"):
        BruteForce().pack(ALL, WIDTH + 16, HEIGHT)
