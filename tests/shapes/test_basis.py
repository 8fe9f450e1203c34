"""Orthonormal frames of shapes that have an axis."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.fields import unit
from minirt.lanes import Vec, dot
from minirt.shapes.frames import basis, from_basis, to_basis
from tests.shapes.checks import U
from tests.shapes.regimes import random_directions

POLES = [(0, 0, 1), (0, 0, -1), (1e-300, 0, -1), (1e-8, 1e-9, -1), (0, 1e-17, -1), (1, 0, -0.0), (0, 1, 0.0)]
AXES = [*map(unit, POLES), *map(tuple, random_directions(np.random.default_rng(1), 200))]


@pytest.mark.parametrize("axis", AXES[:10])
def test_known_axes(axis: tuple[float, float, float]) -> None:
    assert_orthonormal(axis)


def test_random_axes() -> None:
    for axis in AXES:
        assert_orthonormal(axis)


def assert_orthonormal(axis: tuple[float, float, float]) -> None:
    u, v, w = basis(axis)
    assert (w.x, w.y, w.z) == axis
    for a, b, product in ((u, u, 1), (v, v, 1), (u, v, 0), (u, w, 0), (v, w, 0)):
        assert abs(dot(a, b) - product) <= 8 * U
    turned = np.cross((u.x, u.y, u.z), (v.x, v.y, v.z))  # right-handed
    assert np.abs(turned - (w.x, w.y, w.z)).max() <= 8 * U


def test_transforming_there_and_back_changes_nothing() -> None:
    frame = basis(unit((0.3, -0.5, -0.8)))
    p = Vec(1.0, 2.0, 3.0)
    q = from_basis(*frame, to_basis(*frame, p))
    assert max(abs(q.x - 1), abs(q.y - 2), abs(q.z - 3)) <= 32 * U
