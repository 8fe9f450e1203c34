"""Rays of packets whose samples have eyes in a lens and points of lights of their own.

Each pixel takes a lattice of points in the square for the lens, and another for the lights, both shifted at random and
wrapped around (Cranley and Patterson 1976), in random order: neighbouring pixels, and the dimensions of one pixel, have
nothing in common.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi
from typing import Any

import numpy as np

GOLDEN_RATIO = (5**0.5 - 1) / 2
VARIANTS = 64  # of the places of a packet, where samples are few
ROWS = 512  # of samples, that more than one variant may take


def has_apertures(arrays: Any) -> bool:
    """Whether a packed scene has a lens or a light with a size."""
    return arrays.soft is not None or arrays.lens is not None


def variants_of(samples: int) -> int:
    """The number of variants of a packet's places; each packet takes one of them."""
    return min(max(ROWS // samples, 1), VARIANTS)


@lru_cache(32)
def aperture_places(samples: int, variants: int, pixels: int, seed: int) -> np.ndarray:
    """Places in the unit discs of lens and lights for each sample, (variants * samples, pixels, 4)."""
    random = np.random.Generator(np.random.PCG64([samples, seed]))
    index = np.arange(samples)
    lattice = np.stack([(index + 0.5) / samples, (index * GOLDEN_RATIO) % 1.0], axis=1)
    places = np.empty((variants, samples, pixels, 4))
    for variant in range(variants):
        for first in (0, 2):
            shifted = random.permutation(lattice)[:, None] + random.random((pixels, 2))
            shifted -= shifted >= 1.0
            places[variant, ..., first : first + 2] = in_disc(shifted)
    return places.reshape(variants * samples, pixels, 4)


def in_disc(square: np.ndarray) -> np.ndarray:
    """Map the unit square to the unit disc, keeping ratios of areas (Shirley and Chiu, A low distortion map between
    disk and square, 1997)."""
    x, y = np.moveaxis(2.0 * square - 1.0, -1, 0)
    is_beside = np.abs(x) > np.abs(y)
    radius = np.where(is_beside, x, y)
    with np.errstate(invalid="ignore", divide="ignore"):
        angle = np.where(is_beside, pi / 4 * (y / x), pi / 2 - pi / 4 * (x / y))
    angle = np.where(radius == 0.0, 0.0, angle)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def with_apertures(rays: np.ndarray, places: np.ndarray, lens: np.ndarray | None) -> np.ndarray:
    """Add to the directions of rays, (k, 3 * width), what `minirt.kernel.shading.lights` needs: (k, 8 * width).

    `places` (k, width, 4) are those of `aperture_places`; 0 is the centre of the lens and of the lights.
    """
    count, number = len(rays), rays.dtype
    offsets = np.zeros((count, 3, places.shape[1]))
    if lens is not None and len(lens):
        offsets += np.moveaxis(places[..., :2] @ lens[:6].reshape(2, 3), -1, 1)
        rays = rays - (lens[6] * offsets).reshape(count, -1)
    disc = np.moveaxis(places[..., 2:], -1, 1)
    joined: np.ndarray = np.concatenate([rays, offsets.reshape(count, -1), disc.reshape(count, -1)], axis=1)
    return joined.astype(number, copy=False)
