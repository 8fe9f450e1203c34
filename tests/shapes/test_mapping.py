"""Texture coordinates and tangents of all shapes, against those of the reference renderer and known places."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

from minirt.shapes import KINDS, Kind, Shape
from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.shapes.examples import example, hits
from tests.shapes.execution_modes import surfaces
from tests.shapes.mapping_checks import (
    MODES,
    Case,
    Evaluate,
    cases,
    check_hand,
    check_places,
    check_tangents,
    compiled,
    interpreted,
    lengths,
)
from tests.shapes.regimes import GREY
from tests.skipping import skip_incomplete

TITLED = partial(pytest.mark.parametrize, ids=lambda each: each.title if isinstance(each, Shape) else None)
SIZES = [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6), (1e-6, 1.0)]
CHECKS = (check_places, check_tangents, check_hand)
ALL = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
EITHER = pytest.mark.parametrize("evaluate", MODES.values(), ids=MODES)
ORIGIN, UP, DOWN = (0, 0, 0), (0, 1, 0), (0, -1, 0)


@ALL
@EITHER
@pytest.mark.parametrize(("size", "offset"), SIZES)
@pytest.mark.parametrize("check", CHECKS)
def test_random_shapes_agree_with_the_reference(
    kind: Kind, evaluate: Evaluate, size: float, offset: float, check: Any
) -> None:
    for case in cases(kind, size, offset):
        check(case, evaluate, size)


KNOWN: list[tuple[Shape, tuple[float, ...], tuple[float, ...], tuple[float, float]]] = [
    (Sphere((1, 2, 3), 4, GREY), (1, 2, 1), (0, 0, -1), (0.5, 0.5)),
    (Sphere((1, 2, 3), 4, GREY), (-1, 2, 3), (-1, 0, 0), (0.75, 0.5)),
    (Sphere((1, 2, 3), 4, GREY), (3, 2, 3), (1, 0, 0), (0.25, 0.5)),
    (Sphere(ORIGIN, 2, GREY), (0, 0.5**0.5, -(0.5**0.5)), (0, 0.5**0.5, -(0.5**0.5)), (0.5, 0.75)),
    (Plane((1, 2, 3), UP, GREY), (4, 2, 1), UP, (3, 2)),  # a floor: along x and -z
    (Plane((1, 2, 3), DOWN, GREY), (4, 2, 4), DOWN, (3, 1)),
    (Plane(ORIGIN, (0, 0, -1), GREY), (-2, 3, 0), (0, 0, -1), (2, 3)),  # a wall in front: right is -x
    (Plane(ORIGIN, (-1, 0, 0), GREY), (0, 3, 2), (-1, 0, 0), (2, 3)),
    (Square(ORIGIN, (0, 0, -1), 4, GREY), (-2, -2, 0), (0, 0, -1), (1, 0)),
    (Square(ORIGIN, UP, 4, GREY), (2, 0, -1), UP, (1, 0.75)),
    (Disc(ORIGIN, (0, 0, -1), 4, GREY), (1, 2, 0), (0, 0, -1), (0.25, 1)),
    (Triangle(ORIGIN, (4, 0, 0), (0, 3, 0), GREY), (1, 0.75, 0), (0, 0, 1), (0.25, 0.25)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (-0.5, 1, -3), (0, 0, -1), (0.75, 0.75)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (0.5, 1, 3), (0, 0, 1), (0.75, 0.75)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (1, -2, -3), (1, 0, 0), (1, 0)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (-1, -2, 3), (-1, 0, 0), (1, 0)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (1, 2, -1.5), UP, (1, 0.75)),
    (Box(ORIGIN, UP, (2, 4, 6), GREY), (1, -2, 1.5), DOWN, (1, 0.75)),
    (Cylinder(ORIGIN, UP, 2, 4, GREY), (0, 1, -1), (0, 0, -1), (0.5, 0.75)),
    (Cylinder(ORIGIN, UP, 2, 4, GREY), (-1, -2, 0), (-1, 0, 0), (0.75, 0)),
    (Cylinder(ORIGIN, UP, 2, 4, GREY), (0.5, 2, -0.5), UP, (0.75, 0.75)),
    (Cylinder(ORIGIN, UP, 2, 4, GREY), (0.5, -2, 0.5), DOWN, (0.75, 0.75)),
    (Cone((0, 3, 0), DOWN, 2, 3, GREY), (0, 1, -2 / 3), (0, 0.3162278, -0.9486833), (0.5, 1 / 3)),
    (Cone((0, 3, 0), DOWN, 2, 3, GREY), (-0.5, 1.5, 0), (-0.9486833, 0.3162278, 0), (0.75, 0.5)),
    (Cone((0, 3, 0), DOWN, 2, 3, GREY), (0.5, 0, 0.5), DOWN, (0.75, 0.75)),
    (Paraboloid(ORIGIN, UP, 4, 4, GREY), (0, 1, -1), (0, -0.4472136, -0.8944272), (0.5, 0.5)),
    (Paraboloid(ORIGIN, UP, 4, 4, GREY), (-1, 4, -1), UP, (0.25, 0.75)),
    (Hyperboloid(ORIGIN, UP, 2, 4, 4, GREY), (-1, 0, 0), (-1, 0, 0), (0.75, 0.5)),
    (Hyperboloid(ORIGIN, UP, 2, 4, 4, GREY), (-1, -2, 1), DOWN, (0.25, 0.75)),
    (Ellipsoid((1, 2, 3), UP, (4, 6, 8), GREY), (1, 2, -1), (0, 0, -1), (0.5, 0.5)),
    (Ellipsoid((1, 2, 3), UP, (4, 6, 8), GREY), (-1, 2, 3), (-1, 0, 0), (0.75, 0.5)),
    (Ellipsoid(ORIGIN, UP, (4, 6, 4), GREY), (0, 1.5 * 2**0.5, -(2**0.5)), (0, 2, -3), (0.5, 0.75)),
    (Torus(ORIGIN, UP, 6, 2, GREY), (0, 0, -4), (0, 0, -1), (0.5, 0.5)),
    (Torus(ORIGIN, UP, 6, 2, GREY), (-3, 1, 0), UP, (0.75, 0.75)),
    (Torus(ORIGIN, UP, 6, 2, GREY), (-3, -1, 0), DOWN, (0.75, 0.25)),
]


@EITHER
@TITLED(("shape", "point", "normal", "right"), KNOWN)
def test_known_places(shape: Shape, point: Any, normal: Any, right: Any, evaluate: Evaluate) -> None:
    points, normals = np.tile(np.array(point, float), (16, 1)), np.tile(np.array(normal, float), (16, 1))
    got = evaluate(shape, points, normals)
    assert np.allclose([got.u[0], got.v[0]], right, rtol=0, atol=1e-15)


def test_every_kind_has_a_known_place() -> None:
    missing = {kind.element for kind in KINDS} - {type(shape) for shape, *_ in KNOWN}
    if missing:
        skip_incomplete(
            f"no known place of {', '.join(kind.title for kind in missing)}: add one to KNOWN in {__file__}"
        )


TIPS: list[tuple[Shape, tuple[float, ...], tuple[float, ...]]] = [
    *((Sphere((1, 2, 3), 2, GREY), (1, 2 + y, 3), (0, y, 0)) for y in (1, -1)),
    *((Ellipsoid((1, 2, 3), UP, (4, 2, 6), GREY), (1, 2 + y, 3), (0, y, 0)) for y in (1, -1)),
    (Cone((1, 2, 3), UP, 2, 3, GREY), (1, 2, 3), DOWN),
    (Cone((1, 2, 3), UP, 2, 3, GREY), (1, 5, 3), UP),
    (Paraboloid((1, 2, 3), UP, 2, 3, GREY), (1, 2, 3), DOWN),
    (Paraboloid((1, 2, 3), UP, 2, 3, GREY), (1, 5, 3), UP),
    (Cylinder((1, 2, 3), UP, 2, 6, GREY), (1, 5, 3), UP),
    (Hyperboloid((1, 2, 3), UP, 2, 3, 6, GREY), (1, 5, 3), UP),
    (Hyperboloid((1, 2, 3), UP, 1e-30, 3, 6, GREY), (1, 2, 3), (1, 0, 0)),
    (Torus((1, 2, 3), UP, 2, 2, GREY), (1, 2, 3), (1, 0, 0)),
]


@EITHER
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@TITLED(("shape", "point", "normal"), TIPS)
def test_at_poles_and_apexes_all_is_finite(
    shape: Shape, point: Any, normal: Any, dtype: Any, evaluate: Evaluate
) -> None:
    # The tip itself and places a little or next to nothing aside.
    aside = np.zeros((32, 3))
    aside[1:16, 0], aside[16:, 2] = 10.0 ** -np.arange(15), 10.0 ** -np.arange(16.0)
    points, normals = np.array(point) + aside, np.tile(np.array(normal, float), (32, 1))
    got = evaluate(shape, points.astype(dtype), normals.astype(dtype))
    for each in got:
        assert np.isfinite(each).all()


@ALL
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float64, 1e-14), (np.float32, 1e-5)])
def test_compiled_and_interpreted_agree(kind: Kind, dtype: Any, tolerance: float) -> None:
    for case in cases(kind, 1.0, 0.0):
        points, normals = (each.astype(dtype) for each in (case.points, case.normals))
        one, other = interpreted(case.shape, points, normals), compiled(case.shape, points, normals)
        for a, b in zip(one, other, strict=True):
            assert a.dtype == b.dtype == dtype
            assert np.abs(a - b).max() <= tolerance * max(1.0, np.abs(a).max())


@ALL
def test_single_precision_agrees_with_double(kind: Kind) -> None:
    for case in cases(kind, 1.0, 0.0):
        got = compiled(case.shape, case.points.astype(np.float32), case.normals.astype(np.float32))
        over_u, over_v = got.u - case.right.u, got.v - case.right.v
        over_u -= np.rint(over_u)
        off = np.linalg.norm(over_u[:, None] * got.along_u + over_v[:, None] * got.along_v, axis=-1)
        assert off.max() <= 32 * 2.0**-24 * (case.coordinates + 10)


@pytest.mark.parametrize("title", ["cylinder", "cone", "paraboloid", "hyperboloid", "torus", "box", "ellipsoid"])
def test_a_shape_that_is_tilted_a_little_keeps_its_picture(title: str) -> None:
    kind = next(kind for kind in KINDS if kind.element.title == title)
    shape = example(kind, np.random.default_rng(3)).replace(axis=UP)
    point, normal = np.array([[0.3, 0.2, -0.5]]), np.array([[0.6, 0.0, -0.8]])
    before = interpreted(shape, point, normal)
    for tilt in ((1e-9, 1, 0), (-1e-9, 1, 0), (0, 1, 1e-9), (1e-9, 1, -1e-9), (0, 1, -1e-9)):
        after = interpreted(shape.replace(axis=tilt), point, normal)
        assert all(np.abs(a - b).max() < 1e-7 for a, b in zip(before, after, strict=True))


@ALL
def test_tangents_are_the_derivatives_of_points_by_u_and_v(kind: Kind) -> None:
    # A small step along both tangents, put back onto the surface. A few steps cross an edge or a seam or meet a pole.
    seen = hits(kind, 5, 1.0, 0.0, shapes=8, rays=64)
    right = steps = 0
    for shape, points, normals, hit in zip(seen.shapes, seen.points, seen.normals, seen.hit, strict=True):
        here = interpreted(shape, points, normals)
        step_u, step_v = (1e-4 / np.maximum(lengths(along), 1e-9) for along in (here.along_u, here.along_v))
        there = points + step_u[:, None] * here.along_u + step_v[:, None] * here.along_v
        on, out = surfaces([shape], there[None])
        after = interpreted(shape, on[0], out[0])
        over_u, over_v = after.u - here.u, after.v - here.v
        off = np.hypot((over_u - np.rint(over_u)) / step_u - 1, (over_v - np.rint(over_v)) / step_v - 1)
        right, steps = right + (off[hit] < 0.05).sum(), steps + hit.sum()
    assert right >= 0.9 * steps > 0


WRONG: dict[str, Any] = {
    "mirrored": lambda u, v, a, b: (1 - u, v, -a, b),
    "upside down": lambda u, v, a, b: (u, 1 - v, a, -b),
    "on its side": lambda u, v, a, b: (v, 1 - u, b, -a),
    "a quarter aside": lambda u, v, a, b: (u + 0.25, v, a, b),
    "twice": lambda u, v, a, b: (2 * u, v, 0.5 * a, b),
    "tangents changed round": lambda u, v, a, b: (u, v, b, a),
    "a tangent too long": lambda u, v, a, b: (u, v, 1.001 * a, b),
    "a tangent too short": lambda u, v, a, b: (u, v, a, 0.999 * b),
    "askew": lambda u, v, a, b: (u, v, a + 0.001 * b, b),
}


def fails(cases: list[Case], formula: Any) -> bool:
    """Whether a check rejects a formula."""
    for case in cases:
        try:
            for check in CHECKS:
                check(case, lambda *given: interpreted(*given, formula), 1.0)
        except AssertionError:
            return True
    return False


@ALL
@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_mapping_does_not_pass(kind: Kind, name: str) -> None:
    assert not fails(cases(kind, 1.0, 0.0), kind.mapping)
    assert fails(cases(kind, 1.0, 0.0), lambda *given: WRONG[name](*kind.mapping(*given)))


@pytest.mark.parametrize("title", ["box", "cylinder", "cone", "paraboloid", "hyperboloid"])
def test_sides_and_caps_are_distinguished_by_the_normal(title: str) -> None:
    kind = next(kind for kind in KINDS if kind.element.title == title)
    assert fails(cases(kind, 1.0, 0.0), lambda shape, point, normal: kind.mapping(shape, point, point - point))
