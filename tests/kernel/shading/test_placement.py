"""Scaled, shifted and turned texture coordinates, with results known by hand and from the inverse map."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel.shading.texturing import in_own_frame, placed
from minirt.lanes import Vec
from minirt.materials import Checker, Marble, Placement, Specular
from minirt.rendering.packing.features import shape_features
from minirt.rendering.packing.materials import placement_numbers
from minirt.shapes import Plane, Shape, Sphere
from tests.reference.uv_mapping import SurfacePoint
from tests.reference.uv_mapping import placed as placed_by_inverse
from tests.shapes.execution_modes import array, vec

FLOOR = Plane((0, 0, 0), (0, 1, 0), (9, 9, 9))
GLOBE = Sphere((0, 0, 0), 2, (9, 9, 9), checker=Checker(0.125))
RIGHT, UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])


def at(uv: Placement, u: Any, v: Any, shape: Shape = FLOOR) -> SurfacePoint:
    """The coordinates of places u, v on a picture, and its tangents where those of the surface are RIGHT and UP."""
    u, v = np.atleast_1d(np.asarray(u, float)), np.atleast_1d(np.asarray(v, float))
    rows = np.array([placement_numbers(shape.replace(uv=uv))])
    like = np.zeros((len(u), 3))
    new_u, new_v, along_u, along_v = placed(rows, 0, u, v, vec(like + RIGHT), vec(like + UP))
    return SurfacePoint(new_u, new_v, array(along_u, like), array(along_v, like))


@pytest.mark.parametrize(
    ("uv", "place", "expected"),
    [
        (Placement(4, 2), (0.25, 0.5), (1, 1)),  # four pictures beside each other, two above each other
        (Placement(0.25, 0.5), (4, 2), (1, 1)),  # on a plane: four units wide, two high
        (Placement(1, 1, 0.5, 0.25), (0.5, 0.25), (0, 0)),  # the lower left corner
        (Placement(4, 2, 0.5, 0.25), (0.75, 0.75), (1, 1)),  # its opposite corner
        (Placement(1, 1, turn=90), (0, 0.75), (0.75, 0)),  # the lower edge of the picture runs upwards
        (Placement(4, 2, turn=90), (-0.5, 0), (0, 1)),  # the left edge runs to the left
        (Placement(1, 1, turn=180), (0.25, 0.5), (-0.25, -0.5)),
        (Placement(2, 2, 1, 1, -90), (1, 0.5), (1, 0)),
    ],
)
def test_known_places(uv: Placement, place: tuple[float, float], expected: tuple[float, float]) -> None:
    found = at(uv, *place)
    assert (float(found.u[0]), float(found.v[0])) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("seed", range(5))
def test_random_placements_invert_the_map_from_picture_to_surface(seed: int) -> None:
    random = np.random.default_rng(seed)
    uv = Placement(*np.exp(random.normal(size=2)), *random.normal(size=2), random.uniform(-360, 360))
    u, v = random.normal(size=(2, 20))
    surface = SurfacePoint(u, v, np.tile(RIGHT, (20, 1)), np.tile(UP, (20, 1)))
    right, found = placed_by_inverse(surface, uv), at(uv, u, v)
    assert all(np.allclose(a, b, rtol=1e-12, atol=1e-12) for a, b in zip(found, right, strict=True))
    wrong = at(uv.replace(turn=-uv.turn), u, v)
    assert not any(np.allclose(a, b, rtol=1e-3, atol=1e-3) for a, b in zip(wrong, right, strict=True))


def test_a_step_along_a_tangent_changes_its_own_coordinate_alone() -> None:
    uv = Placement(3, 0.5, 0.1, 0.7, 33)
    here = at(uv, 0.3, 0.4)
    for tangent, changed in ((here.along_u[0], (1, 0)), (here.along_v[0], (0, 1))):
        there = at(uv, 0.3 + tangent @ RIGHT, 0.4 + tangent @ UP)
        assert (float(there.u[0] - here.u[0]), float(there.v[0] - here.v[0])) == pytest.approx(changed, abs=1e-14)


def test_a_turned_sphere_is_mapped_in_its_own_axes() -> None:
    # Its pole points along x, and the middle of its picture, at -z before, stays there.
    globe = GLOBE.replace(axis=(1, 0, 0))
    rows = np.array([placement_numbers(globe)])
    for normal, own in (((1, 0, 0), (0, 1, 0)), ((0, 0, 1), (0, 0, 1)), ((0, -1, 0), (1, 0, 0))):
        seen = in_own_frame(rows, 0, Vec(*map(np.float64, normal)))
        assert (seen.x, seen.y, seen.z) == own
    zero = np.zeros(1)
    *_, along_u, along_v = placed(rows, 0, zero, zero, Vec(1.0 + zero, zero, zero), Vec(zero, 1.0 + zero, zero))
    assert array(along_u, np.zeros((1, 3))).tolist() == [[0, -1, 0]]
    assert array(along_v, np.zeros((1, 3))).tolist() == [[1, 0, 0]]
    rolled = np.array([placement_numbers(GLOBE.replace(roll=90))])  # x goes to -z, where the middle of the picture is
    seen = in_own_frame(rolled, 0, Vec(*map(np.float64, (0, 0, -1))))
    assert (seen.x, seen.y, seen.z) == (1, 0, 0)


def test_the_kernel_has_the_feature_only_where_a_picture_is_placed() -> None:
    scaled = Placement(2, 2)
    assert "placements" in shape_features(GLOBE.replace(uv=scaled))
    assert "placements" not in shape_features(GLOBE.replace(uv=Placement(1, 1)))
    assert "placements" in shape_features(GLOBE.replace(axis=(1, 0, 0)))
    assert "placements" in shape_features(GLOBE.replace(roll=-90.0))
    assert "placements" not in shape_features(GLOBE.replace(roll=360.0))
    assert "placements" not in shape_features(GLOBE.replace(checker=None, specular=Specular(0.5, 9), roll=5.0))
    assert "placements" not in shape_features(GLOBE.replace(checker=None, marble=Marble(1.0), roll=5.0))
    assert "placements" not in shape_features(FLOOR.replace(checker=Checker(1), roll=5.0))
