"""The shapes of a scene as arrays; an edit writes anew only what it changed."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel.culling.binning import MARGIN
from minirt.kernel.rows import row_type
from minirt.rendering.packing.primitives import bounding_balls, primitives_of
from minirt.shapes import ALL_KINDS, Shape

CHUNK = 4096  # shapes that are compared or written at once: their Python objects come and go in the processor's cache
FIRST = np.arange(1)


class ShapeArrays:
    """The last shapes that it was told of, n of them, those of each kind in rows of their own. A mesh counts for as
    many as it has parts: what is said of shapes in these arrays is said of the parts, of which `owner` (n,) tells the
    index in `shapes`, and `start` the first of each of those.

    `rows`, `looks` and `places` are those of `minirt.kernel.scene_arrays`; `boxes`, (n, 4), are the middle of the box around
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
        changed = [] if others else differing_indices(self.shapes, shapes)
        if others or not all(same_size(self.shapes[i], shapes[i]) for i in changed):
            others, changed = True, self.make_room(shapes)
        self.shapes = shapes
        indices = np.array(changed, np.int64)
        groups = self.slots[self.start[indices], 0]
        for group in range(len(self.rows)):
            mine = indices[groups == group]
            parts = np.sum(self.start[mine + 1] - self.start[mine])
            step = max(1, CHUNK * len(mine) // max(1, parts))
            for start in range(0, len(mine), step):
                self.write(group, mine[start : start + step])
        return others or bool(changed)

    def make_room(self, shapes: tuple[Shape, ...]) -> list[int]:
        """Room for other shapes; what stays in the same order keeps its numbers. Returns the indices of the others."""
        start, behind = common_ends(self.shapes, shapes)
        new = shapes[start : len(shapes) - behind]
        gone = len(self.shapes) - behind
        if len(new) <= CHUNK and all(type(shape) in self.numbers for shape in new):
            kept = np.delete(self.slots[:, 0], slice(self.start[start], self.start[gone]))
            if set(np.unique(kept)) | {self.numbers[type(shape)] for shape in new} == set(self.numbers.values()):
                self.splice(start, gone, new)
                return list(range(start, start + len(new)))
        self.lay_out(shapes)
        return list(range(len(shapes)))

    def lay_out(self, shapes: tuple[Shape, ...]) -> None:
        """Make room for as many shapes of the same kinds."""
        kinds = [type(shape) for shape in shapes]
        present = set(kinds)
        used = [kind for kind in ALL_KINDS if kind.element in present]
        examples = [shapes[kinds.index(kind.element)].some(FIRST) for kind in used]
        self.numbers = {kind.element: group for group, kind in enumerate(used)}
        self.rows = tuple(np.zeros(0, row_type(kind)) for kind in used)
        self.is_flat = np.array([each.flat() is not None for each in examples], bool)
        self.counts = np.array([bounding_balls([each]).shape[1] for each in examples], np.int64)
        self.slots, self.start, self.owner = np.zeros((0, 2), np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64)
        self.colours_and_extents, self.boxes = np.zeros((0, 4)), np.zeros((0, 4))
        self.planes, self.balls, self.first = np.zeros((0, 5)), np.zeros((0, 4)), np.zeros(1, np.int64)
        self.splice(0, 0, shapes)
        self.shapes = shapes

    def splice(self, start: int, gone: int, shapes: tuple[Shape, ...]) -> None:
        """Let shapes take the places of those from index `start` to `gone`."""
        sizes = np.fromiter((shape.parts for shape in shapes), np.int64, len(shapes))
        numbers = np.fromiter((self.numbers[type(shape)] for shape in shapes), np.int64, len(shapes))
        new = np.repeat(numbers, sizes)
        sizes = np.concatenate([np.diff(self.start[: start + 1]), sizes, np.diff(self.start[gone:])])
        begin, end = self.start[start], self.start[gone]
        before, behind = self.slots[:begin, 0], self.slots[:end, 0]
        groups = np.concatenate([before, new, self.slots[end:, 0]])
        self.rows = tuple(
            spliced(rows, np.sum(before == group), np.sum(behind == group), np.sum(new == group))
            for group, rows in enumerate(self.rows)
        )
        flat = [np.sum(self.is_flat[part]) for part in (before, behind, new)]
        self.planes = spliced(self.planes, *flat)
        self.balls = spliced(self.balls, self.first[begin], self.first[end], self.counts[new].sum())
        self.colours_and_extents = spliced(self.colours_and_extents, begin, end, len(new))
        self.boxes = spliced(self.boxes, begin, end, len(new))
        self.slots = np.zeros((len(groups), 2), np.int64)
        self.slots[:, 0] = groups
        for group, rows in enumerate(self.rows):
            self.slots[groups == group, 1] = np.arange(len(rows))
        self.flat = np.flatnonzero(self.is_flat[groups])
        self.first = np.concatenate([[0], np.cumsum(self.counts[groups])])
        self.start = np.concatenate([[0], np.cumsum(sizes)])
        self.owner = np.repeat(np.arange(len(sizes)), sizes)

    def write(self, group: int, shapes: np.ndarray) -> None:
        """Put some shapes of one kind, of these indices, into the arrays."""
        members = [self.shapes[index] for index in shapes.tolist()]
        parts = primitives_of(members)
        sizes = self.start[shapes + 1] - self.start[shapes]
        indices = np.repeat(self.start[shapes] - np.cumsum(sizes) + sizes, sizes) + np.arange(len(parts.rows))
        rows = self.rows[group].view(np.float64).reshape(len(self.rows[group]), -1)
        rows[self.slots[indices, 1]] = parts.rows
        corners = np.ascontiguousarray(np.moveaxis(parts.boxes, 0, 2))  # (2, 3, n), an eighth of the time to reduce
        low, high = corners.min(axis=0), corners.max(axis=0)
        extents = np.maximum(np.abs(low), np.abs(high)).max(axis=0)
        self.colours_and_extents[indices, :3] = np.repeat([shape.colour for shape in members], sizes, axis=0) / 255
        self.colours_and_extents[indices, 3] = extents
        self.boxes[indices, :3] = corners.mean(axis=0).T
        self.boxes[indices, 3] = (high - low).max(axis=0) / 2
        if self.is_flat[group]:
            flats = np.array([shape.flat() for shape in members])
            at = np.searchsorted(self.flat, indices)
            self.planes[at, :3] = flats[:, 1]
            self.planes[at, 3] = (flats[:, 0] * flats[:, 1]).sum(axis=1)
            self.planes[at, 4] = MARGIN * extents
        else:
            balls = parts.balls
            x, y, z, radius = np.abs(np.moveaxis(balls, 2, 0))
            balls[..., 3] += MARGIN * (radius + np.maximum(np.maximum(x, y), z))
            at = self.first[indices, None] + np.arange(balls.shape[1])
            self.balls[at.ravel()] = balls.reshape(-1, 4)


def same_size(old: Shape, new: Shape) -> bool:
    """Whether a shape has room where another was."""
    return type(old) is type(new) and old.parts == new.parts


def differing_indices(old: tuple[Any, ...], new: tuple[Any, ...], most: float = inf) -> list[int]:
    """Where two tuples hold different objects that are not equal either, as far as the shorter one goes; from `most`
    such places on the rest is not looked at."""
    found: list[int] = []
    for start in range(0, min(len(old), len(new)), CHUNK):
        one, other = old[start : start + CHUNK], new[start : start + CHUNK]
        if one != other:  # the same objects are equal at the speed of C
            found += [at for at, (a, b) in enumerate(zip(one, other, strict=False), start) if a is not b]
            if len(found) >= most:
                break
    return found


def common_ends(old: tuple[Any, ...], new: tuple[Any, ...]) -> tuple[int, int]:
    """How many entries two tuples share at their beginning, and how many of the rest at their end."""
    shorter = min(len(old), len(new))
    front = next(iter(differing_indices(old, new, most=1)), shorter)
    back = next(iter(differing_indices(old[front:][::-1], new[front:][::-1], most=1)), shorter - front)
    return front, back


def spliced(array: np.ndarray, start: int, end: int, count: int) -> np.ndarray:
    """The array with so many rows of zeros in the place of those from `start` to `end`."""
    return np.concatenate([array[:start], np.zeros((count, *array.shape[1:]), array.dtype), array[end:]])
