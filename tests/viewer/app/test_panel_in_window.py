"""The panel in a real window. A window in memory, whose panel has the same layout, tells where the widgets are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from minirt.scene import load
from tests.paths import ROOT
from tests.viewer.app.test_real_window import Viewer, viewing
from tests.viewer.fake import SPHERE_ON_PLANE
from tests.viewer.idle_waits import until_at_rest
from tests.viewer.test_panel import User
from tests.viewer.xdotool import do
from tests.waiting import until
from tests.windows import Desktop

pytestmark = pytest.mark.window

SIZE = (640, 480)
EDGE = (SIZE[0] - 10, SIZE[1] // 2)  # the tab that opens the panel
SPHERE = 3  # its index


def has_slimgui(viewer: Viewer) -> bool:
    """Whether the program has loaded Dear ImGui."""
    return "slimgui" in Path(f"/proc/{viewer.process.pid}/maps").read_text()


def until_the_panel(viewer: Viewer, is_open: bool) -> None:
    """Wait until the panel covers the right of the picture, or does not: it is dark from top to bottom."""

    def is_dark() -> bool:
        border = viewer.desktop.screenshot(viewer.window)[2:-2, -2]
        return bool((border < 60).all())

    until(lambda: is_dark() == is_open, f"the {'open' if is_open else 'closed'} panel")


def seen(viewer: Viewer, line: str) -> None:
    """Do what a line says, and wait until the window shows it: a window manager may lose what follows a click."""
    before = viewer.desktop.screenshot(viewer.window)
    do(viewer.desktop, viewer.window, line)
    until(lambda: not np.array_equal(viewer.desktop.screenshot(viewer.window), before), line)


def test_numbers_are_dragged_and_typed_undone_and_saved_and_the_panel_is_remembered(desktop: Desktop, tmp_path: Path):
    path, state = tmp_path / "scene.rt", f"XDG_STATE_HOME={tmp_path / 'state'}"
    opened = {"size": SIZE, "environment": (state,), "options": ("--no-watch",)}
    with viewing(desktop, path, text=SPHERE_ON_PLANE, **opened) as viewer:
        until_at_rest(viewer.process.pid)
        assert not has_slimgui(viewer)
        viewer.key("F1")
        until_the_panel(viewer, True)
        assert has_slimgui(viewer)

        user = User(load(path).scene, SIZE)
        user.click(f"element {SPHERE}")
        number = user.place("diameter")
        seen(viewer, "move {},{}".format(*user.place(f"element {SPHERE}")))
        seen(viewer, "click {},{}".format(*user.place(f"element {SPHERE}")))
        seen(viewer, "move {},{}".format(*number))
        desktop.run("xdotool", "mousedown", "1")
        seen(viewer, f"move {number[0] + 60},{number[1]}")
        desktop.run("xdotool", "mouseup", "1")
        viewer.key("ctrl+s")
        until(lambda: path.read_text() != SPHERE_ON_PLANE, "the saved drag")
        assert load(path).scene.spheres[0].diameter > 2
        viewer.key("ctrl+z", "ctrl+s")
        until(lambda: path.read_text() == SPHERE_ON_PLANE, "the undone drag")
        seen(viewer, f"click {number[0]},{number[1]}")
        desktop.run("xdotool", "type", "--delay", "0", "2*3+1")
        viewer.key("Return", "ctrl+s")
        until(lambda: path.read_text() == SPHERE_ON_PLANE.replace("sp 0,0,0 2 ", "sp 0,2.5,0 7 "), "the typed line")

        until_at_rest(viewer.process.pid, 100)
        viewer.key("Escape", "Escape")  # out of the panel, out of the program
        assert viewer.end() == (0, "", "")
    with viewing(desktop, path, text=None, **opened) as viewer:
        until_the_panel(viewer, True)  # at once, and the keys are those of the picture
        viewer.key("F1")
        until_the_panel(viewer, False)
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
    with viewing(desktop, path, text=None, **opened) as viewer:
        until_at_rest(viewer.process.pid)
        assert not has_slimgui(viewer)
        seen(viewer, "move {},{}".format(*EDGE))
        do(desktop, viewer.window, "click {},{}".format(*EDGE))
        until_the_panel(viewer, True)
        viewer.key("Escape", "Escape")
        assert viewer.end() == (0, "", "")


def test_without_slimgui_the_program_works(desktop: Desktop, tmp_path: Path):
    (tmp_path / "slimgui.py").write_text("raise ImportError")
    environment = f"XDG_STATE_HOME={tmp_path / 'state'}", f"PYTHONPATH={tmp_path}:{ROOT}"
    with viewing(desktop, tmp_path / "scene.rt", SIZE, environment=environment) as viewer:
        until_at_rest(viewer.process.pid)
        without = desktop.screenshot(viewer.window)
        viewer.key("F1")
        until(lambda: not np.array_equal(desktop.screenshot(viewer.window), without), "the name of the extra")
        until_the_panel(viewer, False)
        viewer.key("Tab", "Tab", "plus", "ctrl+s")
        until(lambda: load(viewer.path).scene.spheres[0].diameter > 2, "the saved scene")
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
