"""Shapes of the mouse pointer."""

from enum import Enum


class Cursor(Enum):
    """Shape of the pointer over a window, by the meaning that it has for the user."""

    ARROW = "arrow"  # the usual one
    MOVE = "move"  # something moves with the pointer
    TURN = "turn"  # something turns with the pointer
    GRAB = "grab"  # the picture slides with the pointer
