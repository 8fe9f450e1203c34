"""Textures, checkerboards, bump maps and normal maps of the reference renderer."""

from __future__ import annotations

from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
from PIL import Image

from minirt.element import fields_of
from minirt.fields import Point
from minirt.materials import Clouds, Marble, Wood
from minirt.materials.maps import Pattern
from minirt.scene import Camera, Scene
from minirt.shapes import Disc, Plane, Shape, Square, Triangle
from tests.reference.uv_mapping import placed, right_and_up_on, shading, surface_point
from tests.reference.vectors import Array, dot, length, own_x_and_z, rgb, unit


@cache
def picture(path: Path) -> Array:
    """The pixels of a picture file in [0, 1], the lowest row first, (h, w, 3)."""
    return np.asarray(Image.open(path).convert("RGB"), float)[::-1] / 255


@cache
def heights(path: Path) -> Array:
    """The luminance of a picture file, (h, w, 1)."""
    return picture(path) @ np.array([[0.2126], [0.7152], [0.0722]])


def bilinear(pixels: Array, u: Array, v: Array) -> Array:
    """Bilinear texture lookup at u, v, with repeat addressing."""
    high, wide, _ = pixels.shape
    x, y = u * wide - 0.5, v * high - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    total = np.zeros((*u.shape, pixels.shape[2]))
    for column in (i, i + 1):
        for row in (j, j + 1):
            share = (1 - np.abs(x - column)) * (1 - np.abs(y - row))
            total += share[..., None] * pixels[row % high, column % wide]
    return total


def colour_and_normal(scene: Scene, shape: Shape, points: Array, normal: Array) -> tuple[Array, Array]:
    """The colours of points, and the normals by which they are lit; `normal` are those of the shape."""
    colour, normal = np.broadcast_to(rgb(shape.colour), points.shape), shading(shape, points, normal)
    if not (shape.checker or shape.texture or shape.bump or shape.normal_map):
        return colour, normal
    at = placed(surface_point(shape, points), shape.uv)
    if shape.texture:
        colour = bilinear(rgb(255 * picture(scene.beside(shape.texture))), at.u, at.v)
    if shape.checker:
        odd = (np.floor(at.u / shape.checker.size) + np.floor(at.v / shape.checker.size)) % 2 == 1
        colour = np.where(odd[..., None], rgb(shape.checker.colour), colour)
    if shape.bump:
        pixels = heights(scene.beside(shape.bump.file))
        high, wide, _ = pixels.shape
        over_u = wide * (bilinear(pixels, at.u + 0.5 / wide, at.v) - bilinear(pixels, at.u - 0.5 / wide, at.v))
        over_v = high * (bilinear(pixels, at.u, at.v + 0.5 / high) - bilinear(pixels, at.u, at.v - 0.5 / high))
        # The tangents of the raised surface are P_u + h_u n and P_v + h_v n; their cross product, without products of
        # small quantities, is its normal (Blinn 1978).
        rise = shape.bump.strength * length(at.along_u)[..., None] * normal  # height of white
        raise_u, raise_v = rise * over_u, rise * over_v
        raised = np.cross(at.along_u, at.along_v) + np.cross(raise_u, at.along_v) + np.cross(at.along_u, raise_v)
        raised *= np.sign(dot(np.cross(at.along_u, at.along_v), normal))[..., None]
        normal = np.where(length(raised)[..., None] > 1e-12, unit(raised), normal)
    if shape.normal_map:
        seen = 255 * bilinear(picture(scene.beside(shape.normal_map)), at.u, at.v)
        red, green, blue = np.moveaxis((seen - 128) / 127, -1, 0)  # 128 is 0, 255 is 1
        normal = unit(
            red[..., None] * unit(at.along_u) + green[..., None] * unit(at.along_v) + blue[..., None] * normal
        )
    return colour, normal


PRIME = 149
CUBES = np.array([n**3 % PRIME for n in range(PRIME)])
SIGNS = ((-1, 1), (-1, -1), (1, -1), (1, 1))
EDGES = [(a, b, 0) for a, b in SIGNS] + [(a, 0, b) for a, b in SIGNS] + [(0, a, b) for a, b in SIGNS]
GRADIENTS = np.array([EDGES[12 * (2 * n + PRIME) // (2 * PRIME)] for n in (*range(75), *range(-74, 0))])
STEP = 1e-5  # of differences, in sizes of a pattern
SHIFT = (19.37, 6.13, 14.71)
GONE, SHARP = 0.75, 0.2


def floor(x: Any) -> Any:
    """The greatest whole numbers not above x, also of many digits."""
    return np.frompyfunc(mpmath.floor, 1, 1)(x) if x.dtype == object else np.floor(x)


def noise(x: Any, y: Any, z: Any) -> Any:
    """Perlin's improved noise, its corners hashed by cubes modulo a prime number."""
    cells = [floor(each) for each in (x, y, z)]
    i, j, k = (cell.astype(int) + 23 for cell in cells)
    within = [each - cell for each, cell in zip((x, y, z), cells, strict=True)]
    total = 0 * x
    for corner in product((0, 1), repeat=3):
        hashed = CUBES[(k + corner[2]) % PRIME]
        hashed = CUBES[(hashed + j + corner[1]) % PRIME]
        gradient = GRADIENTS[CUBES[(hashed + i + corner[0]) % PRIME]]
        part = 1
        ramp = 0
        for axis in range(3):
            t = within[axis]
            rise = 6 * t**5 - 15 * t**4 + 10 * t**3
            part = part * (rise if corner[axis] else 1 - rise)
            ramp = ramp + gradient[..., axis] * (t - corner[axis])
        total = total + part * ramp
    return total


def smooth(x: Any) -> Any:
    """Hermite's cubic between 0 and 1."""
    x = np.minimum(np.maximum(x, 0), 1)
    return 3 * x**2 - 2 * x**3


def kept(footprint: Any) -> Any:
    """Share of a wave that a pixel shows, by its width in wavelengths."""
    return 1 - smooth((footprint - SHARP) / (GONE - SHARP))


def share(pattern: Pattern, p: Any, footprint: Any) -> Any:
    """The share of the second colour at points (..., 3), in the frame of the shape and in sizes of the pattern."""
    x, y, z = np.moveaxis(p, -1, 0)
    cells, stretch = {Marble: (0.35, 1), Wood: (0.25, 12), Clouds: (0.5, 1)}[type(pattern)]
    waves = {k: (cells * 2**k, kept(footprint * cells * 2**k)) for k in range(pattern.octaves)}
    octaves = {
        k: noise(x * f + k * SHIFT[0], y * f + k * SHIFT[1], z * (f / stretch) + k * SHIFT[2])
        for k, (f, _) in waves.items()
    }
    if isinstance(pattern, Clouds):
        cover = 3.5 * sum(waves[k][1] * n / 2**k for k, n in octaves.items())
        return (1 + cover / np.sqrt(1 + cover**2)) / 2
    fraction = kept(2 * footprint)
    if isinstance(pattern, Marble):
        turbulence = sum(waves[k][1] * (np.abs(n) - 0.218118) / 2**k for k, n in octaves.items())
        phase = 0.8 * x + 0.5 * y + 0.33 * z + 2 * turbulence
        vein = smooth(np.abs(2 * (phase - floor(phase)) - 1))
        mean = 0.35 * 13 / 35 + 0.65 * 386119 / 2042975
        return fraction * (0.35 * vein**2 + 0.65 * vein**8) + (1 - fraction) * mean
    phase = np.sqrt(x**2 + y**2) + 1.2 * sum(waves[k][1] * n / 2**k for k, n in octaves.items())
    age = phase - floor(phase)
    ring = smooth(age / 0.8) ** 2 * (1 - smooth((age - 0.8) / 0.2))
    mean = 0.8 * 13 / 35 + 0.1
    grain = sum(waves[k][1] * n for k, n in octaves.items() if k >= 2)
    dark = 0.2 + 0.55 * (fraction * ring + (1 - fraction) * mean) + 0.17 * grain
    return np.minimum(np.maximum(dark, 0), 1)


def patterns_of(shape: Shape) -> list[Pattern]:
    """The patterns of a shape, in the order in which it gets them."""
    return [each for each in (shape.marble, shape.wood, shape.clouds) if each]


def frame(shape: Shape) -> tuple[Array, Array]:
    """Origin and three axes, (3, 3), of the frame in which patterns lie; rings are around the last axis."""
    origin = next(getattr(shape, field.name) for field in fields_of(type(shape)) if isinstance(field, Point))
    if isinstance(shape, Triangle):
        right = unit(np.subtract(shape.b, shape.a))
        normal = unit(np.cross(right, np.subtract(shape.c, shape.a)))
        return np.array(origin), np.array([np.cross(normal, right), normal, right])
    if isinstance(shape, Plane | Square | Disc):
        normal = np.array(shape.normal)
        right, up = right_and_up_on(shape)
        return np.array(origin), np.array([up, normal, right])
    axis = np.array(getattr(shape, "axis", (0.0, 1.0, 0.0)))
    _, z = own_x_and_z(axis, getattr(shape, "roll", 0.0))
    return np.array(origin), np.array([z, np.cross(axis, z), axis])


def patterned(shape: Shape, points: Array, footprint: Array, colour: Array, normal: Array) -> tuple[Array, Array]:
    """Colours and normals after the patterns of a shape; `footprint` is the width of a pixel on the surface."""
    origin, axes = frame(shape)
    for pattern in patterns_of(shape):
        behind = 3.5 * axes[1] if isinstance(shape, Plane | Square | Disc | Triangle) else 0.0
        p = ((points - origin) / pattern.size + behind) @ axes.T
        wide = footprint / pattern.size
        mixed = share(pattern, p, wide)[..., None]
        colour = (1 - mixed) * colour + mixed * rgb(pattern.colour)
        if pattern.height:
            rises = [share(pattern, p + step, wide) - share(pattern, p - step, wide) for step in STEP * np.eye(3)]
            slope = pattern.height * (np.stack(rises, axis=-1) / (2 * STEP)) @ axes
            along = slope - dot(slope, normal)[..., None] * normal
            normal = unit(normal - along)
    return colour, normal


def footprint(camera: Camera, pixel: float, points: Array, distance: Array, direction: Array, normal: Array) -> Array:
    """The width of a square as large as a pixel on the surface; `pixel` is its width at distance 1 from the eye."""
    far = np.maximum(distance, length(points - np.array(camera.position)))
    return np.asarray(pixel * far / np.sqrt(np.maximum(np.abs(dot(normal, direction)), 2.0**-10)))
