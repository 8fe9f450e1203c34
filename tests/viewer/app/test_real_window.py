"""End-to-end tests: the whole program in a real window."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

import minirt
from minirt.scene import Scene, parse
from minirt.scene.parser import NEW
from tests.processes import until_stopped
from tests.viewer.fake import WITH_CYLINDER
from tests.viewer.idle_waits import until_at_rest
from tests.waiting import HANG_LIMIT, until
from tests.windows import SCREEN, Desktop

pytestmark = pytest.mark.window

SIZE = (320, 240)


class Viewer(NamedTuple):
    """The running program and its window."""

    desktop: Desktop
    process: subprocess.Popen[str]
    window: int
    path: Path

    def key(self, *names: str) -> None:
        self.desktop.key(self.window, *names)

    def shows(self, picture: NDArray[np.uint8]) -> None:
        """Wait until the window shows exactly this picture."""
        until(lambda: np.array_equal(self.desktop.screenshot(self.window), picture), "the picture")

    def end(self) -> tuple[int, str, str]:
        """Wait for the end of the program; return exit status, standard output and standard error."""
        output, errors = self.process.communicate(timeout=HANG_LIMIT)
        return self.process.returncode, output, errors


@contextmanager
def viewing(
    desktop: Desktop,
    path: Path,
    size: tuple[int, int] = SIZE,
    cache: Path | None = None,
    options: tuple[str, ...] = (),
    program: str = "minirt",
    text: str | None = WITH_CYLINDER,
    environment: tuple[str, ...] = (),
    title: str = "",
) -> Iterator[Viewer]:
    """Run the program in a window with the scene `text`; None: with the file as it is. `title` follows its name.

    `cache`: an empty folder, if the program is to compile its kernel, for a processor for which no kernel was compiled
    ahead of time; `options`: further arguments; `program`: the module to run; `environment`: variables, such as A=b.
    """
    command = [sys.executable, "-W", "error", "-m", program, str(path), "--size", f"{size[0]}x{size[1]}", *options]
    if cache:
        environment += f"XDG_CACHE_HOME={cache}", "NUMBA_CPU_NAME=generic"
    command = ["env", *environment, *command]
    if text is not None:
        path.write_text(text)
    with desktop.program(*command) as process:
        yield Viewer(desktop, process, desktop.find(f"miniRT - {path.name}{title}"), path)


@pytest.fixture
def viewer(desktop: Desktop, tmp_path: Path) -> Iterator[Viewer]:
    with viewing(desktop, tmp_path / "scene.rt") as opened:
        yield opened


def still(scene: Scene, size: tuple[int, int] = SIZE, passes: tuple[int, ...] = (4, 16)) -> NDArray[np.uint8]:
    """Render a scene, refined as in a window in which nothing moves."""
    renderer = minirt.renderer(None)
    pixels = np.zeros((size[1], size[0], 4), np.uint8)
    renderer.render(scene, pixels)
    for samples in passes:
        renderer.render(scene, pixels, samples, edges_only=True)
    return pixels[..., 2::-1]


def picture(path: Path, size: tuple[int, int] = SIZE, passes: tuple[int, ...] = (4, 16)) -> NDArray[np.uint8]:
    """Render the scene in a file as `still` does."""
    return still(minirt.load(path), size, passes)


def check_name_and_icon(viewer: Viewer) -> None:
    """Check the name and the icons by which the desktop knows the application."""

    def properties() -> bytes:
        return viewer.desktop.run("xprop", "-id", str(viewer.window), "-notype", "WM_CLASS", "32c", "_NET_WM_ICON")

    until(lambda: b"_NET_WM_ICON = 16, 16, " in properties(), "the icon")
    name, _, words = properties().partition(b"_NET_WM_ICON = ")
    assert name.strip() == b'WM_CLASS = "minirt", "miniRT"'
    icon = np.array(words.split(b", "), np.uint32)
    sizes = []
    while len(icon):
        width, height = icon[:2].tolist()
        drawn, icon = icon[2 : 2 + width * height].reshape(height, width), icon[2 + width * height :]
        assert (drawn[0, 0] >> 24, drawn[height // 2, width // 2] >> 24) == (0, 255)  # transparent beside the ball
        sizes.append((width, height))
    assert sizes == [(16, 16), (32, 32), (64, 64)]


def test_the_refined_picture_is_shown_at_rest_hidden_covered_moved_resized_and_clicked(viewer, desktop, tmp_path):
    viewer.key("i", "i")
    still = picture(viewer.path)
    viewer.shows(still)
    check_name_and_icon(viewer)

    desktop.minimise(viewer.window)
    desktop.restore(viewer.window)
    viewer.shows(still)
    with viewing(desktop, tmp_path / "other.rt", (900, 700)) as cover:
        for window in (viewer.window, cover.window):
            desktop.run("xdotool", "windowmove", "--sync", str(window), "100", "100")
        desktop.activate(cover.window)
        desktop.close_button(cover.window)
        assert cover.end() == (0, "", "")
    viewer.shows(still)

    desktop.activate(viewer.window)
    desktop.keydown("d")
    seen = set()

    def moving() -> bool:
        seen.add(desktop.screenshot(viewer.window).tobytes())
        return len(seen) > 5

    until(moving, "five pictures while a key is held")
    desktop.keyup("d")
    viewer.key("Home")
    viewer.shows(still)

    place = desktop.run("xdotool", "getwindowgeometry", str(viewer.window))
    for size in (SCREEN, SIZE, SCREEN, SIZE):
        viewer.key("F11")
        assert desktop.find("miniRT - scene.rt", size) == viewer.window
        viewer.shows(picture(viewer.path, size))
    until(lambda: desktop.run("xdotool", "getwindowgeometry", str(viewer.window)) == place, "its place")

    for n in range(30):
        desktop.run("xdotool", "windowsize", str(viewer.window), str(200 + 13 * n), str(400 - 7 * n))
    desktop.resize(viewer.window, 333, 222)
    viewer.shows(picture(viewer.path, (333, 222)))
    desktop.resize(viewer.window, *SIZE)
    viewer.shows(still)

    viewer.key("ctrl+c")
    until(lambda: not np.array_equal(desktop.screenshot(viewer.window), still), "the message")
    desktop.click(viewer.window, 160, 130)  # the sphere
    viewer.shows(still)
    viewer.key("Delete", "ctrl+s", "Escape")
    assert viewer.end() == (0, "", "")
    assert minirt.load(viewer.path).spheres == ()


def test_with_one_sample_the_picture_is_the_library_s_and_a_window_that_watches_no_file_does_nothing(desktop, tmp_path):
    with viewing(desktop, tmp_path / "scene.rt", options=("--samples", "1", "--no-watch")) as viewer:
        viewer.key("i", "i")
        plain = minirt.render(minirt.load(viewer.path), *SIZE).array
        assert np.array_equal(plain, picture(viewer.path, passes=()))
        viewer.shows(plain)
        until_at_rest(viewer.process.pid, 100)
        assert np.array_equal(desktop.screenshot(viewer.window), plain)
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")


def shows_tone(viewer: Viewer, tone: str) -> None:
    """Wait until the window shows the scene of the file with this tone, and dithered."""
    scene = minirt.load(viewer.path)
    toned = scene.replace(scene.camera, tone=tone, exposure=1)
    expected = minirt.render(toned, *SIZE, dither=True).array
    assert not np.array_equal(expected, minirt.render(toned, *SIZE).array)
    viewer.shows(expected)


def test_the_window_shows_the_tone_and_the_dithering_of_the_file_and_a_key_changes_the_tone(desktop, tmp_path):
    options = ("--samples", "1", "--tone", "filmic", "--exposure", "1", "--dither")
    with viewing(desktop, tmp_path / "scene.rt", options=options) as viewer:
        viewer.key("i", "i")
        shows_tone(viewer, "filmic")
        viewer.path.write_text(viewer.path.read_text() + "bg 90,120,200\n")  # as another program does
        shows_tone(viewer, "filmic")
        for tone in ("plain", "srgb"):
            viewer.key("t", "i", "i", "i")  # which hides what the window says about the tone
            shows_tone(viewer, tone)
        viewer.key("Escape")
        status, out, err = viewer.end()
        assert (status, err) == (0, "")
        assert "scene.recovered.rt" in out  # a tone is a value to be saved


def test_keys_of_a_stopped_program_count_when_it_goes_on_and_ctrl_c_ends_it(viewer):
    path = viewer.path
    viewer.key("i", "i")
    viewer.shows(picture(path))
    os.killpg(viewer.process.pid, signal.SIGSTOP)
    assert until_stopped(viewer.process)
    viewer.key("Tab", "Tab", "e", "ctrl+s")
    before = path.read_text()
    os.killpg(viewer.process.pid, signal.SIGCONT)
    until(lambda: path.read_text() != before, "the saved scene")
    assert minirt.load(path).spheres[0].centre[1] > 0
    viewer.key("Tab")  # clears the message
    viewer.shows(picture(path))
    os.killpg(viewer.process.pid, signal.SIGINT)
    assert viewer.end() == (130, "", "")
    assert list(path.parent.iterdir()) == [path]


def test_a_file_that_is_not_there_opens_as_a_new_scene_and_is_written_by_a_key(desktop, tmp_path):
    path = tmp_path / "opning.rt"
    (tmp_path / "opening.rt").write_text(WITH_CYLINDER)
    with viewing(desktop, path, text=None, title=" (new)") as viewer:
        viewer.key("i", "i", "Tab")
        viewer.shows(still(parse(NEW, path).scene))
        sky, ground = desktop.screenshot(viewer.window)[[0, -1], 160]
        assert sky[2] > sky[0] > 0
        assert ground[1] > ground[2] > 0
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
    assert not path.exists()
    with viewing(desktop, path, text=None, title=" (new)") as viewer:
        viewer.key("ctrl+s")
        assert desktop.find("miniRT - opning.rt") == viewer.window
        assert path.read_bytes() == NEW
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
    assert len(list(tmp_path.iterdir())) == 2
