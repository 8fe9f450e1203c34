"""`minirt.view` chooses a window or a widget, which takes keys by their names in browsers and sends frames."""

from __future__ import annotations

import io
import sys
from threading import Event
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.mlx import Mlx
from minirt.mlx.display import Display
from minirt.mlx.events import Key, Modifier
from minirt.mlx.memory import Memory
from minirt.notebook.page_back_end import (
    AHEAD,
    COARSE,
    FINE,
    QUIET,
    PageDisplay,
    code_of,
    encode,
    modifiers_of,
    text_of,
)  # fmt: skip
from tests.skipping import require


class NoScreen(Memory):
    """A back end on a machine without a screen."""

    def open(self, options: object) -> None:
        raise minirt.MlxError("no screen")


@pytest.fixture
def scene() -> minirt.Scene:
    return minirt.loads("A 1 255,255,255\nC 0,0,-10 0,0,1 40\nsp 0,0,0 2 255,0,0\n")


def test_what_cells_show_beside_pictures_is_one_line(scene: minirt.Scene) -> None:
    shown = [
        scene,
        minirt.render(scene, 64, 48),
        minirt.buffers(scene, 64, 48),
        minirt.trace(scene, [[0] * 3], [[0, 0, 1]]),
    ]
    assert all(len(repr(each)) < 100 and "\n" not in repr(each) for each in shown)


@pytest.mark.parametrize("told", [False, None])
def test_outside_of_notebooks_a_missing_screen_is_an_error(scene: minirt.Scene, told: bool | None) -> None:
    with pytest.raises(minirt.MlxError, match="no screen") as caught:
        minirt.view(scene, mlx=Mlx(NoScreen()), notebook=told)
    assert caught.value.__notes__ == ['minirt.render(scene, 640, 480).save("picture.png") needs no window']


def test_a_missing_package_is_named(scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "minirt.notebook.widget", raising=False)
    with pytest.raises(minirt.MlxError, match=r"pip install 'minirt\[notebook\]'"):
        minirt.view(scene, notebook=True)


def test_a_viewer_that_cannot_open_leaves_no_second_error(scene: minirt.Scene) -> None:
    require("anywidget")
    with pytest.raises(minirt.MiniRTError):
        minirt.view(scene, (64, 48), precision="half", notebook=True)  # type: ignore[call-overload]


def test_a_failure_of_the_session_ends_the_viewer_and_is_told(
    scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    require("anywidget")
    from minirt.notebook.widget import Viewer

    told: list[dict[str, str]] = []
    monkeypatch.setattr(Viewer, "send", lambda self, message, buffers=None: told.append(message))

    def fail() -> None:
        raise minirt.RenderError("planted")

    viewer = Viewer(scene, (64, 48))
    viewer._display.do(fail)
    viewer._thread.join()
    assert {"kind": "failure", "text": "The viewer has ended: planted"} in told
    viewer.close()


def test_a_notebook_without_a_screen_gets_the_widget(scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    require("anywidget")
    monkeypatch.setattr("minirt.notebook.in_notebook", lambda: True)
    viewer = minirt.view(scene, (64, 48), mlx=Mlx(NoScreen()))
    try:
        assert (viewer.width, viewer.height, viewer.scene) == (64, 48, scene)
        assert isinstance(viewer._display, Display)
    finally:
        viewer.close()
    assert not viewer._thread.is_alive()


def test_an_assigned_scene_is_the_scene_at_once(scene: minirt.Scene) -> None:
    require("anywidget")
    from minirt.notebook.widget import Viewer

    viewer = Viewer(scene, (64, 48))
    busy, goes_on, is_shown = Event(), Event(), Event()
    try:
        viewer._display.do(lambda: (busy.set(), goes_on.wait()))
        busy.wait()
        larger = scene.replace(scene.spheres[0], diameter=3)
        viewer.scene = larger
        assert viewer.scene is larger
        goes_on.set()
        viewer._display.do(is_shown.set)
        is_shown.wait()
        assert viewer._session.state.scene.items == larger.items
        assert viewer.scene is viewer._session.state.scene
    finally:
        goes_on.set()
        viewer.close()


GRADIENT = np.dstack([np.add.outer(np.arange(64), np.arange(96) + shift).astype(np.uint8) for shift in (0, 20, 60, 0)])


class PageOfFrames(PageDisplay):
    """A back end with a page that keeps frames, and shows them when it is told to. `now` is its time."""

    def __init__(self) -> None:
        super().__init__(lambda message, data: self.frames.append((message["number"], data)))
        self.frames: list[tuple[int, bytes]] = []
        self.now = 0.0

    def time(self) -> float:
        return self.now

    def show_all(self) -> None:
        for number, _ in self.frames:
            self.acknowledge(number)


def test_frames_wait_for_a_page_that_shows_none() -> None:
    page = PageOfFrames()
    assert [page.offer(GRADIENT) for _ in range(4)] == [True] * AHEAD + [False] * (4 - AHEAD)
    page.acknowledge(page.frames[0][0])
    assert [page.offer(GRADIENT) for _ in range(2)] == [True, False]
    page.restart()
    assert page.offer(GRADIENT)


def test_the_last_frame_is_sent_again_in_finer_quality_once() -> None:
    page = PageOfFrames()
    page.offer(GRADIENT)
    assert not page.is_to_sharpen  # the page has not shown it: its answer comes as an event
    page.show_all()
    assert page.is_to_sharpen
    page.now = QUIET / 2
    page.sharpen(GRADIENT)
    assert len(page.frames) == 1
    page.now = QUIET
    page.sharpen(GRADIENT)
    page.show_all()
    page.now = 2 * QUIET
    page.sharpen(GRADIENT)
    assert [data for _, data in page.frames] == [encode(GRADIENT, COARSE), encode(GRADIENT, FINE)]
    assert not page.is_to_sharpen


def test_frames_have_the_colours_of_the_picture() -> None:
    for quality, allowed in ((FINE, 3), (COARSE, 12)):
        shown = np.asarray(Image.open(io.BytesIO(encode(GRADIENT, quality)))).astype(int)
        error = np.abs(shown - GRADIENT[..., 2::-1])
        assert error.mean() < allowed
        assert np.abs(shown - GRADIENT[..., :3]).mean() > 20  # red and blue are not swapped


def event(key: str, code: str = "", location: int = 0, **held: bool) -> dict[str, Any]:
    modifiers = dict.fromkeys(("shift", "ctrl", "alt", "command"), False) | held
    return {"key": key, "code": code, "location": location, **modifiers}


@pytest.mark.parametrize(
    ("pressed", "code", "text"),
    [
        (event("a", "KeyA"), Key.A, "a"),
        (event("A", "KeyA", shift=True), Key.A, "A"),
        (event("q", "KeyA"), Key.Q, "q"),  # of a French keyboard
        (event("ф", "KeyA"), Key.A, "ф"),  # of a Russian one
        (event("+", "Equal", shift=True), Key.PLUS, "+"),
        (event("z", "KeyZ", ctrl=True), Key.Z, ""),
        (event("z", "KeyZ", command=True), Key.Z, ""),
        (event("{", "Digit7", ctrl=True, alt=True), ord("{"), "{"),  # AltGr of a German keyboard on Windows
        (event("ArrowLeft", "ArrowLeft"), Key.LEFT, ""),
        (event("ArrowLeft", "Numpad4", 3), Key.KEYPAD_LEFT, ""),
        (event("4", "Numpad4", 3), Key.DIGIT_4, "4"),
        (event("Enter", "Enter"), Key.RETURN, ""),
        (event("Enter", "NumpadEnter", 3), Key.KEYPAD_ENTER, ""),
        (event("Delete", "Delete"), Key.DELETE, ""),
        (event("PageUp", "PageUp"), Key.PAGE_UP, ""),
        (event("F1", "F1"), Key.F1, ""),
        (event(" ", "Space"), Key.SPACE, " "),
        (event("Shift", "ShiftRight", 2, shift=True), Key.SHIFT_R, ""),
        (event("Dead", "BracketLeft"), None, ""),
        (event("AudioVolumeUp", "AudioVolumeUp"), None, ""),
    ],
)
def test_codes_and_text(pressed: dict[str, Any], code: int | None, text: str) -> None:
    assert (code_of(pressed), text_of(pressed)) == (code, text)


def test_command_is_the_modifier_of_shortcuts() -> None:
    assert modifiers_of(event("z", command=True)) == Modifier.ACCEL
    assert modifiers_of(event("z", shift=True, alt=True)) == Modifier.SHIFT | Modifier.ALT
    assert modifiers_of(event("z")) == Modifier.NONE
