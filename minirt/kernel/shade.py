"""What light leaves a surface towards the eye."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.trace import ROUNDING, largest, nearest, surfaces, unhidden
from minirt.kernel.traced import Traced
from minirt.lanes import Vec, any, dot, inverse_root, rarely, splat, unit_roundoff, where
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask


def radiance(scene: Traced, memory: Any, tile: int, origin: Vec, direction: Vec) -> Vec:
    """The light that arrives at `origin` against `direction`, nothing where a ray hits no shape."""
    t, owner, extent = nearest(scene, tile, origin, direction)
    hit = t < inf
    nothing = splat(0.0, t)
    light = Vec(nothing, nothing, nothing)
    if any(hit):
        point, normal, colour = surfaces(scene, memory, owner, origin + t * direction, hit)
        away = hit & (dot(normal, direction) > 0.0)
        if rarely(away):
            normal = where(away, -normal, normal)  # the side that is seen
        light = times(colour, irradiance(scene, memory, point, normal, extent, hit))
    return light


def irradiance(scene: Traced, memory: Any, point: Vec, normal: Vec, extent: Number, hit: Mask) -> Vec:
    """The light that falls onto a surface from the side of its normal: ambient light and, by Lambert's cosine law, the
    light of every lamp that no shape hides. Rays that do not hit bring none."""
    u = unit_roundoff(extent)
    rounding = ROUNDING * u * (largest(point) + extent)
    start = point + rounding * normal  # outside of the surface and of those that coincide with it
    total = where(hit, Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(0.0, 0.0, 0.0))
    for i in range(scene.lights.shape[0]):
        lamp = Vec(scene.lights[i, 0], scene.lights[i, 1], scene.lights[i, 2])
        light = Vec(scene.lights[i, 3], scene.lights[i, 4], scene.lights[i, 5])
        way = lamp - start
        squared = dot(way, way)
        per_length = inverse_root(squared)
        towards = way * per_length
        cosine = dot(normal, towards)
        lit = hit & (cosine > 0.0)
        if any(lit):
            reach = squared * per_length - 4.0 * (
                rounding + ROUNDING * u * largest(lamp)
            )  # a surface hides no lamp on it
            lit = unhidden(scene, memory, i, start, towards, reach, lit)
            total = total + where(lit, cosine, 0.0) * light
    return total


def times(a: Vec, b: Vec) -> Vec:
    """Light of one colour on a surface of another."""
    return Vec(a.x * b.x, a.y * b.y, a.z * b.z)
