"""Polygons of .obj files are cut into triangles that cover them exactly: known by exact areas."""

from __future__ import annotations

from fractions import Fraction
from math import cos, pi, sin

import numpy as np
import pytest

from minirt.meshes import obj, polygons
from minirt.meshes.polygons import Polygon

Flat = list[tuple[float, float]]
DART: Flat = [(0, 2), (-1, -1), (0, 0), (1, -1)]
COMB: Flat = [(0, 0), (9, 0), *((x, 9 if x % 2 else 1) for x in range(8, 0, -1)), (0, 5)]
KEYHOLE: Flat = [
    (0, 0),
    (9, 0),
    (9, 9),
    (0, 9),
    (0, 0),
    (3, 3),
    (3, 6),
    (6, 6),
    (6, 3),
    (3, 3),
]  # a hole, and its bridge
FLAT_CORNERS: Flat = [(0, 0), (2, 0), (4, 0), (4, 4), (2, 4), (2, 2), (1, 2), (0, 2), (0, 1)]


def area(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> Fraction:
    """Twice the signed area of a triangle."""
    (u, v), (x, y), (z, w) = (map(Fraction, point) for point in (a, b, c))
    return (x - u) * (w - v) - (y - v) * (z - u)


def total(polygon: Flat) -> Fraction:
    """Twice the signed area of a polygon, by the trapezoids below its edges."""
    ends = [(Fraction(x), Fraction(y)) for x, y in polygon]
    return sum(((x - u) * (v + y) for (x, y), (u, v) in zip(ends, ends[1:] + ends[:1], strict=True)), Fraction(0))


def cut(polygon: Flat) -> list[list[int]]:
    """Cut a polygon in the plane z = 0 as a file's."""
    points = np.array([(x, y, 0.0) for x, y in polygon])
    return polygons.triangulate(points, np.arange(len(points)), np.array([len(points)]), int).tolist()


def is_inside(polygon: Flat, x: Fraction, y: Fraction) -> bool:
    """Whether a point is inside a polygon: a ray to the right crosses it oddly often."""
    crossings = 0
    for (a, b), (c, d) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if (b > y) != (d > y):
            crossings += Fraction(a) + (y - Fraction(b)) / (Fraction(d) - Fraction(b)) * (Fraction(c) - Fraction(a)) > x
    return crossings % 2 == 1


def assert_covers(polygon: Flat, triangles: list[list[int]]) -> None:
    """Assert that triangles cover a counter-clockwise polygon once: none is turned over, the areas add up to that of
    the polygon, and the middle of each is inside."""
    assert len(triangles) == len(polygon) - 2
    areas = [area(*(polygon[i] for i in each)) for each in triangles]
    assert min(areas) >= 0
    assert sum(areas) == total(polygon) > 0
    for each, size in zip(triangles, areas, strict=True):
        x, y = (sum(Fraction(polygon[i][part]) for i in each) / 3 for part in (0, 1))
        assert size == 0 or is_inside(polygon, x, y)


def star(random: np.random.Generator, corners: int) -> Flat:
    """A random polygon with corners in all directions from a point inside."""
    turns = np.sort(random.random(corners)) + np.arange(corners)
    radii = 0.1 + random.random(corners)
    return [(r * cos(2 * pi * t / corners), r * sin(2 * pi * t / corners)) for r, t in zip(radii, turns, strict=True)]


@pytest.mark.parametrize(
    "polygon", [DART, COMB, KEYHOLE, FLAT_CORNERS], ids=["dart", "comb", "keyhole", "flat corners"]
)
def test_triangles_cover_a_concave_polygon_from_each_of_its_corners(polygon: Flat) -> None:
    for first in range(len(polygon)):
        turned = polygon[first:] + polygon[:first]
        assert_covers(turned, cut(turned))


def test_triangles_cover_random_polygons() -> None:
    random = np.random.default_rng(1)
    for corners in (4, 5, 6, 7, 9, 12, 20, 40) * 6:
        polygon = star(random, corners)
        assert_covers(polygon, cut(polygon))


def test_a_fan_does_not_cover_them() -> None:
    fan = polygons.fan_triangulation(np.array([len(COMB)])).tolist()
    with pytest.raises(AssertionError):
        assert_covers(COMB, fan)
    with pytest.raises(AssertionError):
        assert_covers(DART[1:] + DART[:1], polygons.fan_triangulation(np.array([4])).tolist())


def test_convex_polygons_stay_fans(monkeypatch: pytest.MonkeyPatch) -> None:
    square = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
    assert cut(square) == polygons.fan_triangulation(np.array([5])).tolist()
    monkeypatch.setattr(polygons, "is_covered_by_fan", lambda _: pytest.fail("needs no exact arithmetic"))
    random = np.random.default_rng(2)
    for corners in (4, 5, 8, 30):
        turns = 2 * pi * np.sort(random.random(corners))
        points = np.stack([np.cos(turns), np.sin(turns), np.zeros(corners)], axis=1) @ random.normal(size=(3, 3))
        found = polygons.triangulate(points, np.arange(corners), np.array([corners]), int)
        assert np.array_equal(found, polygons.fan_triangulation(np.array([corners])))


def test_the_triangles_go_round_as_the_polygon_does_in_any_plane() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
        polygon = np.array([(x, y, 0.0) for x, y in DART]) @ frame + random.normal(size=3)
        for corners in (np.arange(4), np.arange(4)[::-1]):
            found = corners[polygons.triangulate(polygon, corners, np.array([4]), int)]
            a, b, c = polygon[found].swapaxes(0, 1)
            ring = polygon[corners]
            normal = np.cross(ring - ring[0], np.roll(ring, -1, axis=0) - ring[0]).sum(axis=0)
            assert (np.cross(b - a, c - a) @ normal > 0).all()


def test_texture_coordinates_and_normals_follow_the_corners() -> None:
    lines = [f"v {x} {y} 0\nvt {x} {y}\nvn {x} {y} 1\n" for x, y in DART]
    mesh = obj.parse(("".join(lines) + "f 2/2/2 3/3/3 4/4/4 1/1/1\nf 1/1/1 2/2/2 3/3/3\n").encode())
    assert mesh.uvs is not None
    assert mesh.normals is not None
    assert len(mesh) == 3
    places = mesh.points[mesh.corners][..., :2]
    assert np.array_equal(mesh.uvs, places)
    assert np.allclose(mesh.normals[..., :2] / mesh.normals[..., 2:], places)


def test_a_large_polygon_is_cut() -> None:
    teeth = 5000
    polygon = [(float(i), float(-1 - i % 2 * 50)) for i in range(teeth)]
    polygon += [(float(i), float(1 + i % 2 * 50)) for i in reversed(range(teeth))]
    found = cut(polygon)
    areas = [area(*(polygon[i] for i in each)) for each in found]
    assert min(areas) >= 0
    assert sum(areas) == total(polygon)


@pytest.mark.parametrize(
    "polygon",
    [
        [(0, 0), (2, 2), (2, 0), (0, 2)],  # a bow tie
        [(0, 0), (3, 3), (3, 0), (0, 2)],
        [(cos(0.8 * pi * i), sin(0.8 * pi * i)) for i in range(5)],  # goes round twice
        [(0, 0), (1, 0), (2, 0), (3, 0)],  # a line
        [(0, 0), (0, 0), (0, 0), (0, 0)],
        [(0, 0), (1, 0), (1, 0), (0, 1)],
    ],
)
def test_polygons_that_cross_themselves_or_have_no_area_end_in_as_many_triangles(polygon: Flat) -> None:
    found = cut(polygon)
    assert len(found) == len(polygon) - 2
    assert {i for each in found for i in each} == set(range(len(polygon)))


def test_ears_that_contain_corners_are_not_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Polygon, "is_ear", lambda self, corner: self.turn(corner) > 0)
    turned = [COMB[first:] + COMB[:first] for first in range(len(COMB))]
    with pytest.raises(AssertionError):
        all(assert_covers(polygon, cut(polygon)) is None for polygon in turned)
