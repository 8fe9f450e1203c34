"""Menu of a right click: what can be done with the element under the pointer, and with the point there."""

from __future__ import annotations

from collections.abc import Iterator

from minirt.fields import Triple
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.editing.colours import SECOND_COLOUR, colour_value, colours_of
from minirt.viewer.editing.state import State

OPEN_MENU = "open menu"  # the action that opens the list of what can be done
MENU = {  # its rows: actions, and what they are called there
    "add": "add here >",
    "choose colour": "colour >",
    SECOND_COLOUR: "second colour >",
    "add attribute": "material or attribute >",
    "duplicate": "duplicate",
    "delete": "delete",
    "drop": "drop onto what lies beneath",
    "look at": "bring into view; again: all",
    "look through": "look through",
    "focus": "focus here",
    "explain pixel": "explain this pixel",
    "toggle panel": "panel: values, picture, film",
    "undo": "undo",
    "redo": "redo",
}


def menu_of(state: State, point: Triple | None) -> Iterator[str]:
    """Yield the actions of MENU that make sense for the selected element, in this order.

    `point`: of the scene, under the pointer; None where the picture shows the background.
    """
    element = state.element
    makes_no_sense = {  # actions that are not here always make sense
        "choose colour": colour_value(element) is None,
        SECOND_COLOUR: len(colours_of(element)) < 2,
        "delete": element.required,
        "drop": not isinstance(element, Shape) or element.infinite,
        "look through": not isinstance(element, Camera) or element is state.scene.camera,
        "focus": point is None,
        "toggle panel": not isinstance(element, Camera),  # which is selected where nothing else is
        "undo": not state.undo_stack,
        "redo": not state.redo_stack,
    }
    for action in MENU:
        if not makes_no_sense.get(action):
            yield action
