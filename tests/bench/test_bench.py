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
from tests.bench import charts, scenes, starts
from tests.bench.measure import Cells, MissingError, Setting, System, records, table, take_turns
from tests.bench.starts import HEIGHT, WIDTH, FileStart, WindowStart, right_picture, shows, virtual_screen

ONE = scenes.HERE / "one.rt"
COLOUR = charts.COLOURS["miniRT double"]


class Counting(System):
    """A fake system: its n-th frame takes n milliseconds times the letters of its name."""

    how = "invented"

    def __init__(self, setting: Setting, name: str, calls: list[str]) -> None:
        super().__init__(setting)
        self.name, self.calls, self.took = name, calls, 0

    def renders(self, path: Path) -> bool:
        return (self.name, path.stem) != ("bb", "mesh")

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        self.calls.append(f"{self.name} {path.stem}")
        self.took += 1
        return [100.0, float(self.took * len(self.name)), 0.0]


def counted(names: str, paths: str, rounds: int) -> tuple[Cells, list[str]]:
    """Let fake systems take turns; return the cells and the calls."""
    calls: list[str] = []
    systems: list[System] = [Counting(Setting(16, 16, 2, Path()), each, calls) for each in names.split()]
    return take_turns(systems, [Path(f"{each}.rt") for each in paths.split()], rounds, 0.0), calls


def test_systems_take_turns_on_what_they_render() -> None:
    cells, calls = counted("a bb", "x y", 3)
    assert calls == ["a x", "bb x", "a y", "bb y"] * 3
    assert cells["bb", "x"] == [2, 6, 10]
    cells, _ = counted("a bb", "one mesh", 1)
    assert table(cells, ["a", "bb"], ["one", "mesh"]).splitlines() == [
        "ms a frame         one        mesh",
        "a           1.00  x1.0  2.00  x1.0",
        "bb          2.00  x2.0           -",
    ]


def test_the_table_has_medians_of_three_digits_and_ratios_of_two() -> None:
    figures = {("us", "one"): [9, 2, 1], ("us", "two"): [9.996], ("them", "one"): [1], ("them", "two"): [912.3]}
    assert table(figures, ["us", "them"], ["one", "two"]).splitlines() == [
        "ms a frame         one         two",
        "us          2.00  x1.0  10.0  x1.0",
        "them        1.00 x0.50   912   x91",
    ]
    assert records(figures)[0] == {"system": "us", "scene": "one", "ms": 2, "rounds": [9, 2, 1]}


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


def test_a_cold_start_finds_an_empty_cache_and_a_warm_one_that_of_another_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs only leave a file in their cache."""
    log: list[tuple[str, int]] = []

    def run(command: list[str], environment: dict[str, str]) -> None:
        folder = Path(environment["XDG_CACHE_HOME"])
        folder.mkdir(exist_ok=True)
        log.append((Path(command[-1]).name, len(list(folder.iterdir()))))
        (folder / str(len(log))).touch()

    monkeypatch.setattr(starts, "run_checked", run)
    for cold in (True, False):
        start = FileStart(Setting(WIDTH, HEIGHT, 2, tmp_path), cold)
        for _ in range(2):
            assert start.frame_times(ONE, 0)[0] > 0
    warm = "one-miniRT -o, warm.png"
    assert log == [("one-miniRT -o, cold.png", 0)] * 2 + [("--bench", 0), (warm, 1), (warm, 2)]


def test_a_start_writes_the_right_picture(tmp_path: Path) -> None:
    start = FileStart(Setting(WIDTH, HEIGHT, 2, tmp_path), cold=False)
    assert start.start(ONE, dict(os.environ)) > 0
    assert shows(np.asarray(Image.open(start.picture(ONE)).convert("RGB")), right_picture(ONE))
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


def pixels_of(path: Path, colour: str) -> np.ndarray:
    """Return the columns of the pixels of a colour, below the legend."""
    picture = np.asarray(Image.open(path).convert("RGB"))[100:-80]
    return np.nonzero((picture == list(bytes.fromhex(colour[1:]))).all(axis=-1))[1]


def test_charts_show_the_measured_times(tmp_path: Path) -> None:
    """On a logarithmic axis a factor is a distance: 3, 30 and 300 ms lie equally far apart."""
    times = {"one": 3.0, "fifty": 30.0, "tenthousand": 300.0}
    cells = {("miniRT double", scene): [ms] for scene, ms in times.items()}
    charts.dots(cells, tmp_path / "dots.png", "ms")
    near, middle, far = (pixels_of(tmp_path / "dots.png", colour).mean() for colour in charts.SCENES[:3])
    assert far - middle == pytest.approx(middle - near, rel=0.02)
    assert middle - near > 100
    assert charts.offsets([1.0, 1.1, 1.2, 9.0]) == [7, -15, 17, -15]  # labels of near values do not overlap
    grown = {("miniRT double", str(n)): [n**0.4] for n in (10, 100, 1000)}
    charts.growth(grown, tmp_path / "growth.png")
    assert len(pixels_of(tmp_path / "growth.png", COLOUR)) > 1000
    assert len(pixels_of(tmp_path / "growth.png", charts.OTHERS)) == 0
