"""Walkthrough: each step of a session in a real window shows the picture of the same keys without a window."""

from __future__ import annotations

import difflib
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.cli import main
from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.mlx.recording import add_recording
from minirt.scene import Scene, dump, load, parse
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.replay import play
from minirt.viewer.app.session import Session
from minirt.viewer.editing.state import State
from tests.viewer.app.test_real_window import SIZE, Viewer, still, viewing
from tests.viewer.fake import WITH_CYLINDER
from tests.viewer.xdotool import do
from tests.waiting import until

pytestmark = pytest.mark.window

STEPS = (
    "click 160,130",  # the sphere
    "drag 160,130 200,110",
    "press e",
    "wheel up 3",
    "press X",
    "drag 200,100 170,130",
    "press V",
    "press -",
    "click 230,130",
    "down Shift; drag 235,130 250,160; up Shift",
    "press Right",
    "press V",
    "press +",
    "drag 20,30 80,60 right",
    "drag 20,30 30,20 middle",
    "drag 20,20 30,25",
    "press N; press Return",
    "press N; press N; press Shift+N; press Return",
    "press d",
    "press M; press M; press Return",
    "press +",
    "press M; press Shift+M; press Return",
    "press Ctrl+D",
    "press a",
    "press L",
    "press q",
    "press F",
    "press Shift+Tab",
    "press Delete",
    "press C",
    "press .",
    "press Ctrl+Z",
    "press Ctrl+Y",
)


HIDE = ("press i", "press i")  # marks and handles

MESSAGE_ROWS = 60  # at most, at the bottom of the picture


class Twin:
    """A viewer on the screen, with a frozen clock, and a session in memory that gets the same input."""

    def __init__(self, viewer: Viewer, folder: Path) -> None:
        self.viewer = viewer
        folder.mkdir()
        self.path = folder / "twin.rt"
        self.path.write_text(WITH_CYLINDER)
        self.renderer = minirt.renderer(None)
        self.lines: list[str] = []
        self.memory = Memory()
        mlx = Mlx(self.memory)
        self.session = Session(
            mlx, mlx.mlx_init(), self.start, path=self.path, size=SIZE, renderer=self.renderer, keys="qwerty",
        )  # fmt: skip
        EventDispatcher(self.session)

    @property
    def start(self) -> Scene:
        """The scene of the file, before any edit."""
        return parse(WITH_CYLINDER, self.path).scene

    @property
    def state(self) -> State:
        return self.session.state

    def do(self, *lines: str) -> None:
        """Perform lines of a recording in both."""
        do(self.viewer.desktop, self.viewer.window, *lines)
        add_recording(lines, "twin", self.memory)
        self.memory.play()
        self.lines += lines

    def replayed(self) -> State:
        """Return the state after all lines are replayed at once, as by `miniRT --replay`, without marks."""
        return play(self.start, [*HIDE, *self.lines], renderer=self.renderer, size=SIZE, path=self.path).state

    def check_agreement(self) -> None:
        """Wait until the window shows the picture of the session in memory, except where a message is; then save.

        Compared with the previous version of the file, at most one line may have changed.
        """
        state = self.state
        shown = slice(0, -MESSAGE_ROWS if state.message else None)
        picture, viewer = still(state.scene)[shown], self.viewer

        def same() -> bool:
            return np.array_equal(viewer.desktop.screenshot(viewer.window)[shown], picture)

        until(same, self.lines[-1])
        before, after = viewer.path.read_text(), dump(state.scene)
        do(viewer.desktop, viewer.window, "press Ctrl+S")
        until(lambda: viewer.path.read_text() == after, f"the file after {self.lines[-1]}")
        changed = [line for line in difflib.ndiff(before.split("\n"), after.split("\n")) if line[0] in "+-"]
        assert len(changed) <= 2 or self.lines[-1] in ("press Ctrl+Z", "press Ctrl+Shift+Z"), changed


def test_a_walk(desktop, tmp_path):
    with viewing(desktop, tmp_path / "scene.rt", program="tests.viewer.app.test_walk") as viewer:
        twin = Twin(viewer, tmp_path / "twin")
        viewer.key("i", "i")
        viewer.shows(still(load(viewer.path).scene))
        for step in STEPS:
            twin.do(*step.split("; "))
            if step not in ("press V", "press X"):
                twin.check_agreement()
        edited = twin.state.scene
        assert twin.replayed() == twin.state

        twin.do("press Tab", *["press Ctrl+Z"] * 40)
        assert twin.state.scene.items == parse(WITH_CYLINDER).scene.items
        twin.check_agreement()
        twin.do(*["press Ctrl+Shift+Z"] * 40)
        assert twin.state.scene.items == edited.items
        twin.check_agreement()

        viewer.path.write_text(WITH_CYLINDER)
        viewer.key("F5", "Tab")
        viewer.shows(still(parse(WITH_CYLINDER).scene))
        viewer.key("ctrl+z", "ctrl+s")
        until(lambda: viewer.path.read_text() == dump(edited), "the scene from before it was read again")

        shot = viewer.path.with_name("scene-1.png")
        viewer.key("p")
        until(lambda: shot.exists() and shot.stat().st_size > 0, "the picture's file")
        assert np.array_equal(np.asarray(Image.open(shot)), still(edited))
        viewer.key("Tab")
        viewer.shows(still(edited))
        viewer.key("h")
        until(lambda: desktop.screenshot(viewer.window).mean() < still(edited).mean() / 2, "the help")
        viewer.key("h")
        viewer.shows(still(edited))
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")


if __name__ == "__main__":  # the viewer with a clock that stands still: changes of one kind are undone together
    Session.now = property(lambda _: 0.0)  # type: ignore[method-assign,assignment]
    sys.exit(main())
