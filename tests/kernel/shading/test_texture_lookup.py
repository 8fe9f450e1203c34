"""Texture lookup: bilinear interpolation and repeat addressing, against weighted sums over all pixels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.shading import texturing
from minirt.lanes import load, save, width
from minirt.rendering.packing.materials import TexturePool
from tests.kernel.pictures import Array

RANDOM = np.random.default_rng(1)
IMAGES = [  # three channels or one; one pixel wide or high; landscape and portrait
    RANDOM.integers(0, 256, shape, np.uint8)
    for shape in ((5, 7, 3), (1, 1, 3), (8, 8, 3), (4, 1, 3), (1, 6, 3), (9, 2, 3))
]
IMAGES += [RANDOM.random(shape).astype(np.float32) for shape in ((6, 4), (1, 1))]
COLOURED = range(6)


def all_pictures() -> tuple[Any, Any]:
    """Return all pictures as the kernel reads them: texels and layout."""
    pool = TexturePool.__new__(TexturePool)
    pool.images = IMAGES
    return tuple(pool.arrays().values())  # type: ignore[return-value]


TEXELS, PICTURES = all_pictures()


@njit(**FLAGS)
def look_up_colours(texels: Any, pictures: Any, which: int, u: Any, v: Any, out: Any) -> None:
    for i in range(0, u.size, width(u)):
        colour = texturing.texture_lookup(texels, pictures, which, load(u, i), load(v, i))
        save(colour.x, out[0], i)
        save(colour.y, out[1], i)
        save(colour.z, out[2], i)


@njit(**FLAGS)
def look_up_gradients(texels: Any, pictures: Any, which: int, u: Any, v: Any, out: Any) -> None:
    for i in range(0, u.size, width(u)):
        slope_u, slope_v = texturing.height_gradient(texels, pictures, which, load(u, i), load(v, i))
        save(slope_u, out[0], i)
        save(slope_v, out[1], i)


def compiled(which: int, u: Array, v: Array) -> Array:
    """Look up colours by the compiled kernel, (n, 3)."""
    out = np.full((3, u.size), np.nan)
    look_up_colours(TEXELS, PICTURES, which, u, v, out)
    return out.T


def interpreted(which: int, u: Array, v: Array) -> Array:
    """Look up colours by the interpreted kernel, (n, 3)."""
    with np.errstate(invalid="ignore"):
        colour = texturing.texture_lookup(TEXELS, PICTURES, which, u, v)
    return np.stack([colour.x, colour.y, colour.z], axis=-1)


Lookup = Callable[[int, Array, Array], Array]
EITHER = pytest.mark.parametrize("lookup", [interpreted, compiled])


def picture_of(which: int) -> Array:
    """Return a picture with channels from 0 to 1, (h, w, channels)."""
    pixels = IMAGES[which]
    return (pixels / 255.0 if pixels.dtype == np.uint8 else pixels.astype(float)).reshape(*pixels.shape[:2], -1)


def weights(count: int, places: Array) -> Array:
    """Return the weight of each of `count` pixels in a row at some places, which may lie beyond [0, 1].

    It is a tent function, two pixels wide, around the centre of the pixel and of each of its repetitions.
    """
    centres = (np.arange(-4 * count, 5 * count) + 0.5) / count
    tents = np.maximum(0, 1 - np.abs(places[:, None] - centres) * count)
    result: Array = tents.reshape(len(places), -1, count).sum(axis=1)
    return result


def expected_colours(which: int, u: Array, v: Array) -> Array:
    """Return the colours of a picture at u, v as weighted sums over all pixels."""
    pixels = picture_of(which)
    down, across = weights(pixels.shape[0], 1 - v), weights(pixels.shape[1], u)
    result: Array = np.einsum("nh,nw,hwc->nc", down, across, pixels)
    return result


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_the_centre_of_a_pixel_has_its_colour(which: int, lookup: Lookup) -> None:
    pixels = picture_of(which)
    height, width = pixels.shape[:2]
    for row in range(height):
        for column in range(width):
            u, v = np.full(16, (column + 0.5) / width), np.full(16, 1 - (row + 0.5) / height)
            assert np.abs(lookup(which, u, v)[0] - pixels[row, column]).max() < 1e-6


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_lookup_is_bilinear_and_repeats_beyond_the_edges(which: int, lookup: Lookup) -> None:
    u, v = np.random.default_rng(which).uniform(-3, 3, (2, 320))
    assert np.abs(lookup(which, u, v) - expected_colours(which, u, v)).max() < 1e-6


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_no_texture_coordinate_leads_out_of_the_picture(which: int, lookup: Lookup) -> None:
    special = np.array([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e17, -1e17, 0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 5e-324])
    u, v = (each.ravel() for each in np.meshgrid(np.resize(special, 16), np.resize(special, 16)))
    got = lookup(which, u, v)
    assert np.isfinite(got).all()
    assert got.min() >= picture_of(which).min() - 1e-6
    assert got.max() <= picture_of(which).max() + 1e-6


@pytest.mark.parametrize("which", range(len(IMAGES)))
def test_gradients_are_central_differences_over_a_pixel(which: int) -> None:
    height, width = IMAGES[which].shape[:2]
    u, v = np.random.default_rng(which).uniform(-2, 2, (2, 160))
    slope_u = expected_colours(which, u + 0.5 / width, v) - expected_colours(which, u - 0.5 / width, v)
    slope_v = expected_colours(which, u, v + 0.5 / height) - expected_colours(which, u, v - 0.5 / height)
    expected = np.stack([slope_u[:, 0] * width, slope_v[:, 0] * height])
    lanes = np.empty((2, 160))
    look_up_gradients(TEXELS, PICTURES, which, u, v, lanes)
    for got in (np.stack(texturing.height_gradient(TEXELS, PICTURES, which, u, v)), lanes):
        assert np.abs(got - expected).max() < 1e-5
