"""First run of the program in a real window: it stays responsive while another process compiles the kernel."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

import minirt
from tests.viewer.app.test_real_window import SIZE, Viewer, picture, viewing
from tests.viewer.idle_waits import compilers, group
from tests.viewer.scenes import SPHERE_ON_PLANE
from tests.waiting import until
from tests.windows import Desktop

pytestmark = pytest.mark.window


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
    until(lambda: bool(viewer.desktop.screenshot(viewer.window)[between].any()), "the preview")
    preview = viewer.desktop.screenshot(viewer.window)[between]
    whole = picture(viewer.path)
    assert (preview != whole[between]).any()
    assert abs(preview.astype(int) - whole[between]).mean() < 12

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
