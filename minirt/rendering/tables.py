"""The shapes of a scene as arrays; an edit writes anew only what it changed."""

from __future__ import annotations

from math import inf
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
        others = len(shapes) != len(self.shapes)
        changed = [] if others else differing(self.shapes, shapes)
        if others or any(type(shapes[i]) is not type(self.shapes[i]) for i in changed):
            others, changed = True, self.make_room(shapes)
        self.shapes = shapes
        indices = np.array(changed, np.int64)
        for group in range(len(self.rows)):
            mine = indices[self.places[indices, 0] == group]
            for start in range(0, len(mine), PIECE):
                self.write(group, mine[start : start + PIECE])
        return others or bool(changed)

    def make_room(self, shapes: tuple[Shape, ...]) -> list[int]:
        """Room for other shapes; what stays in the same order keeps its numbers. Returns the indices of the others."""
        start, behind = alike(self.shapes, shapes)
        new = shapes[start : len(shapes) - behind]
        gone = len(self.shapes) - behind
        groups = self.places[:, 0]
        if len(new) <= PIECE and all(type(shape) in self.numbers for shape in new):
            middle = np.array([self.numbers[type(shape)] for shape in new], np.int64)
            groups = np.concatenate([groups[:start], middle, groups[gone:]])
            if len(np.unique(groups)) == len(self.numbers):
                self.splice(groups, start, gone, len(new))
                return list(range(start, start + len(new)))
        self.lay_out(shapes)
        return list(range(len(shapes)))

    def lay_out(self, shapes: tuple[Shape, ...]) -> None:
        """Make room for as many shapes of the same kinds."""
        kinds = [type(shape) for shape in shapes]
        present = set(kinds)
        used = [kind for kind in KINDS if kind.element in present]
        examples = [shapes[kinds.index(kind.element)] for kind in used]
        self.numbers = {kind.element: group for group, kind in enumerate(used)}
        self.rows = tuple(np.zeros(0, row_type(kind)) for kind in used)
        self.is_flat = np.array([each.flat() is not None for each in examples], bool)
        self.counts = np.array([0 if each.flat() else len(each.balls() or EVERYWHERE) for each in examples], np.int64)
        self.places = np.zeros((0, 2), np.int64)
        self.looks, self.boxes = np.zeros((0, 4)), np.zeros((0, 4))
        self.planes, self.balls, self.first = np.zeros((0, 5)), np.zeros((0, 4)), np.zeros(1, np.int64)
        self.splice(np.fromiter((self.numbers[kind] for kind in kinds), np.int64, len(kinds)), 0, 0, len(kinds))
        self.shapes = shapes

    def splice(self, groups: np.ndarray, start: int, gone: int, count: int) -> None:
        """Let `count` shapes take the places of those from index `start` to `gone`; `groups` are those of all shapes
        then."""
        before, behind = self.places[:start, 0], self.places[:gone, 0]
        new = groups[start : start + count]
        self.rows = tuple(
            spliced(rows, np.sum(before == group), np.sum(behind == group), np.sum(new == group))
            for group, rows in enumerate(self.rows)
        )
        flat = [np.sum(self.is_flat[part]) for part in (before, behind, new)]
        self.planes = spliced(self.planes, *flat)
        self.balls = spliced(self.balls, self.first[start], self.first[gone], self.counts[new].sum())
        self.looks = spliced(self.looks, start, gone, count)
        self.boxes = spliced(self.boxes, start, gone, count)
        self.places = np.zeros((len(groups), 2), np.int64)
        self.places[:, 0] = groups
        for group, rows in enumerate(self.rows):
            self.places[groups == group, 1] = np.arange(len(rows))
        self.flat = np.flatnonzero(self.is_flat[groups])
        self.first = np.concatenate([[0], np.cumsum(self.counts[groups])])

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


def differing(old: tuple[Any, ...], new: tuple[Any, ...], most: float = inf) -> list[int]:
    """Where two tuples hold different objects that are not equal either, as far as the shorter one goes; from `most`
    such places on the rest is not looked at."""
    found: list[int] = []
    for start in range(0, min(len(old), len(new)), PIECE):
        one, other = old[start : start + PIECE], new[start : start + PIECE]
        if one != other:  # the same objects are equal at the speed of C
            found += [at for at, (a, b) in enumerate(zip(one, other, strict=False), start) if a is not b]
            if len(found) >= most:
                break
    return found


def alike(old: tuple[Any, ...], new: tuple[Any, ...]) -> tuple[int, int]:
    """How many entries two tuples share at their beginning, and how many of the rest at their end."""
    shorter = min(len(old), len(new))
    front = next(iter(differing(old, new, most=1)), shorter)
    back = next(iter(differing(old[front:][::-1], new[front:][::-1], most=1)), shorter - front)
    return front, back


def spliced(array: np.ndarray, start: int, end: int, count: int) -> np.ndarray:
    """The array with so many rows of zeros in the place of those from `start` to `end`."""
    return np.concatenate([array[:start], np.zeros((count, *array.shape[1:]), array.dtype), array[end:]])


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
