"""The yardstick renders the same pictures as miniRT, so its time measures the same work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from tests.bench import meshes, scenes
from tests.bench.system import MissingError, Setting
from tests.bench.yardstick import Yardstick
from tests.compare import edges, off

WIDTH, HEIGHT = 320, 176
HEAD = "A 0.2 255,255,255\nC 0,3,-20 0,-0.1,1 60\npl 0,-2,0 0,1,0 200,200,200\n"
RING = "".join(f"sp {x},0,{z} 2 200,{100 + 10 * x},50\n" for x in (-6, -3, 0, 3, 6) for z in (-6, 6))
COLUMNS = "cy 8,0,0 0.5,1,0.2 2 4 60,90,220\ncy -8,0,0 -0.3,1,0 2 4 60,220,90\n"
BESIDE_THE_EYE = "cy 1,1,-18 0,0.05,1 1 30 220,90,60\n"


@pytest.fixture(scope="module")
def yardstick(tmp_path_factory: pytest.TempPathFactory) -> Yardstick:
    try:
        return Yardstick(Setting(WIDTH, HEIGHT, 2, tmp_path_factory.mktemp("yardstick")))
    except MissingError as reason:
        pytest.skip(str(reason))


def assert_same_picture(yardstick: Yardstick, path: Path, folder: Path) -> None:
    yardstick.run(path, "--seconds", "0", "--ppm", str(folder / "picture.ppm"))
    picture = np.asarray(Image.open(folder / "picture.ppm"))
    ours = minirt.render(minirt.load(path), WIDTH, HEIGHT).array
    wrong = off(picture, ours)
    assert wrong.mean() < 0.01
    assert (wrong & ~edges(ours)).mean() < 1e-3  # where light falls at a grazing angle, float32 shows
    assert ours.std() > 20


@pytest.mark.parametrize("index", [0, 1, 2])
def test_the_pictures_of_the_compared_scenes(yardstick: Yardstick, tmp_path: Path, index: int) -> None:
    assert_same_picture(yardstick, scenes.compared(tmp_path)[index], tmp_path)


def test_the_picture_of_a_scene_that_grew(yardstick: Yardstick, tmp_path: Path) -> None:
    assert_same_picture(yardstick, scenes.grown(tmp_path, 1000), tmp_path)


@pytest.mark.parametrize("lamp", ["0,0.5,0", "-30,40,-20", "2,0,-4"])
def test_lamps_beside_and_among_the_shapes(yardstick: Yardstick, tmp_path: Path, lamp: str) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(f"{HEAD}L {lamp} 0.7 255,255,255\n{RING}{COLUMNS}{BESIDE_THE_EYE}")
    assert_same_picture(yardstick, path, tmp_path)


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("sp 0,3,-20 2 255,0,0", "the eye is inside"),
        ("sp 0,9,0 2 255,0,0", "a lamp is inside"),
        ("cy 0,9,0 0,1,0 2 2 255,0,0", "a lamp is inside"),
        ("co 0,0,0 0,1,0 2 2 255,0,0", "5: unknown element"),
        ("sp 0,0,0 2 255,0,0 mirror:0.5", "5: no number"),
        ("sp 0,0,0 2 255,0", "5: too few"),
        ("sp 0,0,0 2 255,0,0,1", "5: too many"),
    ],
)
def test_what_it_cannot_render_it_refuses(yardstick: Yardstick, tmp_path: Path, line: str, complaint: str) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(f"{HEAD}L 0,9,0 0.7 255,255,255\n{line}\n")
    with pytest.raises(RuntimeError, match=complaint):
        yardstick.run(path)


def test_it_renders_no_meshes(yardstick: Yardstick, tmp_path: Path) -> None:
    assert all(yardstick.renders(path) for path in scenes.compared(tmp_path))
    assert not yardstick.renders(meshes.waves(tmp_path, 100))
    with pytest.raises(RuntimeError, match="no number"):
        yardstick.run(meshes.waves(tmp_path, 100))


def test_what_it_prints(yardstick: Yardstick) -> None:
    printed = yardstick.run(scenes.HERE / "one.rt", "--seconds", "0")
    assert 0 < printed["ms_min"] <= printed["ms_median"]
    assert printed["threads"] == 2
