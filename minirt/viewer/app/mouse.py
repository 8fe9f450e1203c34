"""Mouse input: clicks, drags and the wheel over the picture of a session."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from minirt.errors import MiniRTError
from minirt.mlx import Button, Cursor
from minirt.rendering.queries.pick import surface_point
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.app.session import PressedButton, Session
from minirt.viewer.bindings import Binding, Drag
from minirt.viewer.display.marks import icon_at
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.editing.dragging import PIXEL_CENTRE, apply_drag, start_drag
from minirt.viewer.editing.projection import Aim, aim, projection_of
from minirt.viewer.editing.state import position_of, select_shape

if TYPE_CHECKING:
    from minirt.fields import Triple

CLICK_SLACK = 3  # pixels that the pointer may move during a click
CURSORS = {"move by hand": Cursor.MOVE, "pan": Cursor.GRAB}  # while a drag goes on; other drags turn something
DRAGS = {Button.LEFT: Drag.LEFT, Button.MIDDLE: Drag.MIDDLE, Button.RIGHT: Drag.RIGHT}


class Mouse:
    """Turn button and motion events into clicks and drags.

    The left button selects when it goes down. A click of another button counts when the button is released where it
    was pressed, because until then it may become a drag.
    """

    def __init__(self, session: Session, perform: Callable[[Binding, float], None]) -> None:
        self.session = session
        self._perform = perform
        self.inside = True  # whether the pointer is over the window

    def on_press(self, button: int, x: int, y: int) -> None:
        """A button goes down, or the wheel turns."""
        session = self.session
        session.pointer = x, y
        session.release_button()
        drag = session.keymap.find(DRAGS[Button(button)], session.modifiers) if button in DRAGS else None
        if drag is None:
            self.click(button)
            return
        try:
            point = self.pick_point(x, y, selecting=button == Button.LEFT)
        except MiniRTError as error:  # the file of a texture may be gone meanwhile
            session.show_error(error)
            session.show(session.state)
            return
        grip = start_drag(session.state.end_merging(), session.window.width, session.window.height, x, y, point)
        session.pressed = PressedButton(button, x, y, drag, grip)

    def on_crossing(self, inside: bool) -> None:
        """The pointer enters the window or leaves it."""
        self.inside = inside

    def on_motion(self, x: int, y: int) -> None:
        """The pointer moves: drag, if a button is down and the pointer has left the slack of a click."""
        session = self.session
        session.pointer = x, y
        pressed = session.pressed
        if pressed and (pressed.dragging or max(abs(x - pressed.x), abs(y - pressed.y)) > CLICK_SLACK):
            if not pressed.dragging:
                session.pressed = pressed._replace(dragging=True)
                session.mlx.mlx_set_cursor(session.window, self.cursor(pressed))
                session.state = session.state.end_merging()
            session.show(apply_drag(session.state, pressed.drag.action, pressed.grip, x, y))

    def cursor(self, pressed: PressedButton) -> Cursor:
        """Return the shape of the pointer during a drag; a drag on nothing turns the camera."""
        looks_around = pressed.drag.action == "move by hand" and pressed.grip.moves_camera
        return Cursor.TURN if looks_around else CURSORS.get(pressed.drag.action, Cursor.TURN)

    def on_release(self, button: int) -> None:
        """A button goes up: a drag ends, or a click is complete."""
        pressed = self.session.pressed
        if pressed and pressed.button == button:
            clicked = not pressed.dragging and button != Button.LEFT
            self.session.release_button()
            if clicked:
                self.click(button)

    def click(self, button: int) -> None:
        """Perform the action that is bound to a button."""
        binding = self.session.keymap.find(button, self.session.modifiers)
        if binding:
            self._perform(binding, self.session.step)

    def pick_point(self, x: int, y: int, selecting: bool) -> Triple | None:
        """Return the point of the scene under the pointer, None if there is none; select the element there."""
        session = self.session
        state, window, scale = session.state, session.window, session.screen.scale
        view = projection_of(state.scene.camera, window.width, window.height)
        has_icons = session.screen.level > HudLevel.NOTHING
        icons = session.screen.marks.visible_icons(state.scene, state.selected, view, scale) if has_icons else []
        icon = icon_at(icons, x, y, scale)
        if icon:
            if selecting:
                session.show(state.with_message("").select(icon.owner))
            element = state.scene.elements[icon.owner]
            return None if isinstance(element, Camera) else position_of(element)
        shape, point = self.surface_at(x, y)
        if selecting:
            session.show(select_shape(state, shape))
        return point

    def surface_at(self, x: int, y: int) -> tuple[Shape | None, Triple | None]:
        """Return the shape at a pixel and the point on it, None for both where the background is."""
        scene, window = self.session.state.scene, self.session.window
        shape: Shape | None = self.session.pick(scene, window.width, window.height, x, y)
        return shape, surface_point(shape, scene.camera, window.width, window.height, x, y) if shape else None

    def aim(self) -> Aim | None:
        """Return the place under the pointer, where a new element goes; None while the pointer is elsewhere."""
        session, window = self.session, self.session.window
        (x, y), state = window.pointer, session.state
        if (x, y) == (0, 0) or not self.inside:
            return None
        try:
            shape, point = self.surface_at(x, y)
        except MiniRTError as error:
            session.show_error(error)
            return None
        view = projection_of(state.scene.camera, window.width, window.height)
        return aim(view, state.size, x + PIXEL_CENTRE, y + PIXEL_CENTRE, shape, point)
