"""Concave quadrangles are cut all at once, as ear clipping cuts each of them."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import pytest

from minirt.meshes import polygons

right_cuts = polygons.certain_cuts


def random_faces(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points, corners and sizes of 300 faces of 3 to 5 corners, of which some cross themselves or are flat."""
    random = np.random.default_rng(seed)
    sizes = random.choice([3, 4, 4, 4, 5], 300)
    flat = np.column_stack([random.integers(-3, 4, (2000, 2)), np.zeros(2000)])
    bent = random.normal(size=(2000, 3))
    return np.concatenate([flat, bent]), random.integers(0, 2000, sizes.sum()) + 2000 * (seed % 2), sizes


def nothing_certain(points: np.ndarray, corners: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Stand in for `certain_cuts`: leave all quadrangles to ear clipping."""
    return np.zeros((2, len(first)), bool)


def compare_with_ear_clipping() -> int:
    """Compare with faces that are cut one after the other; AssertionError. Return how many needed that."""
    needed = 0
    for seed in range(2):
        faces = random_faces(seed)
        with patch.object(polygons, "cut_polygon", wraps=polygons.cut_polygon) as one_by_one:
            triangles = polygons.triangulate(*faces)
        needed += one_by_one.call_count
        with patch.object(polygons, "certain_cuts", nothing_certain):
            assert np.array_equal(triangles, polygons.triangulate(*faces))
    return needed


def test_they_are_cut_as_ear_clipping_cuts_them() -> None:
    with patch.object(polygons, "certain_cuts", nothing_certain):
        all_of_them = compare_with_ear_clipping()
    assert compare_with_ear_clipping() < 0.7 * all_of_them


@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("TWO_EARS", ((0, 1, 3), (1, 2, 3))),
        ("TWO_EARS", ((3, 1, 2), (3, 0, 1))),
        ("certain_cuts", lambda *faces: right_cuts(*faces)[::-1]),
        ("certain_cuts", lambda points, corners, first: ~nothing_certain(points, corners, first)),
    ],
)
def test_another_cut_is_found(name: str, wrong: object) -> None:
    with patch.object(polygons, name, wrong), pytest.raises(AssertionError):
        compare_with_ear_clipping()


@pytest.mark.parametrize("turn", range(4))
def test_no_line_of_python_looks_at_each_of_them(turn: int) -> None:
    dart = np.roll([(0.0, 2, 0), (-1, -1, 0), (0, 0, 0), (1, -1, 0)], turn, axis=0)
    with patch.object(polygons, "cut_polygon", wraps=polygons.cut_polygon) as one_by_one:
        triangles = polygons.triangulate(dart, np.arange(4000) % 4, np.full(1000, 4))
    assert one_by_one.call_count == 0
    assert np.array_equal(triangles % 4, np.tile(triangles[:2], (1000, 1)))
