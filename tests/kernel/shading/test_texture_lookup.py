"""Pictures looked up, against sums over all of their pixels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.jit  # noqa: F401  (attaches the compiler)
from minirt.kernel.compiler.options import FLAGS
from minirt.kernel.shading import texture_lookup
from minirt.lanes import load, save, width
from minirt.rendering.packing.materials import Album
from tests.kernel.pictures import Array

RANDOM = np.random.default_rng(1)
PAGES = [  # of three channels and of one, one pixel wide or high, wider than high and higher than wide
    RANDOM.integers(0, 256, shape, np.uint8)
    for shape in ((5, 7, 3), (1, 1, 3), (8, 8, 3), (4, 1, 3), (1, 6, 3), (9, 2, 3))
]
PAGES += [RANDOM.random(shape).astype(np.float32) for shape in ((6, 4), (1, 1))]
COLOURED = range(6)


def bound() -> tuple[Any, Any]:
    """All pages as the kernel has them: texels and pictures."""
    album = Album.__new__(Album)
    album.pages = PAGES
    return tuple(album.bound().values())  # type: ignore[return-value]


TEXELS, PICTURES = bound()


@njit(**FLAGS)
def colours_on_lanes(held: Any, pictures: Any, which: int, u: Any, v: Any, out: Any) -> None:
    for i in range(0, u.size, width(u)):
        seen = texture_lookup.texture_lookup(held, pictures, which, load(u, i), load(v, i))
        save(seen.x, out[0], i)
        save(seen.y, out[1], i)
        save(seen.z, out[2], i)


@njit(**FLAGS)
def slopes_on_lanes(held: Any, pictures: Any, which: int, u: Any, v: Any, out: Any) -> None:
    for i in range(0, u.size, width(u)):
        over_u, over_v = texture_lookup.height_gradient(held, pictures, which, load(u, i), load(v, i))
        save(over_u, out[0], i)
        save(over_v, out[1], i)


def compiled(which: int, u: Array, v: Array) -> Array:
    out = np.full((3, u.size), np.nan)
    colours_on_lanes(TEXELS, PICTURES, which, u, v, out)
    return out.T


def interpreted(which: int, u: Array, v: Array) -> Array:
    with np.errstate(invalid="ignore"):
        seen = texture_lookup.texture_lookup(TEXELS, PICTURES, which, u, v)
    return np.stack([seen.x, seen.y, seen.z], axis=-1)


Way = Callable[[int, Array, Array], Array]
EITHER = pytest.mark.parametrize("way", [interpreted, compiled])


def page(which: int) -> Array:
    """A page from 0 to 1, (h, w, channels)."""
    pixels = PAGES[which]
    return (pixels / 255.0 if pixels.dtype == np.uint8 else pixels.astype(float)).reshape(*pixels.shape[:2], -1)


def weights(count: int, places: Array) -> Array:
    """How much each of `count` pixels in a row counts at places from 0 to 1 and beyond: a tent two pixels wide around
    its centre, and around those of its copies."""
    centres = (np.arange(-4 * count, 5 * count) + 0.5) / count
    tents = np.maximum(0, 1 - np.abs(places[:, None] - centres) * count)
    found: Array = tents.reshape(len(places), -1, count).sum(axis=1)
    return found


def right(which: int, u: Array, v: Array) -> Array:
    pixels = page(which)
    down, across = weights(pixels.shape[0], 1 - v), weights(pixels.shape[1], u)
    found: Array = np.einsum("nh,nw,hwc->nc", down, across, pixels)
    return found


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_at_the_centre_of_a_pixel_is_its_colour(which: int, way: Way) -> None:
    pixels = page(which)
    high, wide = pixels.shape[:2]
    for row in range(high):
        for column in range(wide):
            u, v = np.full(16, (column + 0.5) / wide), np.full(16, 1 - (row + 0.5) / high)
            assert np.abs(way(which, u, v)[0] - pixels[row, column]).max() < 1e-6


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_between_centres_it_is_the_mean_by_distance_and_beyond_the_edges_it_is_repeated(which: int, way: Way) -> None:
    u, v = np.random.default_rng(which).uniform(-3, 3, (2, 320))
    assert np.abs(way(which, u, v) - right(which, u, v)).max() < 1e-6


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_no_number_leads_out_of_the_pictures(which: int, way: Way) -> None:
    odd = np.array([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e17, -1e17, 0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 5e-324])
    u, v = (each.ravel() for each in np.meshgrid(np.resize(odd, 16), np.resize(odd, 16)))
    got = way(which, u, v)
    assert np.isfinite(got).all()
    assert got.min() >= page(which).min() - 1e-6
    assert got.max() <= page(which).max() + 1e-6


@pytest.mark.parametrize("which", range(len(PAGES)))
def test_slopes_are_differences_over_a_pixel(which: int) -> None:
    high, wide = PAGES[which].shape[:2]
    u, v = np.random.default_rng(which).uniform(-2, 2, (2, 160))
    over_u = right(which, u + 0.5 / wide, v) - right(which, u - 0.5 / wide, v)
    over_v = right(which, u, v + 0.5 / high) - right(which, u, v - 0.5 / high)
    expected = np.stack([over_u[:, 0] * wide, over_v[:, 0] * high])
    lanes = np.empty((2, 160))
    slopes_on_lanes(TEXELS, PICTURES, which, u, v, lanes)
    for got in (np.stack(texture_lookup.height_gradient(TEXELS, PICTURES, which, u, v)), lanes):
        assert np.abs(got - expected).max() < 1e-5
