"""Texture coordinates and tangents of all shapes, against those of the reference renderer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.shapes import KINDS, Cone, Cylinder, Ellipsoid, Hyperboloid, Kind, Paraboloid, Shape, Sphere, Torus
from tests.shapes.examples import example
from tests.shapes.mapping_checks import (
    MODES,
    Case,
    Evaluate,
    cases,
    check_places,
    check_tangents,
    compiled,
    interpreted,
)
from tests.shapes.regimes import GREY

SIZES = [(1.0, 0.0), (1e6, 0.0), (1e-6, 1.0)]
CHECKS = (check_places, check_tangents)
ALL = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
EITHER = pytest.mark.parametrize("evaluate", MODES.values(), ids=MODES)
UP, DOWN = (0, 1, 0), (0, -1, 0)


@ALL
@EITHER
@pytest.mark.parametrize(("size", "offset"), SIZES)
def test_random_shapes_agree_with_the_reference(kind: Kind, evaluate: Evaluate, size: float, offset: float) -> None:
    for case in cases(kind, size, offset):
        for check in CHECKS:
            check(case, evaluate, size)


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
def test_at_poles_and_apexes_all_is_finite(dtype: Any, evaluate: Evaluate) -> None:
    # The tip itself and places a little or next to nothing aside.
    aside = np.zeros((32, 3))
    aside[1:16, 0], aside[16:, 2] = 10.0 ** -np.arange(15), 10.0 ** -np.arange(16.0)
    for shape, point, normal in TIPS:
        points, normals = np.array(point) + aside, np.tile(np.array(normal, float), (32, 1))
        got = evaluate(shape, points.astype(dtype), normals.astype(dtype))
        assert all(np.isfinite(each).all() for each in got), shape


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
def test_a_wrong_mapping_does_not_pass(kind: Kind) -> None:
    assert not fails(cases(kind, 1.0, 0.0), kind.mapping)
    for name, wrong in WRONG.items():
        assert fails(cases(kind, 1.0, 0.0), lambda *given, wrong=wrong: wrong(*kind.mapping(*given))), name
