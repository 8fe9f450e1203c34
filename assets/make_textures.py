"""Draws the pictures of scenes/textures: python assets/make_textures.py [FOLDER]

A planet and bricks with their heights, water, and skies in the evening and at night are drawn from noise with fixed
seeds, so that the same pictures come out again, and those that are wrapped around something have no seam. A chart shows
how u and v run.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

FOLDER = Path(__file__).parent.parent / "scenes" / "textures"
FACTORS, SEEDS = (73856093, 19349663, 83492791), 2654435761  # hash factors for each axis, and for the seed
BLOCK = 8192  # points of noise that are computed at a time
Array = np.ndarray


def mixed(hashes: Array) -> Array:
    """Turn integers into random numbers in [0, 1), in place."""
    for factor in (0xFF51AFD7ED558CCD, 0xC4CEB9FE1A85EC53):  # Appleby, MurmurHash3
        hashes ^= hashes >> np.uint64(33)
        hashes *= np.uint64(factor)
    hashes ^= hashes >> np.uint64(33)
    return (hashes >> np.uint64(11)) * 2.0**-53


def lattice(seed: int, x: Array, y: Array, z: Array) -> Array:
    """Return a random number in [0, 1) for each point of the integer lattice, with coordinates of at least 0."""
    parts = (axis.astype(np.uint64) * np.uint64(factor) for axis, factor in zip((x, y, z), FACTORS, strict=True))
    return mixed(np.bitwise_xor.reduce([*parts]) ^ np.uint64(seed * SEEDS))


def noise(seed: int, points: Array, period: Array | None = None) -> Array:
    """Return smooth noise in [0, 1] at points (..., 3), one bump per unit, with a period (Perlin 1985)."""
    each = points.reshape(-1, 3)
    parts = [block_of_noise(seed, each[start : start + BLOCK], period) for start in range(0, len(each), BLOCK)]
    return np.concatenate([np.zeros(0), *parts]).reshape(points.shape[:-1])


def block_of_noise(seed: int, points: Array, period: Array | None) -> Array:
    """Compute `noise` for one block of points, whose intermediate values fit a processor's cache."""
    below = np.floor(points)
    part = points - below
    weight = part * part * (3 - 2 * part)
    # For each axis: the hash terms of the lattice points on both sides, and their interpolation weights.
    hashes, shares = [], []
    for axis, factor in enumerate(FACTORS):
        for corner in (0, 1):
            side = below[:, axis] + corner
            cell = side + 1000 if period is None else side % period[axis]
            hashes.append(cell.astype(np.uint64) * np.uint64(factor))
            shares.append(weight[:, axis] if corner else 1 - weight[:, axis])
    total = np.zeros(len(points))
    for i, j in np.ndindex(2, 2):
        line, share = hashes[i] ^ hashes[2 + j] ^ np.uint64(seed * SEEDS), shares[i] * shares[2 + j]
        for k in (0, 1):
            total += share * shares[4 + k] * mixed(line ^ hashes[4 + k])
    return total


def fractal(seed: int, points: Array, octaves: int, period: Array | None = None) -> Array:
    """Sum octaves of noise, each half as large and half as strong as the one before."""
    total, share = np.zeros(points.shape[:-1]), 0.0
    for octave in range(octaves):
        scale = 2**octave
        repeated = None if period is None else period * scale
        total += noise(seed + octave, points * scale, repeated) / scale
        share += 1 / scale
    return total / share


def globe(width: int, height: int) -> Array:
    """Return the points of the unit sphere for the pixels of a map: longitude across, latitude down."""
    longitude = 2 * np.pi * (np.arange(width) + 0.5) / width
    latitude = np.pi * (0.5 - (np.arange(height) + 0.5) / height)
    around = np.cos(latitude)[:, None]
    up = np.broadcast_to(np.sin(latitude)[:, None], (height, width))
    return np.stack([around * np.cos(longitude), up, around * np.sin(longitude)], axis=-1)


def tile(width: int, height: int, across: int, down: int) -> tuple[Array, Array]:
    """Return the points of a plane of `across` by `down` units, and the period that makes the picture tile."""
    y, x = np.mgrid[:height, :width] + 0.5
    return np.stack([x * across / width, y * down / height, np.zeros_like(x)], axis=-1), np.array([across, down, 1])


def shades(at: Array, stops: list[tuple[float, str]]) -> Array:
    """Interpolate colours, (..., 3) in [0, 255], between stops."""
    places = [place for place, _ in stops]
    colours = np.array([[int(code[i : i + 2], 16) for i in (0, 2, 4)] for _, code in stops], float)
    return np.stack([np.interp(at, places, colours[:, part]) for part in range(3)], axis=-1)


def planet(width: int = 1024, height: int = 512) -> tuple[Array, Array]:
    """Draw a planet: its colours (seas, land by height and latitude, polar ice, clouds) and heights in [0, 1]."""
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
    return colour + cloud * (255 - colour), np.clip(3.5 * land, 0, 1)


ROWS, COLUMNS = 8, 4  # bricks in the picture
JOINT = 0.06  # half the width of a joint, in heights of a row


def bricks(width: int = 512, height: int = 512) -> tuple[Array, Array]:
    """Draw a tiling brick wall: its colours, and its heights in [0, 1]."""
    y, x = np.mgrid[:height, :width] + 0.5
    row = np.floor(y * ROWS / height)
    column = x * COLUMNS / width + 0.5 * (row % 2)
    across, down = column % 1, y * ROWS / height % 1
    edge = np.minimum(np.minimum(across, 1 - across) * (width / COLUMNS) / (height / ROWS), np.minimum(down, 1 - down))
    points, period = tile(width, height, 16, 16)
    rough = fractal(7, points, 5, period)
    rise = np.clip((edge + 0.03 * (rough - 0.5) - JOINT) / 0.09, 0, 1)
    rise = rise * rise * (3 - 2 * rise)
    own = lattice(3, np.floor(column) % COLUMNS, row, np.zeros_like(row))
    heights = rise * (0.72 + 0.16 * own + 0.12 * rough) + (1 - rise) * 0.15 * rough
    clay = shades(own, [(0, "7a3526"), (0.4, "96452f"), (0.75, "a9583d"), (1, "8a4a3a")])
    clay *= (0.72 + 0.5 * rough)[..., None]
    mortar = shades(rough, [(0.2, "8d8880"), (0.8, "c2bcb0")])
    return mortar + rise[..., None] * (clay - mortar), heights


def normals(heights: Array, strength: float) -> Array:
    """Compute the normal map, (h, w, 3) in [0, 255], of a tiling height map.

    The normal is (-dh/du, -dh/dv, 1) at unit length, 128 for 0 and 255 for 1; u goes to the right, v up, and white is
    `strength` times the picture's width above black.
    """
    width = strength * heights.shape[1]
    du = width * (np.roll(heights, -1, 1) - np.roll(heights, 1, 1)) / 2
    dv = width * (np.roll(heights, 1, 0) - np.roll(heights, -1, 0)) / 2
    normal = np.stack([-du, -dv, np.ones_like(du)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return 128 + 127 * normal


def water(size: int = 256) -> Array:
    """Draw a tiling height map in [0, 1] of waves from all directions."""
    y, x = np.mgrid[:size, :size] / size
    random = np.random.default_rng(5)
    total = np.zeros((size, size))
    for _ in range(60):
        across, down = random.integers(-9, 10, 2)
        steep = 1 / (1 + np.hypot(across, down)) ** 1.2
        wave = 0.5 + 0.5 * np.sin(2 * np.pi * (across * x + down * y + random.random()))
        total += steep * wave**2  # narrow crests, wide troughs
    return (total - total.min()) / np.ptp(total)


def stars(width: int = 2048, height: int = 1024) -> Array:
    """Draw an environment map of stars: uniform over the sphere, few bright and many faint, with a band of mist."""
    points = globe(width, height)
    pole = np.array([0.48, 0.8, 0.36])
    off = points @ (pole / np.linalg.norm(pole))
    near = np.abs(off) < 0.4  # pixels with mist
    off, mist, dust = off[near], fractal(11, 3 * points[near], 7), fractal(17, 5 * points[near], 6)
    band = np.exp(-((off / 0.16) ** 2)) * np.clip(2.6 * (mist - 0.3), 0, 1)
    band -= 0.9 * np.exp(-((off / 0.05) ** 2)) * np.clip(3 * (dust - 0.42), 0, 1)
    glow = np.zeros((height, width, 1))
    glow[near, 0] = 1 - np.exp(-1.2 * np.clip(band, 0, 1))
    colour = np.array([4.0, 5, 12]) + glow * [124, 116, 140]
    random = np.random.default_rng(2)
    count = 9000
    latitude, longitude = np.arcsin(random.uniform(-1, 1, count)), random.uniform(0, 1, count)
    light = 40 * random.random(count) ** -0.6
    tint = shades(random.random(count), [(0, "ffd0a0"), (0.4, "ffffff"), (1, "b0c8ff")]) / 255
    row = (0.5 - latitude / np.pi) * height
    wide = 0.55 / np.maximum(np.cos(latitude), 0.05)  # near the poles a map stretches everything across
    for y, x, w, bright, hue in zip(row, longitude * width, wide, light, tint, strict=True):
        j = np.arange(max(0, int(y) - 3), min(height, int(y) + 4))
        i = np.arange(int(x - 4 * w) - 2, int(x + 4 * w) + 3)
        spot = np.exp(-(((j + 0.5 - y) / 0.55) ** 2))[:, None] * np.exp(-(((i + 0.5 - x) / w) ** 2))
        colour[j[:, None], i % width] += min(bright, 700) * spot[..., None] * hue
    return colour


SUN = np.array([0.55, 0.09, 0.83])  # direction of the evening sun: low, and left of the middle


def evening(width: int = 1024, height: int = 512) -> Array:
    """Draw an environment map of the evening sky: gold, rose and blue, with clouds lit from below."""
    points = globe(width, height)[..., ::-1] * [1, 1, -1]  # its middle is +z, and right of that is -x
    up = points[..., 1]
    near = np.clip(points @ (SUN / np.linalg.norm(SUN)), 0, 1)[..., None]
    heights = [-1, -0.02, 0, 0.12, 0.42, 1]
    cold = shades(up, list(zip(heights, ["20242e", "4a4a58", "8d7c8c", "9a8ea8", "5a78b0", "22407e"], strict=True)))
    warm = shades(up, list(zip(heights, ["2a2624", "6a5044", "ffb060", "f59a70", "9a86b0", "2c4a88"], strict=True)))
    colour = cold + near**2 * (warm - cold)
    # Clouds lie on a level plane above: towards the horizon they close up, and fade into haze.
    high = np.maximum(up, 0.02)[..., None]
    flat = np.concatenate([points[..., ::2] / (high + 0.12), np.zeros_like(high)], axis=-1)
    puffs = fractal(70, 1.3 * flat, 6) + 0.15 * (fractal(80, 0.5 * flat, 2) - 0.5)
    thick = np.clip(4.5 * (puffs - 0.5), 0, 1) * np.clip(up / 0.12, 0, 1)
    lit = shades(near[..., 0] ** 3, [(0, "8a84a0"), (0.3, "d8a0a0"), (0.8, "ffc890"), (1, "fff0d0")])
    colour += (0.85 * thick * (1 - 0.35 * thick))[..., None] * (lit - colour)
    above = np.clip((up + 0.01) / 0.02, 0, 1)[..., None]
    return colour + above * (near**600 * 400 + near**40 * 60) * np.array([1, 0.85, 0.6])


def chart(size: int = 512, cells: int = 8) -> Array:
    """Draw u, to the right and red, and v, upwards and green: lines for eighths, two arrows, and the corners' u,v."""
    at = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(at, at[::-1])
    even = (np.floor(u * cells) + np.floor(v * cells)) % 2 == 0
    colours = np.stack([60 + 170 * u, 60 + 170 * v, np.full_like(u, 60)], axis=-1) + 25.0 * even[..., None]
    line = (np.minimum(u * cells % 1, v * cells % 1) * size / cells < 2)[..., None]
    picture = Image.fromarray(np.where(line, 25, colours).astype(np.uint8))
    pen, middle, end, edge = ImageDraw.Draw(picture), size // 2, size * 3 // 4, 10
    for x, left in ((0, "l"), (1, "r")):
        for y, low in ((0, "s"), (1, "t")):
            place = (edge, size - edge)[x], (size - edge, edge)[y]
            pen.text(place, f"{x},{y}", "white", ImageFont.load_default(44), left + low)
    pen.line([middle, size - end, middle, middle, end, middle], "white", 10)
    pen.polygon([end + 30, middle, end - 10, middle - 22, end - 10, middle + 22], "white")
    pen.polygon([middle, size - end - 30, middle - 22, size - end + 10, middle + 22, size - end + 10], "white")
    pen.text((end - 30, middle + 56), "u", "white", ImageFont.load_default(80), "mm")
    pen.text((middle - 50, size - end + 20), "v", "white", ImageFont.load_default(80), "mm")
    return np.asarray(picture)


def save(folder: Path, name: str, pixels: Array, colours: int = 0) -> None:
    """Write a picture, reduced to `colours` colours unless that is 0."""
    image = Image.fromarray(np.rint(np.clip(pixels, 0, 255)).astype(np.uint8))
    if colours:
        image = image.quantize(colours, dither=Image.Dither.FLOYDSTEINBERG)
    image.save(folder / name, optimize=True)


def main(folder: Path = FOLDER) -> None:
    """Draw all textures."""
    folder.mkdir(parents=True, exist_ok=True)
    globe_colour, globe_heights = planet()
    wall, wall_heights = bricks()
    waves = water()
    save(folder, "planet.png", globe_colour, 128)
    save(folder, "planet-height.png", 255 * globe_heights.reshape(256, 2, 512, 2).mean(axis=(1, 3)))
    save(folder, "bricks.png", wall, 64)
    save(folder, "bricks-height.png", 255 * wall_heights[::2, ::2])
    save(folder, "bricks-normal.png", normals(wall_heights[::2, ::2], 0.02))
    save(folder, "water-height.png", 255 * waves)
    save(folder, "evening.png", evening())
    save(folder, "stars.png", stars(), 64)
    save(folder, "uv.png", chart())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
