"""A scene in the arrays that the kernel reads."""

from __future__ import annotations

from typing import Any, NamedTuple


class Traced(NamedTuple):
    """What a frame is made from; m lamps and n shapes, the shapes numbered from 0 in the order of the file."""

    camera: Any  # (12,) eye, right, up, forward; right and up reach from the middle of the picture, at 1, to its edges
    ambient: Any  # (3,) light, red green blue
    lights: Any  # (m, 6) place and light of each lamp
    colours: Any  # (n, 3) of each shape, red green blue in [0, 1]
    extents: Any  # (n,) largest coordinate of each shape
    places: Any  # (n, 2) where each shape is: its group and its row there
    groups: Any  # a tuple: for each kind of shape that the scene has, an array with a row for each of them
