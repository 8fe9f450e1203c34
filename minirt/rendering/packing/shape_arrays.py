"""Shapes of a scene as structure of arrays (SoA), of which an edit rewrites only what it changes. Where it adds or
removes shapes those of the same page are written, and the others are copied.

Primitives are what rays are tested against: one for most shapes, and one for each triangle of a mesh.
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Sequence
from copy import copy
from functools import cached_property
from itertools import accumulate, chain
from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.kernel.projection import MARGIN
from minirt.kernel.scene_arrays import KIND, PRIMITIVE, ROW, SHAPE, TRIANGLE_ROW, row_type
from minirt.rendering.packing.features import examined
from minirt.rendering.packing.packed_shapes import bounding_balls, column, morton_order, pack_shapes, spans
from minirt.rendering.packing.runs import common, differing_shapes, groups_of, joined
from minirt.shapes import ALL_KINDS, MESH, Shape
from minirt.shapes.mesh import Mesh

FIRST = np.arange(1)  # index of the first primitive
CROWD = 50_000  # shapes, beyond which lists number them in the order of Morton's curve


class ShapeArrays:
    """The s shapes that it was given last, and their n primitives: a mesh has one for each triangle, others have one.

    Arrays "by shape" go by the index in `shapes`. Arrays "by place" go by the numbers of shapes in lists for culling,
    which are ordered by where shapes are if there are many. Each kind of shape has a group.
    """

    runs: tuple[Sequence[Shape], ...]  # the shapes
    updates: int  # how often these arrays were brought up to date
    group_numbers: dict[type[Shape], int]
    is_plane: np.ndarray  # (groups,) whether the shapes of a group are infinite planes
    tables: tuple[np.ndarray, ...]  # of each group: the rows of its shapes, of triangles for meshes

    owner: np.ndarray  # (n,) the index of each primitive's shape
    slots: np.ndarray  # (n, 2) the group of each primitive, and its row in the table of that
    colours_and_extents: np.ndarray  # (n, 4) as in `minirt.kernel.scene_arrays`; triangles of meshes have no extent
    plane_indices: np.ndarray  # (p,) the primitives that are infinite planes
    planes: np.ndarray  # (p, 5) of these: unit normal, its product with the plane's points, the rounding error of that
    plane_places: np.ndarray  # (p,) their places

    first_primitive: np.ndarray  # (s + 1,) by shape
    boxes: np.ndarray  # (s, 2, 3) by shape: corners of a box around it; of an infinite one, around its defining points
    places: np.ndarray  # (s,) by shape: its place

    written: np.ndarray  # (s,) by place: the number of the last of all `updates` that wrote the shape
    listed: np.ndarray  # (s, 4) by place: as in `minirt.kernel.scene_arrays`
    first_ball: np.ndarray  # (s + 1,) by place: the hull of `balls[first_ball[i] : first_ball[i + 1]]` has the shape
    balls: np.ndarray  # (b, 4) centre, and radius, grown by what rounding may do to the shape

    def __init__(self) -> None:
        self.allocate()
        self.arrange(FIRST[:0])

    def update(self, *runs: Sequence[Shape]) -> bool:
        """Bring the arrays up to date with shapes, run by run; return whether anything changed."""
        if runs == self.runs:
            return False
        before = copy(self)
        self.runs = runs
        has_same_lengths = [*map(len, runs)] == [*map(len, before.runs)]
        changed = [*differing_shapes(before.runs, runs)] if has_same_lengths else []
        fits = has_same_lengths and all(
            type(a) is type(b) and getattr(a, "triangles", a) is getattr(b, "triangles", a) for _, a, b in changed
        )
        for name in ("shapes", "rows"):
            vars(self).pop(name, None)
        if fits:
            indices = np.array([index for index, _, _ in changed], np.int64)
            parts: Any = [(indices, [shape for _, _, shape in changed])]
        else:
            self.allocate(*runs)
            first, last = self.take_ends(before)
            parts = joined(runs[first:last], sum(map(len, runs[:first])))
        self.updates += 1
        for indices, members in parts:
            groups = self.slots[self.first_primitive[indices], KIND]
            for group in set(groups.tolist()):
                at = np.flatnonzero(groups == group)
                self.write(group, indices[at], members if len(at) == len(members) else [members[i] for i in at])
        if not fits:
            self.arrange(morton_order(self.boxes) if len(self.boxes) > CROWD else np.arange(len(self.boxes)))
        return True

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        return tuple(chain.from_iterable(self.runs))

    def shape(self, index: int) -> Shape:
        """Return the shape with an index, without making the elements of other crowds."""
        starts = [*accumulate(map(len, self.runs), initial=0)]
        run = bisect(starts, index) - 1
        shape: Shape = self.runs[run][index - starts[run]]
        return shape

    def allocate(self, *runs: Sequence[Shape]) -> None:
        """Allocate all arrays for these shapes, without writing them; shapes have places in the order of their indices.

        `arrange` makes `listed` and `plane_places`.
        """
        self.runs, self.updates = runs, 0
        present: Any = {type(each): each for run in runs for each in examined(run)}
        used = [kind for kind in ALL_KINDS if kind.element in present]
        examples = [present[kind.element].some(FIRST) for kind in used]  # a shape of each group
        self.group_numbers = {kind.element: group for group, kind in enumerate(used)}
        self.is_plane = np.array([each.infinite_plane() is not None for each in examples], bool)
        groups_of_shapes = groups_of(runs, self.group_numbers)
        sizes = np.ones(len(groups_of_shapes), np.int64)  # primitives of each shape
        if Mesh in present:
            sizes[:] = [shape.parts for shape in self.shapes]
        groups = np.repeat(groups_of_shapes, sizes)  # of each primitive
        count, counts = len(groups), np.bincount(groups, minlength=len(used))
        self.owner = np.repeat(np.arange(len(sizes)), sizes)
        self.first_primitive = np.concatenate([[0], np.cumsum(sizes)])
        self.tables = tuple(
            np.zeros(counts[group], TRIANGLE_ROW if kind is MESH else row_type(kind)) for group, kind in enumerate(used)
        )
        self.tints: dict[int, Triple] = {}  # by the indices of meshes: the colours that are written for them
        self.of_looks: dict[str, tuple[np.ndarray, np.ndarray]] = {}  # see `looks.by_primitive`
        self.triangles: Any = None  # of meshes, see `minirt.rendering.packing.mesh_trees.place_meshes`
        self.placed: dict[int, Shape] = {}  # the meshes of these triangles, by their numbers
        self.slots = np.stack([groups, np.zeros(count, np.int64)], axis=1)
        for group in range(len(used)):
            self.slots[groups == group, ROW] = np.arange(counts[group])
        self.plane_indices = np.flatnonzero(self.is_plane[groups])
        ball_counts = np.array([bounding_balls([each]).shape[1] for each in examples], np.int64)
        self.first_ball = np.concatenate([[0], np.cumsum(ball_counts[groups_of_shapes])])
        self.colours_and_extents, self.boxes = np.zeros((count, 4)), np.zeros((len(sizes), 2, 3))
        self.written = np.zeros(len(sizes), np.int32)
        self.planes, self.balls = np.zeros((len(self.plane_indices), 5)), np.zeros((self.first_ball[-1], 4))
        self.places = np.arange(len(sizes))

    def arrange(self, order: np.ndarray) -> None:
        """Number the shapes in lists, their balls and the rows of their tables, but not triangles, in an order (s,)."""
        at, first = self.balls_of(order), self.first_primitive[order]
        self.first_ball, self.balls = np.append(0, np.cumsum(np.diff(self.first_ball)[order])), self.balls[at]
        for kind, group in self.group_numbers.items():
            if kind is not Mesh:
                members = first[self.slots[first, KIND] == group]
                rows = self.tables[group].view(np.float64).reshape(len(members), -1)  # copied in half of the time
                rows[:] = rows[self.slots[members, ROW]]
                self.slots[members, ROW] = np.arange(len(members))
        self.listed, self.places = np.empty((len(order), 4), np.int32), np.empty(len(order), np.int32)
        self.listed[:, KIND : ROW + 1], self.listed[:, PRIMITIVE] = self.slots[first], first
        self.listed[:, SHAPE] = order
        self.places[order] = np.arange(len(order))
        self.plane_places = self.places[self.owner[self.plane_indices]]

    def balls_of(self, shapes: np.ndarray) -> np.ndarray:
        """Return the indices of the balls of some shapes."""
        starts = self.first_ball[self.places[shapes]]
        counts = self.first_ball[self.places[shapes] + 1] - starts
        return np.repeat(starts + counts - np.cumsum(counts), counts) + np.arange(counts.sum())

    def primitives_of(self, group: int) -> np.ndarray:
        """Return the indices of the primitives of a group in the order of its rows."""
        members = np.flatnonzero(self.slots[:, KIND] == group)
        return members[np.argsort(self.slots[members, ROW])]

    def take_ends(self, before: ShapeArrays) -> tuple[int, int]:
        """Copy the rows of the first and the last runs that other arrays have, too; return the number of the first run
        without a copy, and of the one behind the last."""
        first = common(self.runs, before.runs)
        last = len(self.runs) - common(self.runs[first:][::-1], before.runs[first:][::-1])
        ends = [sum(map(len, self.runs[:number])) for number in (first, last)]
        primitives = self.first_primitive[ends]
        balls = before.balls[before.balls_of(np.arange(len(before.boxes)))]
        # Arrays to write, the same ones as they were, and the rows between which nothing is copied.
        pairs: list[Any] = [(self.boxes, before.boxes, ends), (self.balls, balls, self.first_ball[ends])]
        pairs.append((self.colours_and_extents, before.colours_and_extents, primitives))
        pairs.append((self.planes, before.planes, np.searchsorted(self.plane_indices, primitives)))
        for kind, group in self.group_numbers.items():
            if kind in before.group_numbers:
                counts = np.cumsum(np.append(0, self.slots[:, KIND] == group))[primitives]
                number = before.group_numbers[kind]
                rows = before.tables[number][before.slots[before.slots[:, KIND] == number, ROW]]
                pairs.append((self.tables[group], rows, counts))
        for into, rows, (start, stop) in pairs:
            into[:start], into[stop:] = rows[:start], rows[len(rows) - len(into) + stop :]
        return first, last

    def smooth(self) -> np.ndarray:
        """Return 1 for each primitive of a smooth shape, 0 for all others, (n,)."""
        return np.array([shape.smooth for shape in self.shapes], np.int64)[self.owner]

    def write(self, group: int, shapes: np.ndarray, members: Sequence[Shape]) -> None:
        """Write `members`, m shapes of one group with the indices `shapes`, (m,), into the arrays.

        `owner`, `slots` and places are there.
        """
        indices, places = self.first_primitive[shapes], self.places[shapes]
        self.written[places] = self.updates
        rows, boxes, balls = pack_shapes(members)
        low, high, extents = spans(boxes)
        self.boxes[shapes, 0], self.boxes[shapes, 1] = low.T, high.T
        if group == self.group_numbers.get(Mesh):
            for index, mesh in zip(shapes.tolist(), members, strict=True):
                self.tint(index, mesh)
        else:
            self.tables[group].view(np.float64).reshape(len(self.tables[group]), -1)[self.slots[indices, ROW]] = rows
            self.colours_and_extents[indices, :3] = column(members, "colour", 3) / 255
            self.colours_and_extents[indices, 3] = extents
        if self.is_plane[group]:
            points_and_normals = np.array([shape.infinite_plane() for shape in members])
            at = np.searchsorted(self.plane_indices, indices)
            self.planes[at, :3] = points_and_normals[:, 1]
            self.planes[at, 3] = (points_and_normals[:, 0] * points_and_normals[:, 1]).sum(axis=1)
            self.planes[at, 4] = MARGIN * extents  # as the largest coordinate of a plane bounds its rounding
        else:
            x, y, z, radius = np.abs(np.moveaxis(balls, 2, 0))  # each (m, balls of a shape)
            balls[..., 3] += MARGIN * (radius + np.maximum(np.maximum(x, y), z))
            self.balls[self.first_ball[places, None] + np.arange(balls.shape[1])] = balls

    def tint(self, index: int, mesh: Any) -> None:
        """Write the colours of the triangles of a mesh, unless they are there."""
        if self.tints.get(index) != mesh.colour:
            self.colours_and_extents[slice(*self.first_primitive[index : index + 2]), :3] = mesh.colours()
            self.tints[index] = mesh.colour

    @cached_property
    def rows(self) -> tuple[np.ndarray, ...]:
        """The rows of all groups, those of meshes with the numbers of each triangle, made when they are asked for."""
        meshes = (shape.rows() for shape in self.shapes if isinstance(shape, Mesh))
        return tuple(
            np.concatenate([*meshes]).view(row_type(MESH))[:, 0] if kind is Mesh else table
            for kind, table in zip(self.group_numbers, self.tables, strict=True)
        )

    def primitive_boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the `boxes` of all primitives, (n, 2, 3), and their extents, (n,)."""
        boxes, extents = self.boxes[self.owner], self.colours_and_extents[:, 3].copy()
        if Mesh in self.group_numbers:
            group = self.group_numbers[Mesh]
            at, numbers = self.slots[:, KIND] == group, self.rows[group].view(np.float64).reshape(-1, 27)
            low, high, extents[at] = spans(numbers[:, :9].reshape(-1, 3, 3))
            boxes[at, 0], boxes[at, 1] = low.T, high.T
        return boxes, extents
