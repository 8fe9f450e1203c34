"""Words at once: a key's words are in the window before its picture, and the marks fit the picture that is shown."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from minirt.mlx import Key
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.app.session import Session
from minirt.viewer.display.marks import GOLD, Marks, bgra
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.display.painter import Outcome
from minirt.viewer.display.screen import Screen
from minirt.viewer.editing.state import State
from tests.viewer.session_harness import SessionHarness

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
    harness.session.pick = lambda scene, *_: scene.spheres[0]
    harness.finish(0.001)
    harness.memory.resize(WIDTH, HEIGHT)
    harness.play("click 320,240", "text +")
    harness.finish(0.001)
    harness.play("press i", "wait 1")
    assert harness.session.screen.level == HudLevel.ALL
    return harness


def expected_frame(session: Session, state: State) -> np.ndarray:
    """Return the frame with the words of `state` over the picture that the session has."""
    screen = Screen(session.mlx, session.window, session.screen.layout)
    screen.level, screen.panel = session.screen.level, session.screen.panel
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


def outline_mask(shown: Outcome, shape: Shape) -> np.ndarray:
    """Return a mask of the outline of a shape in a picture, between the words."""
    mask = np.zeros((HEIGHT, WIDTH), bool)
    for places in Marks().outline(shape, shown.job.scene.camera, np.empty((HEIGHT, WIDTH, 4), np.uint8), 60_000):
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
    requests = len(harness.painter.requests)
    harness.memory.press(Key.D)
    for _ in range(20):  # a picture before the next tick
        harness.memory.play()
        if harness.painter.open:
            harness.finish(0.001)
        harness.memory.wait(1 / 60)
    assert len(frames) == len(harness.painter.requests) - requests
    together = len(frames)
    harness.memory.wait(1)  # no pictures: words alone, but not at each tick
    harness.memory.play()
    assert 15 < len(frames) - together <= 30


def test_words_come_before_the_first_picture() -> None:
    harness = SessionHarness()
    assert not harness.memory.screenshot()[..., :3].any()
    harness.memory.wait(MOMENT)
    harness.memory.play()
    assert harness.memory.screenshot()[..., :3].any()
    assert isinstance(harness.session.state.element, Camera)
