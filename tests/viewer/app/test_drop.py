"""Drag and drop: a file that is dropped on a real window is opened."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import minirt
from tests.viewer.app.test_real_window import picture, viewing
from tests.viewer.scenes import WITH_CYLINDER
from tests.waiting import until

pytestmark = pytest.mark.window


@pytest.mark.parametrize("types", [1, 3, 5])
def test_a_dropped_file_is_opened(desktop, tmp_path, types):
    other = tmp_path / "an other.rt"
    other.write_text(WITH_CYLINDER.replace("sp 0,0,0 2", "sp 0,0,0 3"))
    with viewing(desktop, tmp_path / "scene.rt") as viewer:
        viewer.key("i", "i")
        viewer.shows(picture(viewer.path))
        desktop.run(
            sys.executable, "-m", "tests.mlx.drag_source", str(viewer.window), "20", "20", str(types), str(other)
        )
        until(
            lambda: desktop.run("xdotool", "getwindowname", str(viewer.window)) == b"miniRT - an other.rt\n",
            "the title of the other file",
        )
        viewer.key("Tab")  # clears the message
        viewer.shows(picture(other))
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
    assert not np.array_equal(picture(other), minirt.render(minirt.load(viewer.path), 320, 240).array)
