"""Camera and lens as numbers, and the primary rays of a picture or of a rectangle of it.

A rectangle that is rendered begins at the corner of a tile, so that its tiles and packets are those of the whole
picture. A region anywhere else is cut out of the rectangle that begins with its first tile.

With a lens, or with lights that have a size, each pixel takes a lattice of points in the square for the lens, and
another for the lights, both shifted at random and wrapped around (Cranley and Patterson 1976), in random order:
neighbouring pixels, and the dimensions of one pixel, have nothing in common.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import chain
from math import cos, pi, radians, sin, tan
from operator import index
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from minirt.errors import RenderError
from minirt.fields import Triple, clamp, upright
from minirt.kernel.pixels import PACKET_HEIGHT, TILE
from minirt.lanes import Vec
from minirt.scene import Camera, Scene
from minirt.scene.elements import linear_combination


class Region(NamedTuple):
    """A rectangle of a picture, in pixels from its upper left corner; written as on the command line."""

    x: int
    y: int
    width: int
    height: int

    def __str__(self) -> str:
        return ",".join(map(str, self))


class Crop(NamedTuple):
    """Place of a rendered rectangle in its picture. The size of the rectangle is that of the pixels to render into."""

    width: int  # of the whole picture, in pixels
    height: int
    left: int = 0  # column and row of the picture at which the rectangle begins: multiples of `TILE`
    top: int = 0


Place: TypeAlias = tuple[int, int, Crop]  # width and height of the rectangle to render, and where it is


class Request(NamedTuple):
    """A picture to render: of which scene, and into which arrays."""

    scene: Scene
    pixels: np.ndarray  # C-contiguous uint8 (h, w, 4) in the order blue, green, red, alpha
    linear: Any = None  # float64 (h, w, 3), if its light is wanted; without rows where nobody wants it
    crop: Crop | None = None  # None: the whole picture


class Cut(NamedTuple):
    """The rectangle to render for a region, and what to keep of it."""

    crop: Crop
    shape: tuple[int, int]  # rows and columns of the rectangle
    kept: tuple[slice, slice]  # those of the region
    region: Region


def cut_for(region: tuple[int, int, int, int] | None, width: int, height: int) -> Cut:
    """Return what to render for a region (x, y, width, height) of a picture, or for all of it; RenderError for a region
    that does not lie in the picture."""
    try:
        region = Region._make(map(index, (0, 0, width, height) if region is None else region))
    except (TypeError, ValueError):
        raise RenderError(f"region must be 4 whole numbers, got {region!r}") from None
    x, y, across, down = region
    if across < 1 or down < 1:
        raise RenderError(f"a region has at least 1x1 pixels, got {across}x{down}")
    if x < 0 or y < 0 or x + across > width or y + down > height:
        raise RenderError(f"region {region} does not lie in the picture of {width}x{height} pixels")
    beside, above = x % TILE, y % TILE
    crop = Crop(width, height, x - beside, y - above)
    return Cut(crop, (above + down, beside + across), (slice(above, None), slice(beside, None)), region)


NARROWEST, WIDEST = 1e-6, 179.9999  # degrees; fields of view of 0 and 180 are drawn as these


def camera_frame(camera: Camera) -> tuple[Triple, Triple, Triple]:
    """Return the basis of a camera's picture in world space: the orthonormal vectors right, up and forward.

    Without a roll the picture is upright; `upright` says what that is in a view straight up or down. A roll turns right
    and up about forward, clockwise as the camera sees it. A left-handed camera mirrors its picture: right is negated.
    """
    x, y, z = camera.direction
    right, up = upright(x, y, z)
    if camera.roll:
        c, s = cos(radians(camera.roll)), sin(radians(camera.roll))
        right, up = linear_combination(c, right, -s, up), linear_combination(s, right, c, up)
    if camera.left_handed:
        right = (-right[0], -right[1], -right[2])
    return right, up, (x, y, z)


def camera_numbers(camera: Camera, width: int, height: int) -> np.ndarray:
    """Eye, right, up and forward, (12,); right and up reach from the centre of the image plane, at distance 1, to its
    edges."""
    right, up, forward = camera_frame(camera)
    across, down = slopes_at_edges(camera, width, height)
    return np.array([*camera.position, *(across * part for part in right), *(down * part for part in up), *forward])


def middle_ray(numbers: np.ndarray) -> tuple[Vec, Vec]:
    """The origin and the unit direction of the ray through the centre of a picture with these `camera_numbers`."""
    return Vec(*numbers[:3]), Vec(*numbers[9:12])


def slopes_at_edges(camera: Camera, width: int, height: int) -> tuple[float, float]:
    """The slopes, to the side and up, of the directions through the edges of a camera's picture."""
    half = tan(radians(clamp(camera.fov, NARROWEST, WIDEST)) / 2)
    return half, half * height / width


STEPS = slice(6, 12)  # of `pixel_rays`: the changes of the direction a pixel to the right and a pixel down


def pixel_rays(camera: Camera, width: int, height: int) -> list[float]:
    """Eye, direction through the upper left corner of the picture, and the changes of that direction a pixel to the
    right and a pixel down, 12 numbers."""
    across, down = slopes_at_edges(camera, width, height)
    axes = ((across * x, down * y, z) for x, y, z in zip(*camera_frame(camera), strict=True))
    columns = ((z - x + y, 2 / width * x, -2 / height * y) for x, y, z in axes)
    return [*camera.position, *chain.from_iterable(zip(*columns, strict=True))]


def packet_rays(steps: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The directions of rays of a packet, (k, 3 * width), as differences from the direction through the upper left
    corner of the packet.

    `steps` (6,) are the changes in `pixel_rays`; `places` are those of `packet_places`.
    """
    differences: np.ndarray = steps.reshape(2, 3).T @ places.swapaxes(1, 2)
    return differences.reshape(len(places), -1).astype(steps.dtype)


def packet_places(rays: int, samples: np.ndarray) -> np.ndarray:
    """The x and y of samples of all pixels of a packet, in pixels from its upper left corner, (k, rays, 2).

    `samples` are positions in a pixel, (k, 2), or (k, rays, 2) where each pixel of a packet has its own.
    """
    row, column = np.divmod(np.arange(rays), rays // PACKET_HEIGHT)
    places: np.ndarray = np.stack([column, row], axis=-1) + samples.reshape(len(samples), -1, 2)
    return places


def by_pixel(places: np.ndarray, samples: int) -> np.ndarray:
    """Arrange the numbers of samples, (k, rays, n), so that all `samples` of a pixel follow each other."""
    return places.reshape(-1, samples, *places.shape[1:]).swapaxes(1, 2).reshape(places.shape)


# The lens: a disc in the image plane, through whose points the eye looks at what is in focus.


CLOSEST = 2.0**-60  # least distance of what is in focus, in radii of the lens: squares of directions stay finite
SMALLEST = 2.0**-100  # least such distance, in scene units: its reciprocal is finite in single precision, too


def lens_numbers(camera: Camera, focus: float) -> np.ndarray:
    """The half axes of the lens, to the right and up, and one over the distance of what is in focus, (7,).

    A distance that is too small for arithmetic is replaced by the least that is not."""
    right, up, _ = camera_frame(camera)
    radius = (camera.lens or 0.0) / 2
    nearest = max(focus, radius * CLOSEST, SMALLEST)
    return np.array([*(radius * x for x in right), *(radius * x for x in up), 1.0 / nearest])


def radius_and_focus(lens: np.ndarray | None) -> tuple[float, float]:
    """The radius of a lens, and one over the distance of what is in focus; 0 and 0 without a lens."""
    return (0.0, 0.0) if lens is None else (float(np.linalg.norm(lens[:3])), float(lens[6]))


GOLDEN_RATIO = (5**0.5 - 1) / 2  # its conjugate, 0.618...
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
