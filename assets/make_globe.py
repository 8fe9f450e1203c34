"""Draws a globe like the Earth, and a sky of stars: python assets/make_globe.py [FOLDER [WIDTH]]

The globe has seas, coasts, climates from rain forest to desert, mountains with snow, polar ice and clouds. It is
drawn from noise with fixed seeds. A smaller width draws the same globe with fewer pixels.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from make_textures import FOLDER, Array, fractal, globe, shades
from PIL import Image

WIDTH = 4096  # pixels of the colours of the globe
LEVEL = 0.535  # of the sea, in heights of noise


def smooth(at: Array, low: float, high: float) -> Array:
    """0 below `low`, 1 above `high`, and a cubic curve between."""
    share = np.clip((at - low) / (high - low), 0, 1)
    return share * share * (3 - 2 * share)


def mix(colours: Array, others: Array | list[int], share: Array) -> Array:
    """`colours`, and of the others this share."""
    return colours + share[..., None] * (np.asarray(others, float) - colours)


def ridged(seed: int, points: Array, octaves: int) -> Array:
    """Ridges in [0, 1] where noise passes through its mean (Musgrave 1989), finer with every octave."""
    total, share = np.zeros(points.shape[:-1]), 0.0
    for octave in range(octaves):
        scale = 2.0**octave
        total += (1 - np.abs(2 * fractal(seed + octave, scale * points, 1) - 1)) ** 2 / scale
        share += 1 / scale
    return total / share


def earth(width: int) -> tuple[Array, Array]:
    """Colours in [0, 255] and heights in [0, 1] of the globe, `width` by half of it pixels."""
    points = globe(width, width // 2)
    north = points[..., 1]
    warp = np.stack([fractal(seed, 2.2 * points, 6) - 0.5 for seed in (210, 220, 230)], axis=-1)
    moved = points + 0.55 * warp
    land = fractal(200, 1.35 * moved, 10) + 0.16 * (fractal(240, 9 * points, 6) - 0.5) - LEVEL
    ranges = ridged(250, 3.1 * moved, 7) * smooth(fractal(260, 2.4 * points, 3), 0.4, 0.62)
    inland = smooth(land, 0.0, 0.09)
    high = 0.16 * inland + 0.95 * inland * smooth(ranges, 0.3, 0.85)
    heat = (
        np.maximum(np.cos(1.05 * np.arcsin(north)), 0) ** 1.4 - 0.55 * high + 0.16 * (fractal(270, 5 * points, 5) - 0.5)
    )
    belt = np.abs(np.abs(north + 0.5 * warp[..., 0]) - 0.42)  # the horse latitudes are dry
    rain = 1.5 * fractal(280, 2.6 * moved, 7) + 0.6 * smooth(belt, 0.0, 0.36) - 0.8 - 0.15 * inland
    grain = fractal(290, 40 * points, 4) - 0.5

    sea = shades(land, [(-0.22, "04132f"), (-0.09, "082a55"), (-0.03, "0e4672"), (-0.008, "1d6f8f"), (0, "4fa3a5")])
    ground = shades(
        rain + 0.25 * grain, [(-0.2, "c9a873"), (0, "b5995f"), (0.12, "7f8448"), (0.3, "3c5f2c"), (0.5, "1f4a22")]
    )
    ground = mix(ground, [96, 98, 72], smooth(heat, 0.62, 0.4))  # steppe and tundra
    ground = mix(ground, [118, 104, 88], smooth(high, 0.34, 0.6) * (0.7 + 0.6 * grain))
    ground *= (1 + 0.5 * grain + 0.35 * (fractal(300, 14 * moved, 5) - 0.5))[..., None]
    ground = mix(ground, [243, 246, 250], smooth(heat + 0.12 * grain, 0.27, 0.2))  # snow
    colour = np.where((land > 0)[..., None], ground, sea)
    colour = mix(
        colour, [232, 240, 247], smooth(heat + 0.25 * (ridged(310, 9 * points, 4) - 0.5), 0.12, 0.07)
    )  # sea ice

    cover = clouds(points, north)
    heights = np.where(land > 0, np.clip(0.12 + 0.1 * grain * inland + high, 0, 1), 0.1)
    return mix(colour, [255, 255, 255], 0.96 * cover), heights * (1 - cover) + cover * (0.25 + 0.4 * cover)


def clouds(points: Array, north: Array) -> Array:
    """Share of the ground that clouds cover: fronts along the parallels, and noise moved by noise."""
    stretched = points * [1, 1.9, 1]
    flow = np.stack([fractal(seed, 2.1 * stretched, 5) - 0.5 for seed in (410, 420, 430)], axis=-1)
    sheets = fractal(440, 2.3 * stretched + 1.7 * flow, 9)
    tufts = fractal(450, 13 * points + 3 * flow, 6)
    wet = 0.06 * np.cos(6 * np.arcsin(north)) + 0.05 * np.abs(north)  # the equator and 60 degrees are cloudy
    return smooth(sheets + 0.3 * (tufts - 0.5) + wet, 0.53, 0.74)


def stars(width: int) -> Image.Image:
    """An environment map with points of light, few bright and many faint, and the mist of a galaxy."""
    height = width // 2
    coarse = globe(width // 4, height // 4)
    pole = np.array([0.48, 0.8, 0.36])
    off = coarse @ (pole / np.linalg.norm(pole))
    mist = np.exp(-((off / 0.17) ** 2)) * np.clip(2.6 * (fractal(11, 3 * coarse, 7) - 0.3), 0, 1)
    mist -= 0.9 * np.exp(-((off / 0.05) ** 2)) * np.clip(3 * (fractal(17, 5 * coarse, 6) - 0.42), 0, 1)
    glow = 1 - np.exp(-1.1 * np.clip(mist, 0, 1))
    levels = Image.fromarray(np.rint(95 * glow).astype(np.uint8)).resize((width, height), Image.Resampling.BICUBIC)
    indices = np.minimum(np.asarray(levels), 95).copy()
    palette = [np.array([3, 4, 9]) + at / 95 * np.array([128, 118, 140]) for at in range(96)]
    tints = [np.array(each) for each in ([1, 0.82, 0.62], [1, 0.96, 0.9], [1, 1, 1], [0.72, 0.82, 1])]
    palette += [np.minimum(255, (at + 1) / 40 * 255 * tint) for tint in tints for at in range(40)]
    random = np.random.default_rng(2)
    count = 14000
    light = np.minimum(7 * random.random(count) ** -0.75, 260)
    hue = random.integers(0, 4, count)
    up, right = random.uniform(-1, 1, count), random.random(count)
    rows, columns = ((0.5 - np.arcsin(up) / np.pi) * height).astype(int), (right * width).astype(int)
    for row, column, bright, tint, rise in zip(rows, columns, light, hue, up, strict=True):
        wide = int(1 / max(np.sqrt(1 - rise * rise), 0.02) + 0.5)  # near the poles a map stretches everything across
        for i in range(wide):
            at = row, (column + i) % width
            if 255 * glow[min(row // 4, len(glow) - 1), at[1] // 4] * 0.5 < bright:
                indices[at] = 96 + 40 * tint + min(int(bright / 255 * 40), 39)
    image = Image.fromarray(indices, "P")
    image.putpalette(np.rint(palette).astype(np.uint8).tobytes())
    return image


def main(folder: str = str(FOLDER), width: str = str(WIDTH)) -> None:
    """Draw the globe and its sky."""
    colours, heights = earth(int(width))
    Image.fromarray(np.rint(np.clip(colours, 0, 255)).astype(np.uint8)).save(Path(folder, "earth.jpg"), quality=86)
    half = np.rint(255 * heights.reshape(int(width) // 4, 2, int(width) // 2, 2).mean(axis=(1, 3)))
    Image.fromarray(half.astype(np.uint8)).save(Path(folder, "earth-height.jpg"), quality=88)
    stars(3 * int(width) // 2).save(Path(folder, "space.png"), optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
