"""The scenes of the benchmark are as documented."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from tests.bench import scenes


@pytest.mark.parametrize("count", [10, 1000])
def test_all_of_so_many_spheres_are_in_view_and_as_large_as_the_picture(tmp_path: Path, count: int) -> None:
    scene = load(scenes.grown(tmp_path, count))
    assert len(scene.spheres) == count
    eye, right, up, forward = camera_numbers(scene.camera, 16, 9).reshape(4, 3)
    places = np.array([each.centre for each in scene.spheres]) - eye
    depth = places @ forward
    assert (depth > scenes.NEAREST - 1e-3).all()
    assert (depth < scenes.FARTHEST + 1e-3).all()
    for edge in (right, up):
        assert (np.abs(places @ edge) / (edge @ edge) < depth * (1 + 1e-4)).all()
    discs = np.array([each.diameter for each in scene.spheres]) ** 2 * pi / 4 / depth**2
    assert discs.sum() == pytest.approx(4 * scenes.WIDE * scenes.HIGH, rel=3 / count**0.5)


def test_scenes_are_the_same_at_each_run() -> None:
    assert list(scenes.growth(20)) == list(scenes.growth(20))
    assert list(scenes.growth(20))[1:] != list(scenes.growth(21))[1:-1]
    # Python promises this sequence of random numbers for all versions.
    assert next(line for line in scenes.tenthousand() if line.startswith("sp")) == FIRST


def test_there_are_ten_thousand(tmp_path: Path) -> None:
    one, fifty, tenthousand = (load(path) for path in scenes.compared(tmp_path))
    assert len(one.shapes) == 3
    assert len(fifty.spheres) + len(fifty.cylinders) == 49
    assert len(tenthousand.spheres) == 10_000
    assert all(1 <= each.diameter <= 2 for each in tenthousand.spheres)


def test_a_scene_that_is_there_is_not_written_again(tmp_path: Path) -> None:
    path = scenes.grown(tmp_path, 10)
    path.write_text("kept")
    assert scenes.grown(tmp_path, 10).read_text() == "kept"


FIRST = "sp 63.943,1.5006,-22.497 1.2232 204,192,234\n"
