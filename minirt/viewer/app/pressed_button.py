"""The mouse button that is down, and the drag that it may have become."""

from __future__ import annotations

from typing import NamedTuple

from minirt.viewer.editing import dragging
from minirt.viewer.input.bindings import Binding


class PressedButton(NamedTuple):
    """A mouse button that is down on the picture."""

    button: int
    x: int  # pixel where it was pressed
    y: int
    drag: Binding  # its row in the table
    grip: dragging.DragStart
    dragging: bool = False  # whether the pointer has moved far enough since
