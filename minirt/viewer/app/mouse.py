"""Mouse input: clicks, drags and the wheel over the picture of a session."""

from __future__ import annotations

from collections.abc import Callable
from math import dist, inf
from typing import Any

from minirt.element import Element
from minirt.errors import MiniRTError
from minirt.fields import Triple
from minirt.mlx import Button, Cursor, Modifier
from minirt.scene import Camera
from minirt.scene.names import element_name
from minirt.shapes import Shape
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import Binding
from minirt.viewer.display.marks import LENGTH as ARROW_LENGTH
from minirt.viewer.display.marks import SIZE, Icon, arrow_tip, arrows, visible_icons
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.editing.dragging import DRAGS, PIXEL_CENTRE, DragStart, pull
from minirt.viewer.editing.handles import handle_at, handles_of
from minirt.viewer.editing.motion import APPROACHING, approach, in_reach, look_at
from minirt.viewer.editing.placing import AHEAD, aim, aim_at_top
from minirt.viewer.editing.projection import Aim, position_of
from minirt.viewer.editing.selection import look_through
from minirt.viewer.editing.state import State, index_of

NEARER = 0.7  # of the picture's height: where the tool row puts an element
CLICK_SLACK = 3  # pixels that the pointer may move during a click
ARROW = "arrow"  # the action of a press on an arrow at the edge
SLIDING = "slide by hand"  # the drag that leaves handles alone, as its chords may be those of a handle, too
DOUBLE_CLICK = 0.4  # seconds between its presses
SHIFT_DRAG = "turn by hand"  # the drag with Shift, without which the press selects several
CURSORS = {"move by hand": Cursor.MOVE, "pan": Cursor.GRAB}  # while a drag goes on; other drags turn something
ZOOMS = {"nearer": 1.0, "farther": -1.0}  # actions of the wheel, and their steps towards what is under the pointer
BUTTON_DRAGS = {each: f"{each.name.lower()} drag" for each in (Button.LEFT, Button.MIDDLE, Button.RIGHT)}


class Mouse:
    """Turn button and motion events into clicks and drags.

    The left button selects when it goes down: one of several selected elements becomes the primary one, as a drag moves
    them all. A click of another button, with Shift, or on one of several counts when the button is released where it
    was pressed, because until then it may become a drag.
    """

    def __init__(self, session: Session, perform: Callable[[Binding], None]) -> None:
        self.session = session
        self._perform = perform
        self.inside = True  # whether the pointer is over the window
        self._target: Triple | None = None  # the point towards which the wheel zooms
        self._aimed_at = (-1, -1)  # the pixel where it was found
        self._pressed_before: tuple[float, int | None] = -inf, None  # time, and the element, of the last press

    def on_press(self, button: int, x: int, y: int, shows_handles: bool) -> None:
        """Handle a button that goes down at pixel x, y, or the wheel; `shows_handles`: handles can be grabbed."""
        session = self.session
        session.pointer = x, y
        session.release_button()
        drag = session.keymap.find(BUTTON_DRAGS[Button(button)], session.modifiers) if button in BUTTON_DRAGS else None
        if drag is None:
            self.click(button)
            return
        if button == Button.LEFT and drag.action != SLIDING and self.grab(x, y, shows_handles):
            return
        try:
            owner, point = self.owner_at(x, y)
            if drag.action == "orbit":
                point = self.pivot(owner, point)
        except MiniRTError as error:  # the file of a texture may be gone meanwhile
            session.show_error(error)
            session.show(session.state)
            return
        if button == Button.LEFT and self.looks_through(owner):
            return
        if button == Button.LEFT and drag.action != SHIFT_DRAG:
            state = session.state.with_message("nothing is there: the camera is selected" if owner is None else "")
            session.show(state if owner is None else state.make_primary(owner))
        state = session.state
        element = state.element if owner is None or button != Button.LEFT else state.scene.elements[owner]
        self.note_press(x, y, element, point, button=button, action=drag.action, owner=owner)

    def note_press(self, x: int, y: int, element: Element, point: Triple | None, **others: Any) -> None:
        """Note that a button is down on the picture; see the fields of `DragStart`."""
        session = self.session
        session.pressed = DragStart(session.view, x, y, element, session.state.scene.camera, point, **others)

    def looks_through(self, owner: int | None) -> bool:
        """Look through a further camera where its icon is pressed twice; return whether it is."""
        session, before = self.session, self._pressed_before
        self._pressed_before = session.now, owner
        scene = session.state.scene
        is_double = owner == before[1] and session.now - before[0] <= DOUBLE_CLICK
        camera = scene.elements[owner] if is_double and owner is not None else None
        if owner is None or not isinstance(camera, Camera) or camera is scene.camera:
            return False
        session.show(look_through(session.state, owner, session.now))
        return True

    def grab(self, x: int, y: int, shows_handles: bool) -> bool:
        """Grab the arrow at the edge, or the selected element's handle, at pixel x, y; return whether there is one."""
        session, state, screen = self.session, self.session.state, self.session.screen
        if screen.level == HudLevel.NOTHING:
            return False
        for owner, way in arrows(state.scene, state.chosen, session.view, screen.icons).items():
            tip = arrow_tip(way, *screen.size, screen.scale)
            if dist(tip, (x, y)) < ARROW_LENGTH * screen.scale:  # it acts at the release: see `selection_after`
                self.note_press(x, y, state.element, None, button=Button.LEFT, action=ARROW, owner=owner)
                return True
        if not shows_handles:
            return False
        handles = handles_of(state.element, session.view, screen.scale, bool(state.others), screen.handle_kind)
        handle = handle_at(handles, x + PIXEL_CENTRE, y + PIXEL_CENTRE, screen.scale)
        if handle:
            self.note_press(x, y, state.element, handle.centre, button=Button.LEFT, handle=handle)
        return handle is not None

    def on_motion(self, x: int, y: int) -> None:
        """Handle a pointer that moves to pixel x, y: drag, if a button is down and the pointer has left CLICK_SLACK."""
        session = self.session
        (from_x, from_y), session.pointer = session.pointer, (x, y)
        pressed = session.pressed
        if pressed and pressed.handle:
            right, down = pressed.reach
            reach = right + (x - from_x) * session.step, down + (y - from_y) * session.step
            session.pressed = pressed = pressed._replace(reach=reach)
        is_drag = pressed and (pressed.dragging or max(abs(x - pressed.x), abs(y - pressed.y)) > CLICK_SLACK)
        if pressed and is_drag and pressed.action == ARROW:
            session.pressed = pressed._replace(dragging=True)  # nothing is dragged, but it is no click any more
        elif pressed and is_drag:
            if not pressed.dragging:
                session.pressed = pressed._replace(dragging=True)
                looks_around = pressed.action == "move by hand" and pressed.moves_camera
                cursor = Cursor.TURN if looks_around else CURSORS.get(pressed.action, Cursor.TURN)
                session.mlx.mlx_set_cursor(session.window, cursor)
                session.state = session.state.end_merging()
                if pressed.owner is not None and pressed.action == SHIFT_DRAG:
                    session.state = session.state.make_primary(pressed.owner)
            session.say("")
            held = session.modifiers
            pressed = pressed._replace(snaps=Modifier.ACCEL in held, fine=Modifier.SHIFT in held)
            drag = pull if pressed.handle else DRAGS[pressed.action]
            session.show(drag(session.state, pressed, x, y))

    def on_release(self, button: int) -> None:
        """A button goes up: a drag ends, or a click is complete."""
        pressed = self.session.pressed
        if pressed and pressed.button == button:
            self.session.release_button()
            if not pressed.dragging and button != Button.LEFT:
                self.click(button)
            elif not pressed.dragging and not pressed.handle:
                self.session.show(self.selection_after(pressed))

    def framed(self, owner: int) -> State:
        """Return the state after a click on the arrow to an element, which brings that into view."""
        state = self.session.state
        message = f"{element_name(state.scene, owner)} is in the middle now"
        return look_at(state.select(owner), 1.0, self.session.now).with_message(message)

    def selection_after(self, pressed: DragStart) -> State:
        """Return the state after a click of the left button: on nothing the camera is selected."""
        state, owner = self.session.state, pressed.owner
        if owner is not None and pressed.action == ARROW:
            return self.framed(owner)
        is_with_shift = pressed.action == SHIFT_DRAG
        if owner is None:
            camera = index_of(state.scene, state.scene.camera)
            return state if is_with_shift or state.selected == camera else state.select(camera)
        state = state.with_message("")
        return state.add_or_remove(owner) if is_with_shift else state.select(owner)

    def click(self, button: int) -> None:
        """Perform the action that is bound to a button."""
        binding = self.session.keymap.find(button, self.session.modifiers)
        if binding and binding.action in ZOOMS:
            self.zoom(ZOOMS[binding.action])
        elif binding:
            self._perform(binding)

    def zoom(self, steps: float) -> None:
        """Move the camera towards what is under the pointer; steps that follow each other go to the same point."""
        session, (x, y) = self.session, self.session.pointer
        state = session.state.with_message("")
        goes_on = state.last_change is not None and state.last_change[0] == APPROACHING
        if not goes_on or self._aimed_at != (x, y):
            (_, self._target), self._aimed_at = self.owner_at(x, y), (x, y)
        ray = session.view.ray(x + PIXEL_CENTRE, y + PIXEL_CENTRE)
        session.show(approach(state, ray, self._target, steps, session.now))

    def pivot(self, owner: int | None, point: Triple | None) -> Triple | None:
        """The point that the camera orbits: on the element under the pointer or, if that is endless or far away, in the
        middle of the picture."""
        session, state = self.session, self.session.state
        near = in_reach(state, point)
        element = None if owner is None else state.scene.elements[owner]
        if near and not (isinstance(element, Shape) and element.infinite):
            return near
        width, height = session.screen.size
        _, middle = session.surface_at(width // 2, height // 2)
        return in_reach(state, middle) or near

    def select_for_menu(self) -> Triple | None:
        """Select the element under the pointer, or the camera where there is none; return the point there."""
        session = self.session
        owner, point = self.owner_at(*session.pointer)
        state = session.state.with_message("")
        if owner is None:
            owner = index_of(state.scene, state.scene.camera)
        session.show(state.make_primary(owner))
        return point

    def icon_at(self, x: int, y: int) -> Icon | None:
        """Return the icon at a pixel that is drawn on top, None where there is none."""
        session, state, screen = self.session, self.session.state, self.session.screen
        icons = visible_icons(state.scene, state.chosen, session.view, screen.scale, screen.icons)
        reach = SIZE * screen.scale / 2 if screen.level > HudLevel.NOTHING else -1.0
        under = [each for each in icons if max(abs(each.x - x), abs(each.y - y)) <= reach]
        return under[-1] if under else None

    def owner_at(self, x: int, y: int) -> tuple[int | None, Triple | None]:
        """Return the index of the element under the pointer, and the point of the scene there; None without one."""
        session, state = self.session, self.session.state
        if icon := self.icon_at(x, y):
            element = state.scene.elements[icon.owner]
            return icon.owner, None if element is state.scene.camera else position_of(element)
        shape, point = session.surface_at(x, y)
        return index_of(state.scene, shape) if shape else None, point

    def aim(self, at: tuple[int, int] | None = None) -> Aim | None:
        """Return the place for a new element: at pixel `at`, or under the pointer.

        While the pointer is not over the picture, the place is on top of the selected shape or, if that is not bounded
        or too small in the picture, in the middle of the picture. None, and a message, if textures cannot be read.
        """
        session, element = self.session, self.session.state.element
        (x, y), (width, height) = at or session.window.pointer, session.screen.size
        is_elsewhere = (x, y) == (0, 0) or not self.inside or not session.screen.shows_picture_at(x, y)
        if is_elsewhere and not at:
            if isinstance(element, Shape) and element.bounds() and (top := aim_at_top(session.view, element)):
                return top
            x, y = width // 2, int((NEARER if session.screen.tool_at(x, y) else AHEAD) * height)
        try:
            hit = session.surface_at(x, y)
        except MiniRTError as error:
            session.show_error(error)
            return None
        return aim(session.view, session.state.size, x + PIXEL_CENTRE, y + PIXEL_CENTRE, *hit)
