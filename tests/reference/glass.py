"""Mirrors and glass of the reference renderer: shares by Fresnel's laws of sines and tangents, absorption along chords.

What lies between two points is found from all crossings of the line through them with each shape, sorted.
"""

from __future__ import annotations

import numpy as np

from minirt.materials import Mirror
from minirt.scene import Scene
from minirt.shapes.disc import Disc
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.square import Square
from minirt.shapes.triangle import Triangle
from tests.reference.hits import SAME_SURFACE, crossings, first_in_front
from tests.reference.normals import normals
from tests.reference.vectors import Array, dot, rgb


def mirror_and_glass(shape: Shape) -> tuple[float, float]:
    """Shares of reflected and refracted light, at most 1 together."""
    back = shape.mirror.share if isinstance(shape.mirror, Mirror) else 0.0
    through = shape.glass.share if shape.glass else 0.0
    return back / max(1.0, back + through), through / max(1.0, back + through)


def reflectance(angle: Array, before: float, behind: float) -> Array:
    """Share of unpolarised light that is reflected at an angle to the normal, between media of two indices."""
    sine = np.sin(angle) * before / behind
    with np.errstate(invalid="ignore", divide="ignore"):
        there = np.arcsin(sine)
        across = np.sin(angle - there) / np.sin(angle + there)
        along = np.tan(angle - there) / np.tan(angle + there)
    mean = (across**2 + along**2) / 2
    return np.where(sine > 1, 1.0, np.where(angle < 1e-6, ((before - behind) / (before + behind)) ** 2, mean))


def shares(shape: Shape, cosine: Array, outside: Array) -> tuple[Array, Array]:
    """Shares of reflected and refracted light of rays that arrive with a cosine, from outside or from inside."""
    back, through = mirror_and_glass(shape)
    if not shape.fresnel:
        return np.full(cosine.shape, back), np.full(cosine.shape, through)
    angle = np.arccos(np.clip(cosine, 0, 1))
    if shape.glass and through:
        n = shape.glass.ior
        part = np.where(outside, reflectance(angle, 1.0, n), reflectance(angle, n, 1.0))
        reflected = part * (back + through)
    else:
        root = min(np.sqrt(back), 1 - 1e-9)
        reflected = reflectance(angle, 1.0, (1 + root) / (1 - root))
    mixed = shape.fresnel * reflected + (1 - shape.fresnel) * back
    return mixed, (back + through - mixed if through else np.zeros_like(mixed))


def all_crossings(shape: Shape, origins: Array, directions: Array) -> Array:
    """The sorted distances at which lines cross a shape, (k, n), infinity behind the last ones."""
    assert not isinstance(shape, Mesh), "the reference renderer finds only the first crossing of a mesh"
    found = np.array(crossings(shape, origins, directions))
    return np.sort(np.where(np.isnan(found), np.inf, found), axis=0)


def is_tinted(shape: Shape) -> bool:
    """Whether a shape is tinted glass."""
    return bool(shape.tint and shape.glass and shape.glass.share)


def is_sheet(shape: Shape) -> bool:
    """Whether a shape has no inside."""
    return isinstance(shape, Square | Disc | Triangle)


def way_inside(shape: Shape, origins: Array, directions: Array, distances: Array) -> Array:
    """The length of the part of each ray, from 0 to a distance, that lies inside a shape."""
    if isinstance(shape, Plane):
        height, slope = (
            dot(origins - np.array(shape.point), np.array(shape.normal)),
            dot(directions, np.array(shape.normal)),
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            at = np.clip(np.where(slope == 0, np.inf, -height / slope), 0, distances)
        at = np.where(-height * slope > 0, at, distances)  # what is behind the line's start does not count
        with np.errstate(invalid="ignore"):
            return np.where(height < 0, at, np.where(at < distances, distances - at, 0.0))
    at = np.clip(all_crossings(shape, origins, directions), 0, distances)
    with np.errstate(invalid="ignore"):
        pairs = at[1::2] - at[0 : 2 * (len(at) // 2) : 2]
    return np.nansum(pairs, axis=0)


def left_by_media(scene: Scene, origins: Array, directions: Array, distances: Array) -> Array:
    """Shares of red, green and blue that tinted glass leaves of light along rays up to a distance, (n, 3)."""
    left = np.ones_like(directions)
    for shape in scene.shapes:
        if is_tinted(shape) and not is_sheet(shape):
            assert shape.tint
            way = way_inside(shape, origins, directions, distances)[:, None] / shape.tint.distance
            left = left * np.where(way > 0, rgb(shape.tint.colour) ** way, 1.0)
    return left


def light_through(scene: Scene, starts: Array, towards: Array, distances: Array) -> Array:
    """Shares of red, green and blue of a lamp that reach points through glass and past opaque shapes, (n, 3)."""
    share = left_by_media(scene, starts, towards, distances)
    limit = distances * (1 - SAME_SURFACE)
    for shape in scene.shapes:
        if mirror_and_glass(shape)[1] == 0:
            share[first_in_front(shape, starts, towards) < limit] = 0.0
            continue
        for at in all_crossings(shape, starts, towards):
            crossed = (at > 0) & (at < limit)
            normal = normals(shape, starts[crossed] + at[crossed, None] * towards[crossed])
            _, through = shares(shape, np.abs(dot(normal, towards[crossed])), np.ones(crossed.sum(), bool))
            share[crossed] *= through[:, None]
            if is_tinted(shape) and is_sheet(shape):
                assert shape.tint
                share[crossed] *= rgb(shape.tint.colour)
    return share
