"""The pointer has a shape of its own while a drag goes on."""

from __future__ import annotations

import pytest

from minirt.mlx import Button, Cursor
from tests.viewer.session_harness import SessionHarness


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
