"""Draws the pictures of scenes/textures: python assets/make_textures.py

A planet, bricks with their heights and normals, water, and a sky of stars. All of it is drawn from noise with fixed
seeds, so that the same pictures come out again, and those that are wrapped around something have no seam.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

FOLDER = Path(__file__).parent.parent / "scenes" / "textures"
Array = np.ndarray


def lattice(seed: int, cells: Array) -> Array:
    """A random number in [0, 1) for each whole point of space; `cells` are (..., 3)."""
    x, y, z = (cells[..., axis].astype(np.uint64) for axis in range(3))
    mixed = x * np.uint64(73856093) ^ y * np.uint64(19349663) ^ z * np.uint64(83492791) ^ np.uint64(seed * 2654435761)
    for shift, factor in ((33, 0xFF51AFD7ED558CCD), (33, 0xC4CEB9FE1A85EC53), (33, 1)):  # Appleby, MurmurHash3
        mixed = (mixed ^ mixed >> np.uint64(shift)) * np.uint64(factor)
    return (mixed >> np.uint64(11)).astype(np.float64) * 2.0**-53


def noise(seed: int, points: Array, period: Array | None = None) -> Array:
    """Smooth noise in [0, 1] at places of space (..., 3), one bump a unit; it repeats after `period` (Perlin 1985)."""
    below = np.floor(points)
    part = points - below
    weight = part * part * (3 - 2 * part)
    total = np.zeros(points.shape[:-1])
    for corner in np.ndindex(2, 2, 2):
        cells = below + corner
        cells = (np.mod(cells, period) if period is not None else cells + 1000).astype(np.int64)
        total += np.prod(np.where(corner, weight, 1 - weight), axis=-1) * lattice(seed, cells)
    return total


def fractal(seed: int, points: Array, octaves: int, period: Array | None = None) -> Array:
    """Noise of all sizes: each octave is half as large and half as strong as the one before it."""
    total, share = np.zeros(points.shape[:-1]), 0.0
    for octave in range(octaves):
        scale = 2**octave
        repeated = None if period is None else period * scale
        total += noise(seed + octave, points * scale, repeated) / scale
        share += 1 / scale
    return total / share


def globe(width: int, height: int) -> Array:
    """The points of the unit sphere that the pixels of a map show: longitude across, latitude down."""
    longitude = 2 * np.pi * (np.arange(width) + 0.5) / width
    latitude = np.pi * (0.5 - (np.arange(height) + 0.5) / height)
    around = np.cos(latitude)[:, None]
    up = np.broadcast_to(np.sin(latitude)[:, None], (height, width))
    return np.stack([around * np.cos(longitude), up, around * np.sin(longitude)], axis=-1)


def tile(width: int, height: int, across: int, down: int) -> tuple[Array, Array]:
    """Points of a plane with `across` by `down` units in a picture, and the period that makes it fit to itself."""
    y, x = np.mgrid[:height, :width] + 0.5
    return np.stack([x * across / width, y * down / height, np.zeros_like(x)], axis=-1), np.array([across, down, 1])


def shades(at: Array, stops: list[tuple[float, str]]) -> Array:
    """Colours, (..., 3) in [0, 255], between those of the stops."""
    places = [place for place, _ in stops]
    colours = np.array([[int(code[i : i + 2], 16) for i in (0, 2, 4)] for _, code in stops], float)
    return np.stack([np.interp(at, places, colours[:, part]) for part in range(3)], axis=-1)


def planet(width: int = 1024, height: int = 512) -> Array:
    """Seas, land by height and latitude, ice at the poles, clouds over all of it."""
    points = globe(width, height)
    land = fractal(1, 1.7 * points + 0.4 * fractal(40, 3 * points, 4)[..., None], 8) - 0.53
    sea = shades(land, [(-0.2, "061f4f"), (-0.05, "0d3b7a"), (0.0, "2c7fa8")])
    ground = shades(land, [(0.0, "c9b98a"), (0.01, "5c8a3c"), (0.1, "3c6b2c"), (0.2, "7a6a4a"), (0.3, "e8e8e8")])
    heat = 1 - np.abs(points[..., 1]) + 0.25 * (fractal(20, 3 * points, 5) - 0.5)
    belt = np.abs(np.abs(points[..., 1] + 0.4 * (fractal(35, 2 * points, 5) - 0.5)) - 0.35)
    dry = np.clip(1.4 - belt / 0.14, 0, 1) * np.clip(6 * (fractal(30, 2 * points, 5) - 0.42), 0, 1)
    ground += 0.9 * dry[..., None] * ([205, 175, 120] - ground)
    colour = np.where((land > 0)[..., None], ground, sea)
    colour += np.clip((0.06 - heat) / 0.04, 0, 1)[..., None] * ([242, 246, 250] - colour)
    swirl = 2.2 * points + 0.9 * fractal(60, 2 * points, 4)[..., None]
    cloud = np.clip(4 * (fractal(50, swirl, 7) - 0.53), 0, 0.85)[..., None]
    return colour + cloud * (255 - colour)


ROWS, COLUMNS = 8, 4  # bricks in the picture
JOINT = 0.06  # of a row's height: half a joint


def bricks(width: int = 512, height: int = 512) -> tuple[Array, Array]:
    """Colour, and height in [0, 1], of a wall of bricks that fits to itself on all sides."""
    y, x = np.mgrid[:height, :width] + 0.5
    row = np.floor(y * ROWS / height)
    column = x * COLUMNS / width + 0.5 * (row % 2)
    across, down = column % 1, y * ROWS / height % 1
    edge = np.minimum(np.minimum(across, 1 - across) * (width / COLUMNS) / (height / ROWS), np.minimum(down, 1 - down))
    points, period = tile(width, height, 16, 16)
    rough = fractal(7, points, 5, period)
    rise = np.clip((edge + 0.03 * (rough - 0.5) - JOINT) / 0.09, 0, 1)
    rise = rise * rise * (3 - 2 * rise)
    brick = np.stack([np.floor(column) % COLUMNS, row, np.zeros_like(row)], axis=-1).astype(np.int64)
    own = lattice(3, brick)
    heights = rise * (0.72 + 0.16 * own + 0.12 * rough) + (1 - rise) * 0.15 * rough
    clay = shades(own, [(0, "7a3526"), (0.4, "96452f"), (0.75, "a9583d"), (1, "8a4a3a")])
    clay *= (0.72 + 0.5 * rough)[..., None]
    mortar = shades(rough, [(0.2, "8d8880"), (0.8, "c2bcb0")])
    return mortar + rise[..., None] * (clay - mortar), heights


def normals(heights: Array, strength: float) -> Array:
    """The normal map of heights, (h, w, 3) in [0, 255], of a picture that fits to itself.

    The normal is (-dh/du, -dh/dv, 1) at unit length; u goes to the right, v up, and white is `strength` times the
    picture's width above black.
    """
    width = strength * heights.shape[1]
    du = width * (np.roll(heights, -1, 1) - np.roll(heights, 1, 1)) / 2
    dv = width * (np.roll(heights, 1, 0) - np.roll(heights, -1, 0)) / 2
    normal = np.stack([-du, -dv, np.ones_like(du)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return 127.5 + 127.5 * normal


def water(size: int = 256) -> Array:
    """Heights in [0, 1] of waves from all sides that fit to themselves."""
    y, x = np.mgrid[:size, :size] / size
    random = np.random.default_rng(5)
    total = np.zeros((size, size))
    for _ in range(60):
        across, down = random.integers(-9, 10, 2)
        steep = 1 / (1 + np.hypot(across, down)) ** 1.2
        wave = 0.5 + 0.5 * np.sin(2 * np.pi * (across * x + down * y + random.random()))
        total += steep * wave**2  # narrow crests, wide troughs
    return (total - total.min()) / np.ptp(total)


def stars(width: int = 1024, height: int = 512) -> Array:
    """A map of the sky: stars evenly on the sphere, few bright and many faint ones, and a band of mist."""
    points = globe(width, height)
    pole = np.array([0.48, 0.8, 0.36])
    off = points @ (pole / np.linalg.norm(pole))
    mist = fractal(11, 3 * points, 7)
    band = np.exp(-((off / 0.16) ** 2)) * np.clip(2.6 * (mist - 0.3), 0, 1)
    dust = np.exp(-((off / 0.05) ** 2)) * np.clip(3 * (fractal(17, 5 * points, 6) - 0.42), 0, 1)
    glow = np.clip(band - 0.8 * dust, 0, 1)[..., None]
    colour = np.array([4.0, 5, 12]) + glow * [122, 114, 136]
    random = np.random.default_rng(2)
    count = 5000
    latitude, longitude = np.arcsin(random.uniform(-1, 1, count)), random.uniform(0, 1, count)
    light = 45 * random.random(count) ** -0.6
    tint = shades(random.random(count), [(0, "ffd0a0"), (0.4, "ffffff"), (1, "b0c8ff")]) / 255
    row = (0.5 - latitude / np.pi) * height
    wide = 0.55 / np.maximum(np.cos(latitude), 0.05)  # near the poles a map stretches everything across
    for y, x, w, bright, hue in zip(row, longitude * width, wide, light, tint, strict=True):
        j = np.arange(max(0, int(y) - 3), min(height, int(y) + 4))
        i = np.arange(int(x - 4 * w) - 2, int(x + 4 * w) + 3)
        spot = np.exp(-(((j + 0.5 - y) / 0.55) ** 2))[:, None] * np.exp(-(((i + 0.5 - x) / w) ** 2))
        colour[j[:, None], i % width] += min(bright, 700) * spot[..., None] * hue
    return colour


def save(name: str, pixels: Array, colours: int = 0) -> None:
    """Write a picture, of so many colours where that is not 0."""
    image = Image.fromarray(np.rint(np.clip(pixels, 0, 255)).astype(np.uint8))
    if colours:
        image = image.quantize(colours, dither=Image.Dither.FLOYDSTEINBERG)
    image.save(FOLDER / name, optimize=True)


def main() -> None:
    """Draw all of them."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    colour, heights = bricks()
    waves = water()
    save("planet.png", planet(), 128)
    save("bricks.png", colour, 64)
    save("bricks-height.png", 255 * heights)
    save("bricks-normal.png", normals(heights, 0.02), 256)
    save("water-height.png", 255 * waves)
    save("water-normal.png", normals(waves, 0.05))
    save("stars.png", stars(), 64)


if __name__ == "__main__":
    main()
