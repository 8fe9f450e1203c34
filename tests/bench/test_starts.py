"""Starts end with a right picture, and cold ones find an empty cache."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.bench import start as module
from tests.bench import starts
from tests.bench.measure import Cell, Round
from tests.bench.peers.command import Command
from tests.bench.scenes import HERE
from tests.bench.start import HEIGHT, WIDTH, FileStart, PeerStart
from tests.bench.system import MissingError, Setting
from tests.bench.virtual_screen import Pixels, pixels_of, virtual_screen
from tests.bench.window_start import WindowStart, right_picture, shows

ONE = HERE / "one.rt"


@pytest.fixture
def setting(tmp_path: Path) -> Setting:
    return Setting(WIDTH, HEIGHT, 2, tmp_path)


@pytest.fixture
def caches(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """Let programs only leave a file in their cache; log their last argument and the files that they find there."""
    log: list[tuple[str, int]] = []

    def run(command: list[str], environment: dict[str, str]) -> None:
        folder = Path(environment["XDG_CACHE_HOME"])
        folder.mkdir(exist_ok=True)
        log.append((Path(command[-1]).name, len(list(folder.iterdir()))))
        (folder / str(len(log))).touch()

    monkeypatch.setattr(module, "run_checked", run)
    return log


def test_a_cold_start_finds_an_empty_cache(setting: Setting, caches: list[tuple[str, int]]) -> None:
    start = FileStart(setting, cold=True)
    assert start.name == "miniRT -o, cold"
    for _ in range(2):
        (took,) = start.frame_times(ONE, 0)
        assert took > 0
    assert caches == [("one-miniRT -o, cold.png", 0)] * 2


def test_a_warm_start_finds_the_cache_of_another_run(setting: Setting, caches: list[tuple[str, int]]) -> None:
    start = FileStart(setting, cold=False)
    for _ in range(2):
        start.frame_times(ONE, 0)
    picture = "one-miniRT -o, warm.png"
    assert caches == [("--bench", 0), (picture, 1), (picture, 2)]


def test_a_start_writes_the_right_picture(setting: Setting) -> None:
    start = FileStart(setting, cold=False)
    assert start.start(ONE, dict(os.environ)) > 0
    assert shows(np.asarray(Image.open(start.picture(ONE)).convert("RGB")), right_picture(ONE))


def coarse(picture: Pixels, block: int) -> Pixels:
    """Return a picture of blocks, as windows show it while they wait."""
    return picture[::block, ::block].repeat(block, axis=0).repeat(block, axis=1)


def half_finished(picture: Pixels) -> Pixels:
    return np.where(np.arange(HEIGHT)[:, None, None] < HEIGHT // 2, picture, 0).astype(np.uint8)


def with_words(picture: Pixels) -> Pixels:
    worded = picture.copy()
    worded[:40] = 255
    return worded


def test_a_window_is_right_whatever_its_words_cover() -> None:
    right = right_picture(ONE)
    assert shows(right, right)
    assert shows(with_words(right), right)


@pytest.mark.parametrize(
    "wrong", [lambda right: coarse(right, 2), lambda right: coarse(right, 10), half_finished, np.zeros_like]
)
def test_a_picture_that_is_not_yet_right_is_found(wrong) -> None:
    right = right_picture(ONE)
    assert wrong(right).shape == right.shape
    assert not shows(wrong(right), right)


@pytest.mark.window
@pytest.mark.parametrize("cold", [False, True])
def test_a_window_starts_until_it_shows_the_right_picture(setting: Setting, cold: bool) -> None:
    try:
        with virtual_screen(WIDTH, HEIGHT) as screen:
            start = WindowStart(setting, cold, screen)
            assert start.frame_times(ONE, 0)[0] > 0
            assert not shows(screen.pixels, right_picture(ONE))  # the next start finds an empty screen
            with pytest.raises(RuntimeError, match="no right picture"):
                start.start(ONE, {**os.environ, "PYTHONPATH": "", "PYTHONHOME": str(setting.folder)})
    except MissingError as reason:
        pytest.skip(str(reason))


def test_the_start_of_a_peer_is_the_whole_program(setting: Setting, monkeypatch: pytest.MonkeyPatch) -> None:
    class Fake(Command):
        name, command, suffix = "fake", "true", ".txt"
        translate = staticmethod(lambda scene, width, height: iter([f"{len(scene.shapes)} shapes"]))

        def arguments(self, file: Path, picture: Path) -> list[str]:
            return [file.read_text().strip()]

        def milliseconds(self, printed: str) -> float:
            raise AssertionError("its own time is not asked")

    commands: list[list[str]] = []
    monkeypatch.setattr(module, "run_checked", lambda command, environment: commands.append(command))
    (took,) = PeerStart(Fake, setting).frame_times(ONE, 0)
    assert took > 0
    assert commands == [["true", "3 shapes"]]


def test_a_program_that_fails_is_no_start(setting: Setting) -> None:
    with pytest.raises(RuntimeError, match="no-such-scene"):
        FileStart(setting, cold=False).start(Path("no-such-scene.rt"), dict(os.environ))


def test_the_pixels_of_a_screen(tmp_path: Path) -> None:
    """The file has a header of 25 words, a name, colours of 12 bytes, and rows that may be longer than the picture."""
    header = np.zeros(25, ">u4")
    header[[0, 4, 5, 11, 12, 19]] = 104, 2, 3, 32, 12, 1  # bytes, width, height, bits per pixel, bytes per row, colours
    rows = np.arange(36, dtype=np.uint8)
    dump = tmp_path / "screen"
    dump.write_bytes(header.tobytes() + b"\0" * (4 + 12) + rows.tobytes())
    pixels = pixels_of(dump)
    assert pixels.tolist() == [[[12 * y + 4 * x + k for k in (2, 1, 0)] for x in range(2)] for y in range(3)]
    with dump.open("r+b") as file:  # it follows what is drawn
        file.seek(116)
        file.write(b"\xff")
    assert pixels[0, 0].tolist() == [2, 1, 255]


def test_the_table() -> None:
    cells = {(system, "one"): Cell(0, [Round(ms, 0)]) for system, ms in [("miniRT -o, warm", 400), ("Tachyon", 20)]}
    assert starts.report(cells, 5).splitlines()[2:] == [
        "",
        "ms to a picture          one",
        "miniRT -o, warm   400   x1.0",
        "Tachyon          20.0  x0.05",
    ]
