"""Questions asked of every kind of shape in the registry: its declarations, and properties of its formulas."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from minirt.element import fields_of
from minirt.fields import Colour, Point
from minirt.kernel.scene_arrays import row_type
from minirt.scene.registry import ELEMENTS
from minirt.shapes import KINDS, Kind, Shape
from tests.shapes.examples import example, hits, place, scaled, shadow_offsets
from tests.shapes.execution_modes import MODES, U, kind_of, shape_rows, surfaces
from tests.shapes.regimes import random_directions, unit

SIZES = [(1e-4, 0.0), (1.0, 0.0), (1.0, 1e8), (1e8, 0.0)]


@pytest.fixture(params=KINDS, ids=lambda kind: kind.element.title)
def kind(request: pytest.FixtureRequest) -> Kind:
    return request.param


def test_each_kind_has_names_of_its_own() -> None:
    for name in ("code", "title", "plural"):
        assert len({getattr(kind.element, name) for kind in KINDS}) == len(KINDS)
    assert all(ELEMENTS[kind.element.code] is kind.element for kind in KINDS)


def test_its_element_is_a_record_that_ends_in_its_colour(kind: Kind) -> None:
    assert issubclass(kind.element, Shape)
    assert dataclasses.is_dataclass(kind.element)
    with pytest.raises(dataclasses.FrozenInstanceError):
        object.__new__(kind.element).colour = (0, 0, 0)
    fields = [each for each in fields_of(kind.element) if not each.keyed]
    assert fields[-1].name == "colour"
    assert isinstance(fields[-1], Colour)
    assert any(isinstance(each, Point) for each in fields)
    assert all(each.doc for each in fields)


def test_it_packs_into_a_row_and_back(kind: Kind) -> None:
    shape = example(kind, np.random.default_rng(1))
    packed = shape.pack()
    assert type(packed) is kind.packed
    assert row_type(kind).itemsize == 8 * sum(3 if hasattr(part, "x") else 1 for part in packed)
    (row,) = shape_rows([shape])
    numbers = [c for part in packed for c in ((part.x, part.y, part.z) if hasattr(part, "x") else (part,))]
    assert np.array_equal(np.hstack([np.ravel(part) for part in row.item()]), numbers)
    assert kind_of(shape) is kind


@pytest.mark.parametrize(("size", "offset"), SIZES)
def test_normals_have_unit_length_and_points_of_the_surface_stay(kind: Kind, size: float, offset: float) -> None:
    seen = hits(kind, 1, size, offset)
    normals, points = seen.normals[seen.hit], seen.points[seen.hit]
    assert len(points) > 1000
    assert np.abs(np.linalg.norm(normals, axis=-1) - 1).max() <= 8 * U
    again, _ = surfaces(seen.shapes, seen.points)
    moved = np.linalg.norm(again[seen.hit] - points, axis=-1)
    assert (moved <= shadow_offsets(seen.points, seen.shapes)[seen.hit][:, 0] / 2).all()


@pytest.mark.parametrize(("size", "offset"), SIZES)
def test_its_bounds_contain_its_surface_and_touch_it(kind: Kind, size: float, offset: float) -> None:
    seen = hits(kind, 3, size, offset, shapes=20, rays=1024)
    for shape, points, hit in zip(seen.shapes, seen.points, seen.hit, strict=True):
        box = shape.bounds()
        if box is None:
            continue
        low, high = map(np.array, box)
        slack = 64 * U * (10 * size + offset)
        assert (points[hit] >= low - slack).all()
        assert (points[hit] <= high + slack).all()
        assert (points[hit].max(axis=0) - points[hit].min(axis=0) >= 0.5 * (high - low)).all()


@pytest.mark.parametrize(("size", "offset"), SIZES)
def test_the_hull_of_its_balls_contains_it(kind: Kind, size: float, offset: float) -> None:
    seen = hits(kind, 4, size, offset, shapes=20, rays=1024)
    directions = random_directions(np.random.default_rng(4), 500)
    for shape, points, hit in zip(seen.shapes, seen.points, seen.hit, strict=True):
        balls = shape.balls()
        assert (shape.bounds() is None) == (not balls) == kind.element.infinite
        if balls:  # no point lies farther in any direction than the farthest ball
            reach = np.max([directions @ np.array(centre) + radius for centre, radius in balls], axis=0)
            assert ((points[hit] @ directions.T).max(axis=0) <= reach + 64 * U * (10 * size + offset)).all()
            assert len(balls) == len(seen.shapes[0].balls())


@pytest.mark.parametrize("mode", MODES)
def test_nan_is_a_miss(kind: Kind, mode: str) -> None:
    shape = example(kind, np.random.default_rng(8))
    rays = np.tile(np.array([place(shape) - 5.0, unit(np.ones(3))]), (16, 1, 1))
    for i in range(6):
        rays[i, i // 3, i % 3] = np.nan
    t = MODES[mode]([shape], rays[None, :, 0], rays[None, :, 1])[0]
    assert np.isinf(t[:6]).all()


def test_it_scales_exactly(kind: Kind) -> None:
    random = np.random.default_rng(6)
    shapes = [example(kind, random) for _ in range(20)]
    origins, directions = random.normal(size=(2, 20, 16, 3)) * 5
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    t = MODES["compiled"](shapes, origins, directions)
    for power in (-160, -40, -1, 44):  # from the least length to the greatest
        scale = 2.0**power
        larger = [scaled(shape, scale) for shape in shapes]
        assert np.array_equal(MODES["compiled"](larger, origins * scale, directions), t * scale)
