"""Clicks and drags of the pointer in a session."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from minirt.errors import MiniRTError
from minirt.mlx import Button
from minirt.rendering.queries.pick import surface_point
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.display.icons import icon_at
from minirt.viewer.display.overlay import Level
from minirt.viewer.editing import dragging, selection
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import position_of
from minirt.viewer.input.bindings import Binding
from minirt.viewer.input.chords import Drag

if TYPE_CHECKING:
    from minirt.fields import Triple
    from minirt.viewer.app.session import Session

SLACK = 3  # pixels that the pointer may move in a click
DRAGS = {Button.LEFT: Drag.LEFT, Button.MIDDLE: Drag.MIDDLE, Button.RIGHT: Drag.RIGHT}


class Press(NamedTuple):
    """A button that is down."""

    button: int
    x: int
    y: int
    drag: Binding
    grip: dragging.DragStart


class Mouse:
    """A press on something selects it at once; a click of another button counts when the button is let go where it was
    pressed, since it might have become a drag."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._press: Press | None = None
        self._dragging = False

    def press(self, button: int, x: int, y: int) -> None:
        self.let_go()
        session = self.session
        drag = session.keymap.find(DRAGS[Button(button)], session.modifiers) if button in DRAGS else None
        if drag is None:
            self.click(button)
            return
        try:
            point = self.grasp(x, y, selecting=button == Button.LEFT)
        except MiniRTError as error:  # a picture on a shape may be gone since
            session.complain(error)
            session.show(session.state)
            return
        held = dragging.start_drag(session.state.end_merging(), session.win.width, session.win.height, x, y, point)
        self._press = Press(button, x, y, drag, held)

    def motion(self, x: int, y: int) -> None:
        press = self._press
        if press and (self._dragging or max(abs(x - press.x), abs(y - press.y)) > SLACK):
            session = self.session
            if not self._dragging:
                self._dragging = True
                session.state = session.state.end_merging()
            session.show(dragging.apply_drag(session.state, press.drag.action, press.grip, x, y))

    def release(self, button: int) -> None:
        press = self._press
        if press and press.button == button:
            clicked = not self._dragging and button != Button.LEFT
            self.let_go()
            if clicked:
                self.click(button)

    def let_go(self) -> None:
        """Whatever is held is held no more."""
        if self._dragging:
            self.session.state = self.session.state.end_merging()
        self._press, self._dragging = None, False

    def click(self, button: int) -> None:
        """Do what the table says of that button."""
        binding = self.session.keymap.find(button, self.session.modifiers)
        if binding:
            self.session.act(binding, self.session.step)

    def grasp(self, x: int, y: int, selecting: bool) -> Triple | None:
        """The place in the scene under the pointer; what is there is selected."""
        session = self.session
        state, win = session.state, session.win
        seen = projection_of(state.scene.camera, win.width, win.height)
        shown = session.screen.marks.placed(state, seen, win.scale) if session.screen.level > Level.NOTHING else []
        icon = icon_at(shown, x, y, win.scale)
        if icon:
            if selecting:
                session.show(state.with_message("").select(icon.owner))
            element = state.scene.elements[icon.owner]
            return None if isinstance(element, Camera) else position_of(element)
        shape: Shape | None = session.pick(state.scene, win.width, win.height, x, y)
        if selecting:
            session.show(selection.select_shape(state, shape))
        return surface_point(shape, state.scene.camera, win.width, win.height, x, y) if shape else None
