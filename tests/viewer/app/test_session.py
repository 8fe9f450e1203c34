"""A session renders and draws when needed and not otherwise, on a window in memory."""

from __future__ import annotations

import pytest

from minirt.errors import FileError, RenderError
from minirt.mlx import Button, Cursor, Key
from minirt.viewer.display.painter import Job, Outcome
from minirt.viewer.display.refinement import FRAME_TIME
from minirt.viewer.editing.state import initial_state
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
    harness.painter.outcomes.append(Outcome(Job(scene(), *SIZE)))  # cancelled: it was not the last request
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
    assert session.state.message == ""
    session.saved = scene(AWAY)
    session.state = initial_state(session.saved)
    session.update()
    while harness.painter.busy:
        harness.finish(0.001)
    assert session.state.message.startswith("nothing is in view; this line would show the scene: C ")
    harness.play("press d")
    assert session.state.message == ""
    harness.finish(0.001)
    assert session.state.message == ""


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
