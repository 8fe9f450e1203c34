"""Scenes translated for the peers, and the pictures that the peers make of them."""

from __future__ import annotations

from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from tests.bench import meshes
from tests.bench.peers import mitsuba, povray, tachyon
from tests.bench.peers.command import Command
from tests.bench.peers.embree import Embree
from tests.bench.peers.mitsuba import Mitsuba
from tests.bench.peers.povray import PovRay
from tests.bench.peers.tachyon import Tachyon
from tests.bench.peers.triangles import SIDES, cylinder, plane
from tests.bench.system import MissingError, Setting, System
from tests.compare import Bytes, edges

WIDTH, HEIGHT = 320, 180
LINES = """\
A 0.5 255,255,255
C 0,1,-10 0,0,1 90
L -4,6,-5 0.6 255,0,0
l 5,5,-8 0.3 255,255,255
pl 0,-2,0 0,1,0 102,204,255
sp 1,2,3 4 255,51,0
cy -3,0,0 0.6,0.8,0 2 5 0,255,0
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "scene.rt"
    path.write_text(LINES)
    return path


@pytest.fixture
def scene(path: Path) -> Scene:
    return minirt.load(path)


def test_the_language_of_povray(scene: Scene) -> None:
    assert list(povray.translated(scene, WIDTH, HEIGHT)) == [
        "#version 3.7;",
        "global_settings { assumed_gamma 1 ambient_light rgb <0.5, 0.5, 0.5> }",
        "#default { finish { ambient 1 diffuse 1 } }",
        "camera { location <0, 1, -10> direction <0, 0, 1> right <-2, 0, 0> up <0, 1.125, 0> }",
        "light_source { <-4, 6, -5>, rgb <0.6, 0, 0> }",
        "light_source { <5, 5, -8>, rgb <0.3, 0.3, 0.3> }",
        "plane { <0, 1, 0>, -2 pigment { rgb <102, 204, 255> / 255 } }",
        "sphere { <1, 2, 3>, 2 pigment { rgb <255, 51, 0> / 255 } }",
        "cylinder { <-4.5, -2, 0>, <-1.5, 2, 0>, 1 pigment { rgb <0, 255, 0> / 255 } }",
    ]


def test_the_language_of_tachyon(scene: Scene) -> None:
    finish = "TEXTURE AMBIENT 0.5 DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR {} TEXFUNC 0"
    green = finish.format("0 1 0")
    assert list(tachyon.translated(scene, WIDTH, HEIGHT)) == [
        "BEGIN_SCENE",
        "RESOLUTION 320 180",
        "CAMERA PROJECTION PERSPECTIVE ZOOM 0.888888889 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 1 "
        "CENTER 0 1 -10 VIEWDIR 0 0 1 UPDIR 0 1 0 END_CAMERA",
        "LIGHT CENTER 4 6 -5 RAD 0.001 COLOR 0.6 0 0",
        "LIGHT CENTER -5 5 -8 RAD 0.001 COLOR 0.3 0.3 0.3",
        f"PLANE CENTER 0 -2 0 NORMAL 0 1 0 {finish.format('0.4 0.8 1')}",
        f"SPHERE CENTER -1 2 3 RAD 2 {finish.format('1 0.2 0')}",
        f"FCYLINDER BASE 4.5 -2 0 APEX 1.5 2 0 RAD 1 {green}",
        f"RING CENTER 4.5 -2 0 NORMAL -0.6 0.8 0 INNER 0 OUTER 1 {green}",
        f"RING CENTER 1.5 2 0 NORMAL -0.6 0.8 0 INNER 0 OUTER 1 {green}",
        "END_SCENE",
    ]


def test_a_cylinder_in_triangles() -> None:
    shape = Cylinder(centre=(1, 2, 3), axis=(0.6, 0, 0.8), diameter=4, height=6, colour=(0, 0, 0))
    corners = cylinder(shape)
    assert corners.shape == (4 * SIDES, 3, 3)
    axis = np.array(shape.axis)
    places = corners - shape.centre
    height = places @ axis
    assert np.abs(height) == pytest.approx(np.full_like(height, 3))
    radius = np.linalg.norm(places - height[..., None] * axis, axis=-1)
    assert set(np.unique(radius.round(9))) == {0, 2}
    # They close it: by the theorem of Gauss the volume, which is that of the prism.
    volume = np.abs(np.linalg.det(places)).sum() / 6
    assert volume == pytest.approx(6 * SIDES / 2 * 4 * np.sin(2 * np.pi / SIDES))


def test_a_plane_in_triangles() -> None:
    corners = plane(Plane(point=(1, 2, 3), normal=(1 / 3, 2 / 3, 2 / 3), colour=(0, 0, 0)))
    assert (corners - [1, 2, 3]) @ [1 / 3, 2 / 3, 2 / 3] == pytest.approx(np.zeros((2, 3)), abs=1e-9)
    sides = corners[:, 1:] - corners[:, :1]
    assert np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=-1).sum() / 2 == pytest.approx(4e10)


@pytest.mark.parametrize(
    ("kind", "printed", "ms"),
    [
        (PovRay, "  Trace Time:       0 hours  0 minutes  0 seconds (0.169 seconds)\n  using 2 thread(s)", 169),
        (Tachyon, "Scene Parsing Time: 1.0 seconds\n  Ray Tracing Time:     0.2383 seconds\n", 238.3),
    ],
)
def test_the_time_that_they_print(kind: type[Command], printed: str, ms: float) -> None:
    unset: Command = kind.__new__(kind)  # whether it is installed or not
    assert unset.milliseconds(printed) == pytest.approx(ms)


# Embree's prisms have flat sides, and Tachyon's rays go through the corners of pixels.
SCENE_PEERS = pytest.mark.parametrize(("kind", "tolerance"), [(PovRay, 1), (Tachyon, 6), (Embree, 12), (Mitsuba, 1)])
MESH_PEERS = pytest.mark.parametrize(("kind", "tolerance"), [(PovRay, 1), (Tachyon, 12), (Embree, 1), (Mitsuba, 1)])


def picture_of(kind: type[System], path: Path, folder: Path) -> Bytes:
    """Return a peer's picture of a scene; the test is skipped where the peer is not installed."""
    try:
        system = kind(Setting(WIDTH, HEIGHT, 2, folder))
    except MissingError as reason:
        pytest.skip(str(reason))
    assert min(system.frame_times(path, 0)) > 0
    return np.asarray(Image.open(system.picture(path)).convert("RGB"))


def shows_the_same(picture: Bytes, ours: Bytes, tolerance: int) -> bool:
    """Whether a peer's picture differs from ours at edges alone."""
    wrong = (np.abs(picture.astype(int) - ours).max(axis=-1) > tolerance) & ~edges(ours)
    return bool(wrong.mean() < 1e-3) and bool(ours.std() > 20)


@SCENE_PEERS
def test_they_show_the_same_scene(kind: type[System], tolerance: int, path: Path, tmp_path: Path) -> None:
    ours = minirt.render(minirt.load(path), WIDTH, HEIGHT).array
    assert shows_the_same(picture_of(kind, path, tmp_path), ours, tolerance)


@MESH_PEERS
def test_they_show_the_same_mesh(kind: type[System], tolerance: int, tmp_path: Path) -> None:
    path = meshes.waves(tmp_path, 1000)
    ours = minirt.render(minirt.load(path), WIDTH, HEIGHT).array
    assert shows_the_same(picture_of(kind, path, tmp_path), ours, tolerance)


@pytest.mark.parametrize(
    ("text", "wrong"), [("sp 1,2,3 4", "sp 1,2,3 3.5"), ("l 5,5,-8 0.3", "l 5,5,-8 0.2"), ("A 0.5", "A 0.4")]
)
def test_another_scene_is_found(text: str, wrong: str, scene: Scene, path: Path) -> None:
    ours = minirt.render(scene, WIDTH, HEIGHT).array
    assert shows_the_same(ours, ours, 0)
    path.write_text(LINES.replace(text, wrong))
    assert not shows_the_same(minirt.render(minirt.load(path), WIDTH, HEIGHT).array, ours, 12)


def test_an_llvm_that_mitsuba_cannot_use_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Dr.Jit ends the program where LLVM is too old, so another program tries it."""
    failed = CompletedProcess([], -6, "", "LLVM ERROR: Cannot select: fminimum\n  in a function")
    monkeypatch.setattr(mitsuba, "find_spec", lambda name: object())
    monkeypatch.setattr(mitsuba, "run", lambda command, **options: failed)
    with pytest.raises(MissingError, match=r"Mitsuba 3: .* LLVM ERROR: Cannot select: fminimum$"):
        Mitsuba(Setting(WIDTH, HEIGHT, 1, tmp_path))


def test_mitsuba_may_be_missing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(mitsuba, "find_spec", lambda name: None)
    with pytest.raises(MissingError, match="Mitsuba 3: mitsuba is not installed"):
        Mitsuba(Setting(WIDTH, HEIGHT, 1, tmp_path))
