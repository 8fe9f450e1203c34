"""The pictures of the yardstick and of the peers are those of miniRT, so that their times measure the same work."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.rendering.renderer import PRECISIONS
from tests.bench import scenes
from tests.bench.measure import MissingError, Setting, System
from tests.bench.peers.embree import Embree
from tests.bench.peers.mitsuba import Mitsuba
from tests.bench.peers.programs import PovRay, Tachyon
from tests.bench.yardstick import Yardstick
from tests.compare import Bytes, edges
from tests.paths import ROOT

WIDTH, HEIGHT = 320, 176
COMPILED = ROOT / "out" / "yardstick"  # programs that stay for the next run until their sources change
LINES = """\
A 0.5 255,255,255
C 0,1,-10 0,0,1 90
L -4,6,-5 0.6 255,0,0
l 5,5,-8 0.3 255,255,255
pl 0,-2,0 0,1,0 102,204,255
sp 1,2,3 4 255,51,0
cy -3,0,0 0.6,0.8,0 2 5 0,255,0
"""
HEAD = "A 0.2 255,255,255\nC 0,3,-20 0,-0.1,1 60\npl 0,-2,0 0,1,0 200,200,200\n"
RING = "".join(f"sp {x},0,{z} 2 200,{100 + 10 * x},50\n" for x in (-6, -3, 0, 3, 6) for z in (-6, 6))
COLUMNS = "cy 8,0,0 0.5,1,0.2 2 4 60,90,220\ncy -8,0,0 -0.3,1,0 2 4 60,220,90\n"
BESIDE_THE_EYE = "cy 1,1,-18 0,0.05,1 1 30 220,90,60\n"
LAMPS = ["0,0.5,0", "-30,40,-20", "2,0,-4"]  # beside and among the shapes


def made(kind: Callable[[Setting], Any], folder: Path) -> Any:
    """Return a system; the test is skipped where it is not installed."""
    try:
        return kind(Setting(WIDTH, HEIGHT, 2, folder))
    except MissingError as reason:
        pytest.skip(str(reason))


def shows_the_same(picture: Bytes, ours: Bytes, tolerance: int) -> bool:
    """Whether a peer's picture differs from ours at edges alone."""
    wrong = (np.abs(picture.astype(int) - ours).max(axis=-1) > tolerance) & ~edges(ours)
    return bool(wrong.mean() < 1e-3) and bool(ours.std() > 20)


# Prisms in place of cylinders have flat sides, and Tachyon's rays go through the corners of pixels.
@pytest.mark.parametrize(
    ("kind", "tolerances"), [(PovRay, (1, 1)), (Tachyon, (6, 12)), (Embree, (12, 1)), (Mitsuba, (12, 1))]
)
def test_peers_show_the_same_scene_and_mesh(kind: type[System], tolerances: tuple[int, int], tmp_path: Path) -> None:
    (tmp_path / "scene.rt").write_text(LINES)
    for path, tolerance in zip((tmp_path / "scene.rt", scenes.waves(tmp_path, 1000)), tolerances, strict=True):
        system = made(kind, tmp_path)
        assert min(system.frame_times(path, 0)) > 0
        picture = np.asarray(Image.open(system.picture(path)).convert("RGB"))
        assert shows_the_same(picture, minirt.render(minirt.load(path), WIDTH, HEIGHT).array, tolerance)


@pytest.mark.parametrize(
    ("kind", "name"),
    [(PovRay, "mirrors"), (PovRay, "glass"), (PovRay, "lights"), (Embree, "lights"), (Mitsuba, "lights")],
)
def test_peers_show_mirrors_glass_and_many_lights(kind: type[System], name: str, tmp_path: Path) -> None:
    assert shows_the_same(*pictures(kind, name, tmp_path), 3)


def pictures(kind: type[System], name: str, folder: Path) -> tuple[Bytes, Bytes]:
    """Return the picture of a system, and miniRT's, of a scene without a mesh."""
    system = made(kind, folder)
    path = next(each for each in scenes.harder(folder, meshes={}) if each.stem == name)
    assert system.renders(path)
    system.frame_times(path, 0)
    ours = minirt.render(minirt.load(path), WIDTH, HEIGHT).array
    return np.asarray(Image.open(system.picture(path)).convert("RGB")), ours


@pytest.mark.parametrize("name", ["mirrors", "lights"])
def test_tachyon_shows_as_much_light(name: str, tmp_path: Path) -> None:
    """Its rays through the corners of pixels show other pixels where there is so much to see."""
    picture, ours = pictures(Tachyon, name, tmp_path)
    assert np.abs(picture.mean(axis=(0, 1)) - ours.mean(axis=(0, 1))).max() < 1


@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_yardstick_shows_the_compared_scenes_with_any_lamp(precision: str, tmp_path: Path) -> None:
    yardstick = made(partial(Yardstick, precision=precision), COMPILED)
    *paths, mesh = scenes.compared(tmp_path, {"mesh": 1000})
    paths.append(scenes.grown(tmp_path, 1000))
    for number, lamp in enumerate(LAMPS):
        paths.append(tmp_path / f"lamp-{number}.rt")
        paths[-1].write_text(f"{HEAD}L {lamp} 0.7 255,255,255\n{RING}{COLUMNS}{BESIDE_THE_EYE}")
    for path in paths:
        yardstick.run(path, "--seconds", "0", "--ppm", str(tmp_path / "picture.ppm"))
        picture = np.asarray(Image.open(tmp_path / "picture.ppm"))
        ours = minirt.render(minirt.load(path), WIDTH, HEIGHT).array
        assert shows_the_same(picture, ours, 2), path  # where light falls at a grazing angle, float32 shows
    assert not yardstick.renders(mesh)
