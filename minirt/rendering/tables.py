"""The shapes of a scene as arrays; an edit writes anew only what it changed."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel.lists import MARGIN
from minirt.kernel.rows import row_type
from minirt.lanes import Vec
from minirt.shapes import KINDS, Ball, Shape

PIECE = 4096  # shapes that are compared or written at once: their Python objects come and go in the processor's cache
EVERYWHERE: tuple[Ball, ...] = (((0.0, 0.0, 0.0), np.inf),)  # where a shape lies that has no end and is no plane


class Tables:
    """The last shapes that it was told of, n of them, those of each kind in rows of their own.

    `rows`, `looks` and `places` are those of `minirt.kernel.traced`; `boxes`, (n, 4), are the middle of the box around
    each shape and half of its longest edge, or the same of the points of one without end. Shape i lies in the hull of
    `balls[first[i]:first[i + 1]]`, (b, 4) centre and radius, grown by what rounding may do to it; or it is one of the
    `planes`, (p, 5) unit normal, its product with the points of the plane and by how much rounding may change that,
    whose indices are `flat`.
    """

    shapes: tuple[Shape, ...]

    def __init__(self) -> None:
        self.lay_out(())

    def update(self, shapes: tuple[Shape, ...]) -> bool:
        """Bring the arrays up to date; whether anything changed."""
        if shapes is self.shapes:
            return False
        changed = differing(self.shapes, shapes)
        if len(shapes) != len(self.shapes) or any(type(shapes[i]) is not type(self.shapes[i]) for i in changed):
            self.lay_out(shapes)
            changed = list(range(len(shapes)))
        self.shapes = shapes
        indices = np.array(changed, np.int64)
        for group in range(len(self.rows)):
            mine = indices[self.places[indices, 0] == group]
            for start in range(0, len(mine), PIECE):
                self.write(group, mine[start : start + PIECE])
        return bool(changed)

    def lay_out(self, shapes: tuple[Shape, ...]) -> None:
        """Make room for as many shapes of the same kinds."""
        kinds = [type(shape) for shape in shapes]
        present = set(kinds)
        used = [kind for kind in KINDS if kind.element in present]
        number = {kind.element: group for group, kind in enumerate(used)}
        groups = np.fromiter((number[kind] for kind in kinds), np.int64, len(kinds))
        examples = [shapes[kinds.index(kind.element)] for kind in used]
        members = [np.flatnonzero(groups == group) for group in range(len(used))]
        self.rows = tuple(np.zeros(len(mine), row_type(kind)) for kind, mine in zip(used, members, strict=True))
        self.places = np.zeros((len(kinds), 2), np.int64)
        self.places[:, 0] = groups
        for mine in members:
            self.places[mine, 1] = np.arange(len(mine))
        self.looks = np.zeros((len(kinds), 4))
        self.boxes = np.zeros((len(kinds), 4))
        self.flat = np.flatnonzero(np.array([each.flat() is not None for each in examples], bool)[groups])
        self.planes = np.zeros((len(self.flat), 5))
        counts = np.array([0 if each.flat() else len(each.balls() or EVERYWHERE) for each in examples], np.int64)
        self.first = np.concatenate([[0], np.cumsum(counts[groups])])
        self.balls = np.zeros((self.first[-1], 4))
        self.shapes = shapes

    def write(self, group: int, indices: np.ndarray) -> None:
        """Put some shapes of one kind into the arrays."""
        members = [self.shapes[index] for index in indices.tolist()]
        rows = self.rows[group].view(np.float64).reshape(len(self.rows[group]), -1)
        rows[self.places[indices, 1]] = numbers([shape.pack() for shape in members])
        corners = boxes(members)
        extents = np.abs(corners).max(axis=(1, 2))
        self.looks[indices, :3] = np.array([shape.colour for shape in members]) / 255
        self.looks[indices, 3] = extents
        self.boxes[indices, :3] = corners.mean(axis=1)
        self.boxes[indices, 3] = (corners.max(axis=1) - corners.min(axis=1)).max(axis=1) / 2
        if members[0].flat():
            flats = np.array([shape.flat() for shape in members])
            at = np.searchsorted(self.flat, indices)
            self.planes[at, :3] = flats[:, 1]
            self.planes[at, 3] = (flats[:, 0] * flats[:, 1]).sum(axis=1)
            self.planes[at, 4] = MARGIN * extents
        else:
            balls = np.array([(*centre, radius) for each in members for centre, radius in each.balls() or EVERYWHERE])
            balls[:, 3] += MARGIN * (balls[:, 3] + np.abs(balls[:, :3]).max(axis=1))
            count = len(balls) // len(members)
            self.balls[(self.first[indices, None] + np.arange(count)).ravel()] = balls


def differing(old: tuple[Any, ...], new: tuple[Any, ...]) -> list[int]:
    """Where two tuples hold different objects that are not equal either, as far as the shorter one goes."""
    found: list[int] = []
    for start in range(0, min(len(old), len(new)), PIECE):
        one, other = old[start : start + PIECE], new[start : start + PIECE]
        if one != other:  # the same objects are equal at the speed of C
            found += [at for at, (a, b) in enumerate(zip(one, other, strict=False), start) if a is not b]
    return found


def numbers(packed: list[Any]) -> np.ndarray:
    """Packed shapes of a kind, a row each."""
    columns: list[Any] = []
    for parts in zip(*packed, strict=True):
        if isinstance(parts[0], Vec):
            columns += [[v.x for v in parts], [v.y for v in parts], [v.z for v in parts]]
        else:
            columns.append(parts)
    return np.array(columns).T


def boxes(shapes: list[Shape]) -> np.ndarray:
    """For each shape of a kind the corners of the box around it, (n, 2, 3); of one without end, its points."""
    return np.array([shape.bounds() or own_points(shape) for shape in shapes])


def extent(shape: Shape) -> float:
    """The largest coordinate of a shape; of one without end, the largest of its points."""
    return float(np.abs(boxes([shape])).max())


def own_points(shape: Shape) -> list[Any]:
    """The points that a shape is given by."""
    return [getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)]
