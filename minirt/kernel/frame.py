"""A frame: the rays of the camera through every pixel, and the picture that they bring back."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.kernel.shade import radiance
from minirt.kernel.traced import Traced
from minirt.lanes import WIDTH, Vec, dot, floor, lane, load, maximum, minimum, splat, sqrt
from minirt.lanes.vec import Number

ACROSS, DOWN = 4, WIDTH // 4  # pixels of a packet: the rays that are traced at once
TILE = 16  # pixels along an edge of a tile: a thread takes a row of tiles at a time
CANCELLED = 2**40  # a row that no picture has
OPAQUE = float(0xFF000000)  # alpha of a pixel
PACKET = np.array([*(i % ACROSS for i in range(WIDTH)), *(i // ACROSS for i in range(WIDTH))], np.float64)


def camera_ray(camera: Any, width: int, height: int, x: Number, y: Number) -> tuple[Vec, Vec]:
    """Origin and unit direction of the ray through a place of the picture, in pixels from its upper left corner."""
    right = 2.0 * x / width - 1.0
    up = 1.0 - 2.0 * y / height
    direction = (
        Vec(camera[9], camera[10], camera[11])
        + right * Vec(camera[3], camera[4], camera[5])
        + up * Vec(camera[6], camera[7], camera[8])
    )
    return Vec(camera[0], camera[1], camera[2]), direction / sqrt(dot(direction, direction))


def packet(scene: Traced, tile: int, width: int, height: int, samples: Any, pixels: Any, x: int, y: int) -> Vec:
    """The light of the pixels of a packet whose upper left one is x, y: the mean of their samples."""
    across = load(pixels, 0) + x
    down = load(pixels, WIDTH) + y
    total = Vec(splat(0.0), splat(0.0), splat(0.0))
    for i in range(samples.shape[0]):
        origin, direction = camera_ray(scene.camera, width, height, across + samples[i, 0], down + samples[i, 1])
        total = total + radiance(scene, tile, origin, direction)
    return total / samples.shape[0]


def level(light: Number) -> Number:
    """Light in [0, 1] as a byte, rounded to nearest; what lies outside is clamped, and NaN is black."""
    return floor(minimum(maximum(light, 0.0), 1.0) * 255.0 + 0.5)


def frame(next_row: Any, pixels: Any, linear: Any, samples: Any, offsets: Any, scene: Traced) -> None:
    """Render rows of tiles, taking the next one from the counter `next_row` until none is left.

    Any number of threads may do so at the same time. `pixels` (h, w) takes 0xAARRGGBB; `linear` (h, w, 3), or one
    without rows where it is not wanted, takes the light as it is. `samples` (k, 2) are places in a pixel, `offsets` is
    `PACKET`. A counter set to `CANCELLED` from outside ends the frame at the next packet.
    """
    height, width = pixels.shape
    while True:
        top = fetch_add(next_row, TILE)
        if top >= height:
            return
        first_tile = top // TILE * tiles(width)
        for y in range(top, min(top + TILE, height), DOWN):
            for x in range(0, width, ACROSS):
                if next_row[0] >= CANCELLED:
                    return
                tile = first_tile + x // TILE
                store(pixels, linear, x, y, packet(scene, tile, width, height, samples, offsets, x, y))


def tiles(pixels: int) -> int:
    """Tiles that it takes to cover so many pixels."""
    return (pixels + TILE - 1) // TILE


def store(pixels: Any, linear: Any, x: int, y: int, light: Vec) -> None:
    """Put the light of a packet into the picture; what lies beyond its edges is dropped."""
    height, width = pixels.shape
    keep = linear.shape[0] > 0
    colour = OPAQUE + level(light.x) * 65536.0 + level(light.y) * 256.0 + level(light.z)
    if x + ACROSS <= width and y + DOWN <= height and not keep:
        store_block(pixels, x, y, colour)
        return
    for i in range(WIDTH):
        column, line = x + i % ACROSS, y + i // ACROSS
        if column < width and line < height:
            pixels[line, column] = int(lane(colour, i))
            if keep:
                linear[line, column, 0] = lane(light.x, i)
                linear[line, column, 1] = lane(light.y, i)
                linear[line, column, 2] = lane(light.z, i)


def store_block(pixels: Any, x: int, y: int, colour: Number) -> None:
    """Put a whole packet into the picture; compiled, a row of it at a time."""
    for i in range(WIDTH):
        pixels[y + i // ACROSS, x + i % ACROSS] = int(lane(colour, i))


def fetch_add(counter: Any, amount: int) -> int:
    """Add to a counter that threads share, and return what it was before."""
    before = int(counter[0])
    counter[0] += amount
    return before
