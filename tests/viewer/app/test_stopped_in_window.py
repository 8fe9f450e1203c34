"""A program with a window that is stopped, as by Ctrl+Z in its terminal, goes on where it was when it is continued."""

from __future__ import annotations

import os
import signal

import pytest

import minirt
from tests.processes import until_stopped
from tests.viewer.app.test_real_window import picture, viewing
from tests.waiting import until

pytestmark = pytest.mark.window


def test_keys_that_are_pressed_while_the_program_is_stopped_count_when_it_goes_on(desktop, tmp_path):
    path = tmp_path / "scene.rt"
    with viewing(desktop, path) as viewer:
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
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
    assert list(tmp_path.iterdir()) == [path]
