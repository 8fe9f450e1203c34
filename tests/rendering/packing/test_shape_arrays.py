"""The arrays of shapes: what differs is found, and many shapes at once become the numbers of each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from minirt.rendering.packing import shape_arrays
from minirt.rendering.packing.shape_arrays import ShapeArrays, differing_indices
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import SHAPES

MANY = tuple(Sphere((i, 2.0 * i, 3), 1 + i, (i % 256, 0, 0)) for i in range(3 * shape_arrays.CHUNK))


@pytest.mark.parametrize("places", [(), (0,), (shape_arrays.CHUNK,), (7, shape_arrays.CHUNK - 1, len(MANY) - 1)])
def test_what_differs_is_found(places: tuple[int, ...]) -> None:
    new = list(MANY)
    for place in places:
        new[place] = replace(new[place], diameter=9e9)
    assert differing_indices(MANY, tuple(new)) == list(places)


def test_many_shapes_at_once_are_the_same_numbers_as_each() -> None:
    mixed = [shape.replace(colour=(i % 256, 7, 9)) for i, shape in enumerate(SHAPES * 5)]
    keeper = ShapeArrays()
    assert keeper.update(tuple(mixed))
    for i, shape in enumerate(mixed):
        kind, number = keeper.slots[i]
        packed = [c for part in shape.pack() for c in ((part.x, part.y, part.z) if hasattr(part, "x") else (part,))]
        assert np.hstack([np.ravel(part) for part in keeper.rows[kind][number]]).tolist() == packed
        assert keeper.colours_and_extents[i, :3].tolist() == [c / 255 for c in shape.colour]
        balls = keeper.balls[keeper.first_ball[i] : keeper.first_ball[i + 1]]
        assert balls[:, :3].tolist() == [list(centre) for centre, _ in shape.balls()]
        for ball, (centre, radius) in zip(balls, shape.balls(), strict=True):
            assert radius + 1e-13 * max(map(abs, centre)) < ball[3] < radius + 1e-11 * (radius + max(map(abs, centre)))
    assert [mixed[i] for i in keeper.plane_indices] == [shape for shape in mixed if isinstance(shape, Plane)]
    assert [keeper.planes[i, :3].tolist() for i in range(10)] == [list(mixed[i].normal) for i in keeper.plane_indices]
    assert not keeper.update(keeper.shapes)
    assert not keeper.update((*mixed,))


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
def test_shapes_that_come_and_go_leave_the_numbers_of_the_others(edit, monkeypatch) -> None:
    before = tuple(shape.replace(colour=(i % 256, 7, 9)) for i, shape in enumerate(SHAPES * 5))
    after = edit(before)
    keeper, fresh = ShapeArrays(), ShapeArrays()
    keeper.update(before)
    fresh.update(after)
    written = []
    write = keeper.write
    monkeypatch.setattr(keeper, "write", lambda group, indices: (written.extend(indices), write(group, indices)))
    assert keeper.update(after)
    assert len(written) <= len(SHAPES)
    for name in ("slots", "colours_and_extents", "boxes", "first_ball", "balls", "plane_indices", "planes"):
        assert np.array_equal(getattr(keeper, name), getattr(fresh, name)), name
    for kept, made in zip(keeper.rows, fresh.rows, strict=True):
        assert np.array_equal(kept, made)
    assert keeper.shapes == after


def test_a_kind_that_comes_or_goes_lays_everything_out_anew() -> None:
    keeper = ShapeArrays()
    for shapes in (MANY[:3], SHAPES, MANY[:2], (), SHAPES):
        assert keeper.update(tuple(shapes))
        assert [len(rows) for rows in keeper.rows] == [
            sum(type(each) is kind for each in shapes) for kind in keeper.group_numbers
        ]
        assert sum(map(len, keeper.rows)) == len(shapes)


def test_extents_of_several() -> None:
    shapes = [Cylinder((1, -7, 3), (0, 1, 0), 4, 6, (0, 0, 0)), Cylinder((1, -7, 3), (1, 0, 0), 4, 40, (0, 0, 0))]
    keeper = ShapeArrays()
    keeper.update(tuple(shapes))
    assert keeper.colours_and_extents[:, 3].tolist() == [10, 21]
    assert keeper.boxes.tolist() == [[1, -7, 3, 3], [1, -7, 3, 20]]
