"""A scene in the arrays that the kernel reads."""

from __future__ import annotations

from typing import Any, NamedTuple


class Group(NamedTuple):
    """The shapes of one kind, and which of them may be met in which direction.

    Directions are sorted into cells: those from the eye into the tiles of the picture, those from a lamp into squares
    on the faces of a cube around it. What may be met in cell c is `seen[starts[c]:starts[c + 1]]` of the scene, and for
    lamp i `lit[lamp_starts[i, c]:lamp_starts[i, c + 1]]`.
    """

    rows: Any  # a row a shape
    starts: Any  # (tiles + 1,)
    lamp_starts: Any  # (m, cells + 1)


class Traced(NamedTuple):
    """What a frame is made from; m lamps and n shapes, the shapes numbered from 0 in the order of the file."""

    camera: Any  # (12,) eye, right, up, forward; right and up reach from the middle of the picture, at 1, to its edges
    ambient: Any  # (3,) light, red green blue
    lights: Any  # (m, 6) place and light of each lamp
    colours: Any  # (n, 3) of each shape, red green blue in [0, 1]
    extents: Any  # (n,) largest coordinate of each shape
    places: Any  # (n, 2) where each shape is: its group and its row there
    seen: Any  # the shapes in each tile, the nearest first
    near: Any  # (n,) no point of the shape is nearer to the eye
    grid: int  # cells along an edge of the cubes around the lamps
    lit: Any  # the shapes in each cell of each cube, the nearest first
    lamp_near: Any  # (m, n) no point of the shape is nearer to the lamp
    groups: Any  # a tuple of Group: one for each kind of shape that the scene has
