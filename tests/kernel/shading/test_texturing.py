"""Checkerboards, normal maps, and bump maps where a surface has no tangents."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from minirt.kernel.shading.texturing import SurfaceMaps, bump_mapped, checkered, normal_mapped
from minirt.lanes import Vec, load
from tests.kernel.pictures import Array
from tests.reference.uv_mapping import SurfacePoint
from tests.shapes.execution_modes import array, on_lanes, vec, vec_lanes
from tests.shapes.mapping_checks import lengths
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
Bend = Callable[[str, SurfaceMaps, SurfacePoint, Array], Array]


def interpreted_bend(name: str, maps: SurfaceMaps, at: SurfacePoint, normals: Array) -> Array:
    """Apply a bump or normal map to normals by the interpreted kernel."""
    result = PLAIN[name](maps, 0, at.u, at.v, vec(at.along_u), vec(at.along_v), vec(normals))
    return array(result, normals)


def compiled_bend(name: str, maps: SurfaceMaps, at: SurfacePoint, normals: Array) -> Array:
    """Apply a bump or normal map to normals by the compiled kernel."""
    vectors = (np.ascontiguousarray(each.T) for each in (at.along_u, at.along_v, normals))
    return on_lanes(LANES[name], 3, maps, np.stack([at.u, at.v]), *vectors).T


EITHER = pytest.mark.parametrize("bend", [interpreted_bend, compiled_bend])


@EITHER
@pytest.mark.parametrize("name", LANES)
def test_zero_tangents_leave_normals_unchanged(bend: Bend, name: str) -> None:
    normals = random_directions(np.random.default_rng(2), 16)
    nothing = np.zeros((16, 3))
    maps = height_map() if name == "bump" else uniform((200, 50, 230))
    for a, b in ((nothing, nothing), (nothing, random_directions(np.random.default_rng(3), 16))):
        at = SurfacePoint(np.full(16, 0.3), np.full(16, 0.6), a, b)
        result = bend(name, maps, at, normals)
        assert np.abs(lengths(result) - 1).max() < 1e-12
        if name == "bump" or b is nothing:
            assert lengths(result - normals).max() < 1e-12


def skewed_tangents() -> tuple[SurfacePoint, Array]:
    """Return tangents of many lengths, not perpendicular to each other, and normals."""
    random = np.random.default_rng(4)
    a, b = random.normal(size=(2, 32, 3)) * 10.0 ** random.uniform(-6, 6, (2, 32, 1))
    return SurfacePoint(*random.random((2, 32)), a, b), unit(np.cross(unit(a), unit(b)))


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
