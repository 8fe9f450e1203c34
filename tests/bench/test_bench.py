"""The benchmark measures in turn, starts whole programs, and draws what it measured."""

from __future__ import annotations

import os
from math import pi
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from tests.bench import charts, scenes
from tests.bench.measure import MissingError, Setting, System, table, take_turns
from tests.bench.starts import HEIGHT, WIDTH, Start, WindowStart, right_picture, shows, virtual_screen

ONE = scenes.HERE / "one.rt"


class Counting(System):
    """A fake system: its n-th frame takes n milliseconds times the letters of its name."""

    how = "invented"

    def __init__(self, name: str, calls: list[str]) -> None:
        super().__init__(Setting(16, 16, 2, Path()))
        self.name, self.calls, self.took = name, calls, 0

    def renders(self, path: Path) -> bool:
        return (self.name, path.stem) != ("bb", "mesh")

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        self.calls.append(f"{self.name} {path.stem}")
        self.took += 1
        return [100.0, float(self.took * len(self.name)), 0.0]


def test_systems_take_turns_on_what_they_render() -> None:
    calls: list[str] = []
    cells = take_turns([Counting("a", calls), Counting("bb", calls)], [Path("x.rt"), Path("mesh.rt")], 3, 0.0)
    assert calls == ["a x", "bb x", "a mesh"] * 3
    assert cells == {("a", "x"): [1, 3, 5], ("bb", "x"): [2, 4, 6], ("a", "mesh"): [2, 4, 6]}


def test_the_table_has_medians_of_three_digits_and_ratios_of_two() -> None:
    figures = {("us", "one"): [9, 2, 1], ("us", "two"): [9.996], ("us", "mesh"): [1.0]}
    figures |= {("them", "one"): [1], ("them", "two"): [912.3]}
    assert table(figures).splitlines() == [
        "ms a frame         one         two        mesh",
        "us          2.00  x1.0  10.0  x1.0  1.00  x1.0",
        "them        1.00 x0.50   912   x91           -",
    ]


def test_the_scenes_are_as_documented(tmp_path: Path) -> None:
    one, fifty, tenthousand, mesh = (load(path) for path in scenes.compared(tmp_path))
    assert len(one.shapes) == 3
    assert len(fifty.spheres) + len(fifty.cylinders) == 49
    assert len(tenthousand.spheres) == 10_000
    # Python promises this sequence of random numbers for all versions.
    assert (
        next(line for line in scenes.tenthousand() if line[:2] == "sp")
        == "sp 63.943,1.5006,-22.497 1.2232 204,192,234\n"
    )
    assert mesh.meshes[0].parts == pytest.approx(100_000, rel=0.01)
    made = mesh.meshes[0].triangles
    a, b, c = made.points[made.corners].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(4 / 3 * pi, rel=0.02)  # closed: the volume


def test_so_many_spheres_are_in_view_and_as_large_as_the_picture(tmp_path: Path) -> None:
    scene = load(scenes.grown(tmp_path, 1000))
    eye, right, up, forward = camera_numbers(scene.camera, 16, 9).reshape(4, 3)
    places = np.array([each.centre for each in scene.spheres]) - eye
    depth = places @ forward
    for edge in (right, up):
        assert (np.abs(places @ edge) / (edge @ edge) < depth * (1 + 1e-4)).all()
    discs = np.array([each.diameter for each in scene.spheres]) ** 2 * pi / 4 / depth**2
    assert (len(discs), discs.sum()) == (1000, pytest.approx(4 * scenes.WIDE * scenes.HIGH, rel=0.1))


def test_a_start_writes_the_right_picture_and_keeps_its_cache_unless_it_is_cold(tmp_path: Path) -> None:
    for cold in (False, True):
        start = Start(Setting(WIDTH, HEIGHT, 2, tmp_path / str(cold)), cold)
        (tmp_path / str(cold)).mkdir()
        assert start.frame_times(ONE, 0)[0] > 0
        assert shows(np.asarray(Image.open(start.picture(ONE)).convert("RGB")), right_picture(ONE))
        assert (tmp_path / str(cold) / "cache").exists() != cold
        with pytest.raises(RuntimeError, match="no-such-scene"):
            start.start(Path("no-such-scene.rt"), dict(os.environ))


def test_a_picture_that_is_not_yet_right_is_found() -> None:
    right = right_picture(ONE)
    worded = right.copy()
    worded[:40] = 255
    assert shows(worded, right)  # whatever its words cover
    half = np.where(np.arange(HEIGHT)[:, None, None] < HEIGHT // 2, right, 0).astype(np.uint8)
    for wrong in (right[::2, ::2].repeat(2, axis=0).repeat(2, axis=1), half, np.zeros_like(right)):
        assert not shows(wrong, right)


@pytest.mark.window
def test_a_window_starts_until_it_shows_the_right_picture(tmp_path: Path) -> None:
    try:
        with virtual_screen(WIDTH, HEIGHT) as screen:
            start = WindowStart(Setting(WIDTH, HEIGHT, 2, tmp_path), False, screen)
            assert start.frame_times(ONE, 0)[0] > 0
            assert not shows(screen.pixels, right_picture(ONE))  # the next start finds an empty screen
            with pytest.raises(RuntimeError, match="no right picture"):
                start.start(ONE, {**os.environ, "PYTHONPATH": "", "PYTHONHOME": str(tmp_path)})
    except MissingError as reason:
        pytest.skip(str(reason))


def test_charts_show_the_measured_times(tmp_path: Path) -> None:
    """On a logarithmic axis a factor is a distance: 3, 30 and 300 ms lie equally far apart."""
    cells = {("miniRT double", scene): [ms] for scene, ms in {"one": 3.0, "fifty": 30.0, "tenthousand": 300.0}.items()}
    charts.dots(cells, tmp_path / "dots.png", "ms")
    picture = np.asarray(Image.open(tmp_path / "dots.png").convert("RGB"))[100:-80]  # below the legend
    colours = [list(bytes.fromhex(colour[1:])) for colour in charts.COLOURS[:3]]
    near, middle, far = (np.nonzero((picture == colour).all(axis=-1))[1].mean() for colour in colours)
    assert far - middle == pytest.approx(middle - near, rel=0.02)
    assert middle - near > 100
    charts.growth({("miniRT double", str(n)): [n**0.4] for n in (10, 100, 1000)}, tmp_path / "growth.png")
    assert np.asarray(Image.open(tmp_path / "growth.png")).std() > 0
