"""Textures, checkerboards, bump maps and normal maps of the reference renderer."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image

from minirt.scene import Scene
from minirt.shapes.shape import Shape
from tests.reference.normals import shading
from tests.reference.uv_mapping import placed, surface_point
from tests.reference.vectors import Array, dot, length, rgb, unit


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
