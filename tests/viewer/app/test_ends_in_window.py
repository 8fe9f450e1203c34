"""The program keeps unsaved changes however it ends, and responds while its kernel is compiled: in real windows."""

from __future__ import annotations

import os
import random
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

import minirt
from minirt.viewer.recovery import name_of
from tests.cli.ends import trial
from tests.seeds import seed_of
from tests.viewer.app.test_real_window import SIZE, Viewer, picture, viewing
from tests.viewer.fake import SPHERE_ON_PLANE, WITH_CYLINDER
from tests.viewer.idle_waits import compilers, group
from tests.waiting import until
from tests.windows import Desktop

pytestmark = pytest.mark.window

LOST = "Error\nthe connection to the X server is lost\n"


def kept(desktop: Desktop, path: Path) -> list[Path]:
    """Return the files with unsaved changes of a scene file."""
    return list((Path(desktop.environment["XDG_STATE_HOME"]) / "minirt" / "unsaved").glob(f"{name_of(path)}-*"))


def check_recovered(desktop: Desktop, path: Path, output: str) -> None:
    """Check that the changed scene is beside the file, as the program has said, and kept nowhere else."""
    copy = path.with_name("scene.recovered.rt")
    assert str(copy) in output
    assert minirt.load(copy).spheres == ()
    assert kept(desktop, path) == []


@contextmanager
def with_unsaved_changes(desktop: Desktop, path: Path) -> Iterator[Viewer]:
    """Run the program; when the block begins it has deleted the sphere, and that is on disk."""
    with viewing(desktop, path) as viewer:
        viewer.key("Tab", "Tab", "Delete")
        until(lambda: any(each.suffix == ".rt" for each in kept(desktop, path)), "unsaved changes on disk")
        yield viewer


@pytest.mark.parametrize("number", [None, signal.SIGHUP])
def test_escape_and_signals_end_the_program_and_keep_changes(desktop, tmp_path, number):
    path = tmp_path / "scene.rt"
    with with_unsaved_changes(desktop, path) as viewer:
        if number:
            os.kill(viewer.process.pid, number)
        else:
            viewer.key("Escape")
        status, output, errors = viewer.end()
    assert (status, errors) == (128 + number if number else 0, "")
    check_recovered(desktop, path, output)


def test_a_window_without_unsaved_changes_ends_by_a_signal_and_leaves_nothing(desktop, tmp_path):
    path = tmp_path / "scene.rt"
    with viewing(desktop, path) as viewer:
        viewer.key("i", "i")
        viewer.shows(picture(path))  # the event loop runs: from then on signals are handled
        viewer.key("d")
        os.kill(viewer.process.pid, signal.SIGTERM)
        assert viewer.end() == (143, "", "")
    assert list(tmp_path.iterdir()) == [path]
    assert kept(desktop, path) == []


def test_a_signal_at_any_moment_ends_the_window_as_documented(desktop):
    chance = random.Random(seed_of("signal to a window"))
    for _ in range(2):
        assert trial("window", chance, desktop.environment, share=0.5).faults == []


def test_a_killed_program_loses_nothing(desktop, tmp_path):
    path = tmp_path / "scene.rt"
    with with_unsaved_changes(desktop, path) as viewer:
        viewer.process.kill()
        assert viewer.end()[0] == -signal.SIGKILL
    assert path.read_text() == WITH_CYLINDER
    with viewing(desktop, path, text=None) as viewer:
        viewer.key("ctrl+r", "ctrl+s", "Escape")
        assert viewer.end() == (0, "", "")
    assert minirt.load(path).spheres == ()
    assert kept(desktop, path) == []


def test_a_lost_connection_to_the_screen_keeps_changes(desktop, tmp_path):
    path = tmp_path / "scene.rt"
    with with_unsaved_changes(desktop, path) as viewer:
        desktop.run("xdotool", "windowkill", str(viewer.window))
        status, output, errors = viewer.end()
    assert (status, errors) == (1, LOST)
    check_recovered(desktop, path, output)


# The first run stays responsive while another process compiles the kernel.


class FirstRun(NamedTuple):
    """The program without a kernel; its compiling processes are stopped by a signal and never end by themselves."""

    viewer: Viewer
    compilers: list[int]  # process ids

    def resume_compilers(self) -> None:
        """Let the compiling processes continue."""
        for each in self.compilers:
            os.kill(each, signal.SIGCONT)


@pytest.fixture
def first_run(desktop: Desktop, tmp_path: Path) -> Iterator[FirstRun]:
    """Yield the first run of the program once it shows words; afterwards check that no process is left."""
    with viewing(desktop, tmp_path / "first.rt", cache=tmp_path / "cache", text=SPHERE_ON_PLANE) as viewer:
        program = viewer.process.pid
        until(lambda: len(compilers(program)) == 2, "the compilers of what packs the scene and of what draws it")
        stopped = compilers(program)
        for each in stopped:
            os.kill(each, signal.SIGSTOP)
        until(lambda: desktop.screenshot(viewer.window).any(), "words in the black window")
        yield FirstRun(viewer, stopped)
        until(lambda: not group(program), "the end of all processes of the program")


def test_escape_does_not_wait_for_the_compiler(first_run):
    first_run.viewer.key("Escape")
    assert first_run.viewer.end() == (0, "", "")


def test_ctrl_c_in_the_terminal_also_ends_the_compiler_silently(first_run):
    first_run.resume_compilers()
    os.killpg(first_run.viewer.process.pid, signal.SIGINT)
    assert first_run.viewer.end() == (130, "", "")


def test_keys_work_on_a_preview_until_the_picture_comes(first_run):
    viewer = first_run.viewer
    viewer.key("i", "i")
    between = slice(80, SIZE[1] - 60)  # rows without text
    whole = picture(viewer.path)

    def difference() -> float:
        return abs(viewer.desktop.screenshot(viewer.window)[between].astype(int) - whole[between]).mean()

    until(lambda: 0 < difference() < 12, "the preview")

    viewer.key("Tab", "Tab", "Tab", "Delete", "ctrl+s")
    until(lambda: viewer.path.read_text() != SPHERE_ON_PLANE, "the saved scene")
    assert minirt.load(viewer.path).planes == ()
    first_run.resume_compilers()  # and then compile again: a sphere alone has another kernel
    viewer.key("Tab")  # clears the message
    sphere = picture(viewer.path)
    viewer.shows(sphere)
    viewer.key("ctrl+z")
    viewer.shows(whole)
    viewer.key("ctrl+y")
    viewer.shows(sphere)
    viewer.key("Escape")
    assert viewer.end() == (0, "", "")
