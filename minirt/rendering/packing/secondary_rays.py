"""Packs mirrors and glass: the shares, attenuation and absorption of mirrored and refracted rays and of light."""

from __future__ import annotations

from math import log2, sqrt

import numpy as np

from minirt.materials import Glass, Mirror
from minirt.rendering.packing.colours import Colours
from minirt.shapes import Shape

NumberedShapes = list[tuple[int, Shape]]  # shapes that have materials, with their indices
BLACK = 1e30  # absorption, in halvings for each scene unit, of what lets nothing of a colour through
HIGHEST_ROOT = 1.0 - 1e-9  # of the reflectance of a varnish; that of a perfect mirror would have an infinite index


def mirror_of(shape: Shape) -> Mirror:
    """Return the mirror of a shape; one of share 0 where it has none."""
    return shape.mirror if isinstance(shape.mirror, Mirror) else Mirror(0.0)


def shares(shape: Shape) -> tuple[float, float]:
    """Return the shares of reflected and refracted light of a shape, scaled down to 1 where their sum exceeds it."""
    reflected, refracted = mirror_of(shape).share, shape.glass.share if shape.glass else 0.0
    total = max(1.0, reflected + refracted)
    return reflected / total, refracted / total


def pack_reflective(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Share of reflection, share of refraction and refractive index of each of `count` shapes: see
    `minirt.kernel.shading.whitted`."""
    rows = np.tile([0.0, 0.0, 1.0], (count, 1))
    for i, shape in with_materials:
        rows[i] = *shares(shape), refractive_index(shape)
    return rows


def refractive_index(shape: Shape) -> float:
    """Return the refractive index of a shape; that of a varnish where it is a mirror with Fresnel reflection."""
    if shape.glass and shape.glass.share:
        return shape.glass.ior
    if not shape.fresnel:
        return 1.0
    root = min(sqrt(mirror_of(shape).share), HIGHEST_ROOT)
    return (1.0 + root) / (1.0 - root)


def pack_transparent(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Shares of reflection and refraction of each of `count` shapes, its refractive index, and how far Fresnel's
    equations count: see `minirt.kernel.shading.shadows`."""
    rows = np.tile([0.0, 0.0, 1.0, 0.0], (count, 1))
    for i, shape in with_materials:
        if shape.glass:
            rows[i] = *shares(shape), refractive_index(shape), shape.fresnel or 0.0
    return rows


def pack_media(with_materials: NumberedShapes, count: int, colours: Colours) -> np.ndarray:
    """Absorption of red, green and blue inside each of `count` shapes, and the shares of them that its surface lets
    through: see `minirt.kernel.shading.surfaces`."""
    rows = np.tile([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], (count, 1))
    for i, shape in with_materials:
        if shape.tint and shape.glass and shape.glass.share:
            if shape.solid:
                rows[i, :3] = absorption(shape, colours)
            else:
                rows[i, 3:] = colours.shares(shape.tint.colour)
    return rows


def absorption(shape: Shape, colours: Colours) -> np.ndarray:
    """Return the absorption of red, green and blue by the tint of a shape, in halvings for each scene unit."""
    assert shape.tint
    shares = colours.shares(shape.tint.colour)
    return np.array([-log2(share) / shape.tint.distance if share else BLACK for share in shares])


def pack_fresnel(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """Share of Fresnel reflection of each of `count` shapes."""
    rows = np.zeros(count)
    for i, shape in with_materials:
        rows[i] = shape.fresnel or 0.0
    return rows


def pack_fades(with_materials: NumberedShapes, count: int) -> np.ndarray:
    """One over the distances at which reflected and refracted rays of each of `count` shapes are gone; 0 for never."""
    rows = np.zeros((count, 2))
    for i, shape in with_materials:
        glass = shape.glass or Glass(1.0)
        rows[i] = [1.0 / fade if fade else 0.0 for fade in (mirror_of(shape).fade, glass.fade)]
    return rows
