"""Shapes as structure of arrays: differences are found, and an edit writes only the shapes that it changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from minirt.rendering.packing import shape_arrays
from minirt.rendering.packing.shape_arrays import ShapeArrays, differing_indices, extents_from
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import SHAPES

MANY = tuple(Sphere((i, 2.0 * i, 3), 1 + i, (i % 256, 0, 0)) for i in range(3 * shape_arrays.CHUNK))


@pytest.mark.parametrize("indices", [(), (0,), (shape_arrays.CHUNK,), (7, shape_arrays.CHUNK - 1, len(MANY) - 1)])
def test_differing_shapes_are_found(indices: tuple[int, ...]) -> None:
    new = list(MANY)
    for index in indices:
        new[index] = replace(new[index], diameter=9e9)
    assert differing_indices(MANY, tuple(new)) == list(indices)


def test_many_shapes_have_the_numbers_of_each() -> None:
    mixed = [shape.replace(colour=(i % 256, 7, 9)) for i, shape in enumerate(SHAPES * 5)]
    arrays = ShapeArrays()
    assert arrays.update(tuple(mixed))
    for i, shape in enumerate(mixed):
        kind, number = arrays.slots[i]
        packed = [c for part in shape.pack() for c in ((part.x, part.y, part.z) if hasattr(part, "x") else (part,))]
        assert np.hstack([np.ravel(part) for part in arrays.rows[kind][number]]).tolist() == packed
        assert arrays.colours_and_extents[i, :3].tolist() == [c / 255 for c in shape.colour]
        balls = arrays.balls[arrays.first_ball[i] : arrays.first_ball[i + 1]]
        assert balls[:, :3].tolist() == [list(centre) for centre, _ in shape.balls()]
        for ball, (centre, radius) in zip(balls, shape.balls(), strict=True):
            assert radius + 1e-13 * max(map(abs, centre)) < ball[3] < radius + 1e-11 * (radius + max(map(abs, centre)))
    assert [mixed[i] for i in arrays.plane_indices] == [shape for shape in mixed if isinstance(shape, Plane)]
    assert [arrays.planes[i, :3].tolist() for i in range(10)] == [list(mixed[i].normal) for i in arrays.plane_indices]
    assert not arrays.update(arrays.shapes)
    assert not arrays.update((*mixed,))


@pytest.mark.parametrize(
    "edit",
    [
        lambda s: (*s, s[0].replace(colour=(1, 1, 1))),
        lambda s: (s[1].replace(colour=(1, 1, 1)), *s),
        lambda s: (*s[:9], *s[10:]),
        lambda s: s[3:],
        lambda s: s[:-4],
        lambda s: (*s[:5], *SHAPES, *s[7:]),
        lambda s: (*s[:5], s[6], s[5], *s[7:]),
    ],
)
def test_adding_and_removing_shapes_leaves_the_numbers_of_the_others(edit, monkeypatch) -> None:
    before = tuple(shape.replace(colour=(i % 256, 7, 9)) for i, shape in enumerate(SHAPES * 5))
    after = edit(before)
    arrays, fresh = ShapeArrays(), ShapeArrays()
    arrays.update(before)
    fresh.update(after)
    written = []
    write = arrays.write
    monkeypatch.setattr(arrays, "write", lambda group, indices: (written.extend(indices), write(group, indices)))
    assert arrays.update(after)
    assert len(written) <= len(SHAPES)
    for name in ("slots", "colours_and_extents", "boxes", "first_ball", "balls", "plane_indices", "planes"):
        assert np.array_equal(getattr(arrays, name), getattr(fresh, name)), name
    for kept_rows, fresh_rows in zip(arrays.rows, fresh.rows, strict=True):
        assert np.array_equal(kept_rows, fresh_rows)
    assert arrays.shapes == after


def test_adding_or_removing_a_kind_allocates_all_arrays_anew() -> None:
    arrays = ShapeArrays()
    for shapes in (MANY[:3], SHAPES, MANY[:2], (), SHAPES):
        assert arrays.update(tuple(shapes))
        assert [len(rows) for rows in arrays.rows] == [
            sum(type(each) is kind for each in shapes) for kind in arrays.group_numbers
        ]
        assert sum(map(len, arrays.rows)) == len(shapes)
        assert arrays.first_primitive.tolist() == [*range(len(shapes) + 1)]
        assert (len(arrays.first_ball), arrays.first_ball[-1]) == (len(shapes) + 1, len(arrays.balls))


def test_extents_and_boxes_of_several_shapes() -> None:
    shapes = [Cylinder((1, -7, 3), (0, 1, 0), 4, 6, (0, 0, 0)), Cylinder((1, -7, 3), (1, 0, 0), 4, 40, (0, 0, 0))]
    arrays = ShapeArrays()
    arrays.update(tuple(shapes))
    assert arrays.colours_and_extents[:, 3].tolist() == [10, 21]
    assert arrays.boxes.tolist() == [[[-1, -10, 1], [3, -4, 5]], [[-19, -9, 1], [21, -5, 5]]]
    assert extents_from(np.array([1.0, -7.0, 0.0]), arrays.boxes).tolist() == [6, 23]
