"""Checkerboards, bump maps and normal maps; bump maps against the normals of the raised surface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from minirt.kernel.shading.texturing import SurfaceMaps, bump_mapped, checkered, normal_mapped
from minirt.lanes import Vec, load
from minirt.shapes import KINDS, Kind
from tests.kernel.pictures import Array
from tests.shapes.execution_modes import array, on_lanes, vec, vec_lanes
from tests.shapes.mapping_checks import SurfaceMapping, cases, interpreted, lengths
from tests.shapes.regimes import random_directions, unit

SIDE = 256  # pixels along an edge of the height map
STRENGTH = 0.05
OWN, SECOND = (0.25, 0.5, 0.75), (1.0, 0.0, 0.125)


def height(u: Array, v: Array) -> Array:
    """Height of a periodic relief, from 0 to 1."""
    found: Array = 0.5 + 0.25 * np.sin(2 * np.pi * u) * np.cos(2 * np.pi * v) + 0.2 * np.sin(2 * np.pi * (u + 2 * v))
    return found


def picture_arrays(pixels: Array) -> dict[str, Any]:
    """Return a picture (h, w, channels) as the kernel reads it."""
    row = 0, pixels.shape[1], pixels.shape[0], pixels.shape[2]
    return {"texels": pixels.ravel().astype(np.float32), "pictures": np.array([row], np.int64)}


def maps_of(pixels: Array, strength: float = STRENGTH) -> SurfaceMaps:
    """Return the maps of one shape, whose bump map and normal map are both this picture."""
    return SurfaceMaps(None, None, np.array([[1, strength]]), np.array([1]), np.array([1]), **picture_arrays(pixels))


def height_map(strength: float = STRENGTH) -> SurfaceMaps:
    """Return the maps of one shape with the relief as its bump map."""
    places = (np.arange(SIDE) + 0.5) / SIDE
    return maps_of(height(places[None], 1 - places[:, None])[..., None], strength)


def uniform(colour: tuple[int, int, int]) -> SurfaceMaps:
    """Return the maps of one shape with a normal map of one colour."""
    return maps_of(np.tile(np.array(colour) / 255, (2, 3, 1)))


def bump_lanes(i: int, maps: Any, uv: Any, a: Any, b: Any, n: Any) -> Any:
    u, v, along_u, along_v, normal = load(uv[0], i), load(uv[1], i), vec_lanes(a, i), vec_lanes(b, i), vec_lanes(n, i)
    result = bump_mapped(maps, 0, u, v, along_u, along_v, normal)
    return result.x, result.y, result.z


def normal_lanes(i: int, maps: Any, uv: Any, a: Any, b: Any, n: Any) -> Any:
    u, v, along_u, along_v, normal = load(uv[0], i), load(uv[1], i), vec_lanes(a, i), vec_lanes(b, i), vec_lanes(n, i)
    result = normal_mapped(maps, 0, u, v, along_u, along_v, normal)
    return result.x, result.y, result.z


LANES = {"bump": bump_lanes, "normal": normal_lanes}
PLAIN = {"bump": bump_mapped, "normal": normal_mapped}
Bend = Callable[[str, SurfaceMaps, SurfaceMapping, Array], Array]


def interpreted_bend(name: str, maps: SurfaceMaps, at: SurfaceMapping, normals: Array) -> Array:
    """Apply a bump or normal map to normals by the interpreted kernel."""
    result = PLAIN[name](maps, 0, at.u, at.v, vec(at.along_u), vec(at.along_v), vec(normals))
    return array(result, normals)


def compiled_bend(name: str, maps: SurfaceMaps, at: SurfaceMapping, normals: Array) -> Array:
    """Apply a bump or normal map to normals by the compiled kernel."""
    vectors = (np.ascontiguousarray(each.T) for each in (at.along_u, at.along_v, normals))
    return on_lanes(LANES[name], 3, maps, np.stack([at.u, at.v]), *vectors).T


EITHER = pytest.mark.parametrize("bend", [interpreted_bend, compiled_bend])
ALL = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)


def raised_normals(at: Any, normals: Array, strength: float, width: Array) -> Array:
    """Return the normals of a surface raised by the relief around each of the places, whose u, v and tangents are `at`.

    The surface passes through the place itself; heights are in widths of the picture there.
    """
    h = 1e-5
    slopes = [(height(at.u + a, at.v + b) - height(at.u - a, at.v - b)) / (2 * h) for a, b in ((h, 0), (0, h))]
    risen = [
        along + (strength * width * slope)[:, None] * normals
        for along, slope in zip((at.along_u, at.along_v), slopes, strict=True)
    ]
    return unit(np.cross(*risen))


def largest_error(kind: Kind, bend: Bend, size: float = 1.0, strength: float = STRENGTH) -> float:
    """Return the largest distance of a bump-mapped normal from the expected normal."""
    errors = []
    for case in cases(kind, size, 0.0):
        at = interpreted(case.shape, case.points, case.normals)
        result = bend("bump", height_map(strength), at, case.normals)
        expected = raised_normals(case.right, case.normals, strength, lengths(at.along_u))
        errors.append(float(lengths(result - expected).max()))
    return max(errors)


@ALL
@EITHER
@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
def test_bump_mapped_normals_are_those_of_the_raised_surface(kind: Kind, bend: Bend, size: float) -> None:
    for strength in (STRENGTH, -0.3):
        assert largest_error(kind, bend, size, strength) < 2e-3


@EITHER
def test_bumps_of_a_mirrored_picture_point_outwards_too(bend: Bend) -> None:
    # Meshes may have mirrored texture coordinates.
    (case, *_) = cases(KINDS[0], 1.0, 0.0)
    at, right = interpreted(case.shape, case.points, case.normals), case.right
    mirrored = at._replace(u=1 - at.u, along_u=-at.along_u)
    other = right._replace(u=1 - right.u, along_u=-right.along_u)
    expected = -raised_normals(other, case.normals, STRENGTH, lengths(at.along_u))
    assert lengths(bend("bump", height_map(), mirrored, case.normals) - expected).max() < 2e-3


@EITHER
@pytest.mark.parametrize("name", LANES)
def test_zero_tangents_leave_normals_unchanged(bend: Bend, name: str) -> None:
    normals = random_directions(np.random.default_rng(2), 16)
    nothing = np.zeros((16, 3))
    maps = height_map() if name == "bump" else uniform((200, 50, 230))
    for a, b in ((nothing, nothing), (nothing, random_directions(np.random.default_rng(3), 16))):
        at = SurfaceMapping(np.full(16, 0.3), np.full(16, 0.6), a, b)
        result = bend(name, maps, at, normals)
        assert np.abs(lengths(result) - 1).max() < 1e-12
        if name == "bump" or b is nothing:
            assert lengths(result - normals).max() < 1e-12


def skewed_tangents() -> tuple[SurfaceMapping, Array]:
    """Return tangents of many lengths, not perpendicular to each other, and normals."""
    random = np.random.default_rng(4)
    a, b = random.normal(size=(2, 32, 3)) * 10.0 ** random.uniform(-6, 6, (2, 32, 1))
    return SurfaceMapping(*random.random((2, 32)), a, b), unit(np.cross(unit(a), unit(b)))


@EITHER
@pytest.mark.parametrize(
    ("colour", "shares"),
    [
        ((128, 128, 255), (0, 0, 1)),  # changes nothing
        ((128, 128, 200), (0, 0, 1)),
        ((255, 128, 128), (1, 0, 0)),
        ((1, 128, 128), (-1, 0, 0)),
        ((128, 255, 128), (0, 1, 0)),
        ((128, 1, 128), (0, -1, 0)),
        ((255, 128, 255), (1, 0, 1)),
        ((128, 128 - 50, 128 + 100), (0, -0.5, 1)),
        ((128 + 30, 128 + 60, 128 + 60), (0.5, 1, 1)),
    ],
)
def test_colours_of_a_normal_map_are_directions(bend: Bend, colour: Any, shares: Any) -> None:
    at, normals = skewed_tangents()
    expected = shares[0] * unit(at.along_u) + shares[1] * unit(at.along_v) + shares[2] * normals
    assert lengths(bend("normal", uniform(colour), at, normals) - unit(expected)).max() < 1e-6


def check_lanes(i: int, checks: Any, uv: Any, own: Any) -> Any:
    colours = checkered(checks, 0, load(uv[0], i), load(uv[1], i), vec_lanes(own, i))
    return colours.x, colours.y, colours.z


def checkerboards(size: float, u: Array, v: Array) -> list[Array]:
    """Return the colours of places on a checkerboard, interpreted and compiled, each (n, 3)."""
    checks = np.array([[size, *SECOND]])
    own = np.tile(np.array(OWN)[:, None], u.size)
    lanes = on_lanes(check_lanes, 3, checks, np.stack([u, v]), own)
    return [array(checkered(checks, 0, u, v, Vec(*own)), np.empty((u.size, 3))), lanes.T]


@pytest.mark.parametrize("size", [0.125, 1.0, 2.5, 1e-3, 1e6])
def test_squares_of_a_checkerboard_alternate_colours(size: float) -> None:
    column, row = (each.ravel() for each in np.meshgrid(np.arange(-8, 8), np.arange(-8, 8)))
    for within in ((0.5, 0.5), (0.01, 0.99), (0.99, 0.01)):
        expected = np.where(((column + row) % 2 == 0)[:, None], OWN, SECOND)
        for result in checkerboards(size, (column + within[0]) * size, (row + within[1]) * size):
            assert np.array_equal(result, expected)


def test_the_lower_left_corner_of_a_square_belongs_to_it() -> None:
    u, v = (np.resize(each, 16) for each in ((0.0, 0.125, 0.0, 0.125), (0.0, 0.0, 0.125, 0.125)))
    for result in checkerboards(0.125, u, v):
        assert np.array_equal(result[:4], [OWN, SECOND, SECOND, OWN])
