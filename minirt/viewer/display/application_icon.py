"""Icon of the application: a ray-traced ball that reflects a checkered floor, transparent around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minirt.mlx import Image

SIZES = (16, 32, 64)  # pixels of a side
RAYS = 128  # per side: a multiple of all sizes
RADIUS = 0.94  # of the ball, in half sides
BALL, LIGHT_SQUARE, DARK_SQUARE, SKY = (230, 50, 35), (245, 240, 225), (40, 45, 70), (150, 175, 225)  # red, green, blue
MIRROR, AMBIENT = 0.3, 0.2  # shares of reflected and of ambient light
TO_LIGHT = (-0.5, 0.65, 0.572)  # of length 1; x goes right, y up, z to the eye
FLOOR, SQUARE = -1.2, 1.7  # height of the floor and side of a square, in radii
HAZE = 12.0  # distance on the floor at which it takes half of the colour of the sky
SHININESS = 40


def application_icons() -> list[Image]:
    """Draw the icon in all sizes."""
    colour, covered = traced()
    return [Image(reduced(colour, covered, size)) for size in SIZES]


def traced() -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Trace parallel rays of sight: colours (RAYS, RAYS, 3), and whether each of the rays hits the ball."""
    places = ((2 * np.arange(RAYS) + 1) / RAYS - 1) / RADIUS
    x, y = np.meshgrid(places, -places)
    z = np.sqrt(np.maximum(0, 1 - x * x - y * y))
    return shade(np.stack([x, y, z], axis=-1)), z > 0


def dot(vectors: NDArray[np.float64], other: tuple[float, float, float]) -> NDArray[np.float64]:
    """Scalar products; a product of matrices would start the threads of BLAS."""
    return vectors[..., 0] * other[0] + vectors[..., 1] * other[1] + vectors[..., 2] * other[2]


def reduced(colour: NDArray[np.float64], covered: NDArray[np.bool_], size: int) -> NDArray[np.uint8]:
    """Average the rays of each pixel: (size, size, 4) uint8, BGRA."""
    cells = (size, RAYS // size, size, RAYS // size)
    coverage = covered.reshape(cells).mean(axis=(1, 3))
    total = np.where(covered[..., None], colour, 0).reshape(*cells, 3).mean(axis=(1, 3))
    pixels = np.empty((size, size, 4), np.uint8)
    pixels[..., :3] = np.clip(total / np.maximum(coverage, 1e-9)[..., None], 0, 255)[..., ::-1]
    pixels[..., 3] = 255 * coverage
    return pixels


def shade(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colour of a mirroring ball of radius 1, seen along -z, where it has these normals."""
    diffuse = np.maximum(0, dot(normal, TO_LIGHT))
    reflected = 2 * normal[..., 2:] * normal - (0, 0, 1)  # direction of the mirrored ray of sight
    highlight = np.maximum(0, dot(reflected, TO_LIGHT)) ** SHININESS
    own: NDArray[np.float64] = (AMBIENT + (1 - AMBIENT) * diffuse)[..., None] * BALL
    colour: NDArray[np.float64] = (1 - MIRROR) * own + MIRROR * seen(normal, reflected) + 255 * highlight[..., None]
    return colour


def seen(start: NDArray[np.float64], direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colour of the floor, or of the sky, in a direction."""
    down = np.minimum(direction[..., 1], -1e-9)
    floor = start + ((FLOOR - start[..., 1]) / down)[..., None] * direction
    number = np.floor(floor[..., 0] / SQUARE) + np.floor(floor[..., 2] / SQUARE)
    haze = 1 - HAZE / (HAZE + np.hypot(floor[..., 0], floor[..., 2]))[..., None]
    squares = (1 - haze) * np.where((number % 2 == 0)[..., None], LIGHT_SQUARE, DARK_SQUARE) + haze * np.array(SKY)
    return np.where((direction[..., 1] < 0)[..., None], squares, SKY)
