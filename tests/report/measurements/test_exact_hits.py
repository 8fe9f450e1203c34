"""Exact hit distances agree with answers worked out by hand and with the independent oracle of the tests."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from gmpy2 import mpfr

from minirt.report.measurements import exact_hits
from minirt.report.measurements.exact_hits import distance
from minirt.report.measurements.regimes import Regime, regimes_of
from minirt.shapes import KINDS, Kind
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests import oracle

GREY = (128, 128, 128)
TUBE = Cylinder((0, 0, 5), (0, 1, 0), 6, 4, GREY)
CASES = [(kind, regime) for kind in KINDS if kind.element in exact_hits.SOLIDS for regime in regimes_of(kind)]


@pytest.mark.parametrize(
    ("shape", "origin", "direction", "t"),
    [
        (Sphere((0, 0, 5), 6, GREY), (0, 0, 0), (0, 0, 1), 2),
        (Sphere((0, 0, 5), 6, GREY), (0, 0, 4), (0, 0, 1), 4),
        (Sphere((0, 0, 5), 6, GREY), (3, 0, 0), (0, 0, 1), 5),  # just touches
        (Sphere((0, 0, 5), 6, GREY), (3.0000000000000004, 0, 0), (0, 0, 1), "Infinity"),
        (Sphere((0, 0, 5), 6, GREY), (0, 0, 0), (0, 0, -1), "Infinity"),
        (Plane((0, 0, 3), (0, 0, -1), GREY), (1, 1, 1), (0, 0, 1), 2),
        (Plane((0, 0, 3), (0, 0, -1), GREY), (1, 1, 1), (1, 0, 0), "Infinity"),
        (Plane((0, 0, 3), (0, 0, -1), GREY), (1, 1, 4), (0, 0, 1), "Infinity"),
        (TUBE, (0, 0, 0), (0, 0, 1), 2),  # the side
        (TUBE, (0, 9, 5), (0, -1, 0), 7),  # a cap, along the axis
        (TUBE, (3.5, 9, 5), (0, -1, 0), "Infinity"),  # past it, along the axis
        (TUBE, (0, 2.5, 0), (0, 0, 1), "Infinity"),  # over it
        (TUBE, (0, 0, 5), (0, 1, 0), 2),  # from within
        (TUBE, (0, 0, 0), (0, 1, 1), 2),  # just touches the rim
    ],
)
def test_answers_known_by_hand(shape: Any, origin: Any, direction: Any, t: Any) -> None:
    assert distance(shape, origin, direction) == Decimal(t)


def test_a_thicker_shape_is_nearer() -> None:
    assert distance(TUBE, (0, 0, 0), (0, 0, 1), 0.5) == Decimal("1.5")
    assert distance(TUBE, (0, 9, 5), (0, -1, 0), -0.5) == Decimal("7.5")
    assert distance(TUBE, (0, 9, 5), (0, -1, 0), -2.5) == Decimal("Infinity")  # thinner than nothing


@pytest.mark.parametrize(("kind", "regime"), CASES, ids=[f"{k.element.title}, {r.name}" for k, r in CASES])
def test_the_oracle_of_the_tests_agrees(kind: Kind, regime: Regime) -> None:
    shapes, origins, directions = regime.pose(kind, np.random.default_rng(5), 3, 4)
    hits = 0
    for shape, starts, ways in zip(shapes, origins, directions, strict=True):
        for swell in (0.0, 1e-9) if shape.balls() else (0.0,):
            for origin, direction in zip(starts, ways, strict=True):
                found, right = (
                    distance(shape, origin, direction, swell),
                    oracle.nearest(shape, origin, direction, swell),
                )
                assert found.is_finite() == (right is not None)
                if right is not None:
                    hits += 1
                    assert abs(mpfr(str(found)) / right - 1) < mpfr(10) ** -30
    assert hits


def test_a_shape_without_an_exact_reference() -> None:
    with pytest.raises(KeyError):
        distance(object(), (0, 0, 0), (0, 0, 1))  # type: ignore[arg-type]
