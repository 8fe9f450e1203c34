"""A session renders and draws when needed and not otherwise, on a window in memory, and shows words at once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import FileError, RenderError
from minirt.mlx import Button, Cursor, Key
from minirt.rendering.queries.pick import pick
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.app import commands
from minirt.viewer.app.session import Session
from minirt.viewer.display.jobs import Painted, PaintJob
from minirt.viewer.display.marks import GOLD, bgra
from minirt.viewer.display.outline import outline_pixels
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.display.refinement import FRAME_TIME
from minirt.viewer.display.screen import Screen
from minirt.viewer.editing.state import State, initial_state
from tests.viewer.fake import colour_of, scene
from tests.viewer.session_harness import SIZE, SessionHarness

AWAY = "A 0.2 255,255,255\nC 0,0,0 0,0,-1 60\nsp 0,0,9 1 255,0,0\n"


def test_the_loop_sleeps_unless_a_key_is_held_or_words_wait():
    harness = SessionHarness()
    assert harness.display.busy
    harness.finish(0.001)
    assert not harness.display.busy
    harness.play("press d")
    assert harness.display.busy
    harness.play("wait 0.05")
    assert not harness.display.busy
    harness.play("down d")
    assert harness.display.busy
    harness.play("up d")
    harness.finish(0.001)
    assert not harness.display.busy
    harness.memory.press(Key.D)
    harness.memory.do(lambda: harness.memory.window.on_focus(False))
    harness.memory.play()
    harness.finish(0.001)
    assert not harness.display.busy


def test_a_picture_is_shown_before_the_next_one_is_requested(monkeypatch):
    harness = SessionHarness(samples=4)
    samples_when_shown = []
    show = harness.memory.window.show
    monkeypatch.setattr(
        harness.memory.window, "show", lambda: (samples_when_shown.append(harness.painter.samples), show())
    )
    harness.finish(0.001)
    harness.finish(0.001)
    assert samples_when_shown == [[1], [1, 4]]


def test_an_unchanged_frame_is_not_drawn_again():
    harness = SessionHarness()
    harness.finish(0.001)
    frame = harness.session.screen.frame
    harness.painter.outcomes.append(Painted(PaintJob(scene(), *SIZE)))  # cancelled: it was not the last request
    harness.painter.notify()
    harness.memory.play()
    assert harness.session.screen.frame is frame
    harness.play("press i")
    assert harness.session.screen.frame is not frame


def test_a_coarse_picture_is_stretched_over_the_window():
    harness = SessionHarness()
    harness.finish(FRAME_TIME * 64)
    harness.hide_overlay()
    harness.play("press d")
    harness.finish(FRAME_TIME)
    assert harness.session.refinement.latest.pixels.shape == (6, 8, 4)
    assert harness.memory.screenshot().shape == (48, 64, 4)
    assert (harness.memory.screenshot() == colour_of(harness.session.state.scene)).all()


def test_a_render_error_is_a_message_over_the_picture():
    harness = SessionHarness()
    harness.finish(0.001)
    harness.play("press d")
    before = harness.memory.screenshot()
    harness.painter.renderer.error = RenderError("too many shapes")
    harness.finish(0.001)
    harness.play("wait 0.05")
    assert harness.session.state.message == "too many shapes"
    assert (harness.session.picture == colour_of(scene())).all()
    assert (harness.memory.screenshot() != before).any()
    harness.play("wait 1")
    assert len(harness.painter.requests) == 3  # two with the tap; and it is not requested again


def test_an_error_of_picking_is_a_message_over_the_picture() -> None:
    harness = SessionHarness()
    harness.finish(0.001)

    def fail(*_: object) -> None:
        raise FileError("brick.png", "cannot be read")

    harness.session.pick = fail
    harness.play("click 30,20")
    assert "brick.png" in harness.session.state.message


def test_a_screenshot_waits_for_the_final_picture(tmp_path):
    harness = SessionHarness(samples=4)
    harness.session.path = tmp_path / "scene.rt"
    harness.finish(FRAME_TIME * 100)
    harness.play("press d", "press p")
    for _ in range(2):  # the coarse one, the whole one
        harness.finish(FRAME_TIME)
        assert list(tmp_path.iterdir()) == []
    harness.finish(FRAME_TIME)
    assert [file.name for file in tmp_path.iterdir()] == ["scene-1.png"]


def test_a_first_picture_with_nothing_in_view_is_remarked_on_once():
    harness = SessionHarness()
    session = harness.session
    harness.finish(0.001)
    assert session.state.message.startswith("what is in view has one colour")
    harness.play("press i")
    session.saved = scene(AWAY)
    session.state = initial_state(session.saved)
    session.update()
    while harness.painter.busy:
        harness.finish(0.001)
    assert session.state.message == "nothing is in view: all is behind the eye; F brings the scene into view"
    harness.play("press d")
    assert session.state.message == ""
    harness.finish(0.001)
    assert session.state.message == ""


def test_a_key_brings_a_scene_in_a_dialect_into_view_of_which_nothing_is_seen(tmp_path: Path) -> None:
    harness = SessionHarness()
    session, path = harness.session, tmp_path / "other.rt"
    path.write_text("A 0.2 255,255,255\nC 0, 0, 9 0,0,1 60\nL 0,9,0 1\nsp 0,0,0 2 255,0,0\nsp 3,0,0 1 9,9,9\n")
    commands.open_another(session, path)
    session.update()
    while harness.painter.busy:
        harness.finish(0.001)
    _, translated, notice = session.state.message.split("\n")
    assert translated == commands.TRANSLATED.format("other.rt")
    assert notice == (
        "nothing is in view: all is behind the eye; --camera-as reversed shows 2 of 2; F brings the scene into view"
    )
    before = session.state.scene.camera
    harness.play("press f")
    camera = session.state.scene.camera
    assert camera != before
    assert {id(pick(session.state.scene, 64, 36, x, y)[0]) for x in range(0, 64, 2) for y in range(0, 36, 2)} >= {
        *map(id, session.state.scene.spheres)
    }
    harness.play("press Ctrl+z")
    assert session.state.scene.camera == before


@pytest.mark.parametrize(
    ("button", "shape"), [(Button.LEFT, Cursor.TURN), (Button.MIDDLE, Cursor.GRAB), (Button.RIGHT, Cursor.TURN)]
)
def test_a_drag_changes_the_pointer_until_the_button_is_released(button: Button, shape: Cursor) -> None:
    harness = SessionHarness()
    shapes = []
    for act in (
        lambda: harness.memory.button_press(button, 20, 20),
        lambda: harness.memory.motion(30, 25),
        lambda: harness.memory.button_release(button, 30, 25),
    ):
        act()
        harness.memory.play()
        shapes.append(harness.session.window.cursor)
    assert shapes == [Cursor.ARROW, shape, Cursor.ARROW]


# A key's words are in the window before its picture, and the marks fit the picture that is shown.

MOMENT = 0.05  # simulated seconds in which words must be in the window
WIDTH, HEIGHT = 640, 480
MIDDLE = slice(140, 340)  # rows without words

Play = Callable[[SessionHarness], object]

ACTIONS: dict[str, Play] = {
    "add": lambda harness: harness.memory.tap(Key.N),
    "add twice": lambda harness: harness.memory.tap(Key.N, Key.N),
    "grow": lambda harness: harness.memory.text("+"),
    "delete": lambda harness: harness.memory.tap(Key.DELETE),
    "undo": lambda harness: harness.memory.tap(Key.CONTROL_L, Key.Z),
    "select next": lambda harness: harness.memory.tap(Key.TAB),
    "edit and select next": lambda harness: (harness.memory.text("+"), harness.memory.tap(Key.TAB)),
    "hold": lambda harness: harness.memory.press(Key.UP),
    "drag": lambda harness: (harness.memory.button_press(1, 320, 240), harness.memory.motion(360, 250)),
    "wheel": lambda harness: harness.memory.scroll(2, 320, 240),
}


@pytest.fixture
def harness() -> SessionHarness:
    """Return a session that shows a picture, in which a sphere is selected and was edited once."""
    harness = SessionHarness()
    harness.finish(0.001)
    harness.memory.resize(WIDTH, HEIGHT)
    harness.play("click 320,240", "text +")
    harness.finish(0.001)
    harness.play("press i", "wait 1")
    assert harness.session.screen.level == HudLevel.ALL
    return harness


def expected_frame(session: Session, state: State) -> np.ndarray:
    """Return the frame with the words of `state` over the picture that the session has."""
    screen = Screen(session.mlx, session.window, session.keymap)
    screen.level, screen.list_box = session.screen.level, session.screen.list_box
    screen.draw(state, session.refinement.latest, session.refinement.resolution.rate)
    return screen.frame


def words(frame: np.ndarray) -> np.ndarray:
    """Return the rows of a frame in which words are."""
    return np.delete(frame, MIDDLE, axis=0)


def golden(frame: np.ndarray) -> np.ndarray:
    """Return a mask of the pixels in the colour of the outline, between the words."""
    mask: np.ndarray = (frame[MIDDLE] == np.array(bgra(GOLD), np.uint8)).all(axis=2)
    return mask


def perform(harness: SessionHarness, play: Play) -> None:
    """Perform an action, and wait a moment without a picture."""
    play(harness)
    harness.memory.wait(MOMENT)
    harness.memory.play()


def outline_mask(shown: Painted, shape: Shape) -> np.ndarray:
    """Return a mask of the outline of a shape in a picture, between the words."""
    mask = np.zeros((HEIGHT, WIDTH), bool)
    for places in outline_pixels(shape, shown.job.scene.camera, WIDTH, HEIGHT, 60_000):
        mask[places] = True
    return mask[MIDDLE]


@pytest.mark.parametrize("action", ACTIONS)
def test_words_come_without_a_picture_and_the_outline_fits_the_one_that_is_shown(
    harness: SessionHarness, action: str
) -> None:
    session, before, shown = harness.session, harness.session.state, harness.session.refinement.latest
    assert golden(harness.memory.screenshot()).any()
    perform(harness, ACTIONS[action])
    assert session.state is not before
    assert session.refinement.latest is shown is not None
    frame = harness.memory.screenshot()
    assert np.array_equal(words(frame), words(expected_frame(session, session.state)))
    mask = golden(frame)
    assert not mask.any() or any(np.array_equal(mask, outline_mask(shown, each)) for each in shown.job.scene.shapes)


def test_the_outline_stays_on_an_edited_shape_and_waits_for_a_new_one(harness: SessionHarness) -> None:
    before = golden(harness.memory.screenshot())
    perform(harness, ACTIONS["grow"])
    assert np.array_equal(golden(harness.memory.screenshot()), before)
    harness.finish(0.001)
    assert not np.array_equal(golden(harness.memory.screenshot()), before)
    perform(harness, ACTIONS["add"])
    assert not golden(harness.memory.screenshot()).any()
    harness.finish(0.001)
    assert golden(harness.memory.screenshot()).any()


def test_a_picture_stretched_to_another_size_has_no_outline(harness: SessionHarness) -> None:
    harness.memory.resize(WIDTH, HEIGHT - 40)
    perform(harness, lambda harness: harness.memory.tap(Key.X))
    frame = harness.memory.screenshot()
    assert frame.shape == (HEIGHT - 40, WIDTH, 4)
    assert not golden(frame).any()
    harness.finish(0.001)
    assert golden(harness.memory.screenshot()).any()


def test_words_and_picture_that_come_together_are_one_frame(harness: SessionHarness) -> None:
    frames = []
    show = harness.memory.window.show
    harness.memory.window.show = lambda: (frames.append(harness.session.now), show())
    harness.memory.press(Key.D)
    harness.memory.wait(0.03)
    harness.memory.play()
    assert not frames  # a picture that is two ticks late after a rest
    requests = len(harness.painter.requests) - 1
    for _ in range(20):  # a picture before the next tick
        harness.memory.play()
        if harness.painter.open:
            harness.finish(0.001)
        harness.memory.wait(1 / 60)
    assert len(frames) == len(harness.painter.requests) - requests
    together = len(frames)
    harness.memory.wait(1)  # no pictures: words alone, but not at each tick
    harness.memory.play()
    assert 12 < len(frames) - together <= 30


def test_words_come_before_the_first_picture() -> None:
    harness = SessionHarness()
    assert not harness.memory.screenshot()[..., :3].any()
    harness.memory.wait(MOMENT)
    harness.memory.play()
    assert harness.memory.screenshot()[..., :3].any()
    assert isinstance(harness.session.state.element, Camera)
