"""Recursive ray tracing with reflection and refraction (Whitted, An Improved Illumination Model for Shaded Display,
1980).

A surface with reflectance k and transmittance g sends on a reflected and a refracted ray, and contributes 1 - k - g of
its own shading. `SceneArrays.reflective` (n, 3) has k, g and the index of refraction of each shape. Shadows of glass
are those of an opaque shape: caustics and tinted shadows are left out.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel.bvh import queries
from minirt.kernel.bvh.nodes import put, put_vec
from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.environment import background_light, weighted_background
from minirt.kernel.shading.shade import clearance, direct_light, tint
from minirt.kernel.shading.surfaces import Surface, surfaces
from minirt.kernel.trace import closest_hit
from minirt.lanes import Vec, any, dot, lane, load, maximum, rarely, splat, sqrt, unit, where, width
from minirt.lanes.operations import BYTES, Mask
from minirt.lanes.vec import Number

MAX_DEPTH = 32  # the largest depth that a scene may ask for
MIN_WEIGHT = 2.0**-10  # rays that would add less than this share of their light to a pixel are not traced
ORIGIN, DIRECTION, WEIGHT, LEVEL = 0, 3, 6, 7  # where a packet of waiting rays has its parts, in rows of lanes
RAY_ROWS = 8  # rows of lanes of a packet of waiting rays
STACK_SIZE = (MAX_DEPTH + 2) * RAY_ROWS * BYTES // 8


def incoming_radiance(scene: SceneArrays, memory: Any, tile: int, origin: Vec, direction: Vec) -> Vec:
    """Trace primary rays of a tile, and return the radiance that arrives at `origin` along each."""
    t, owner, extent = closest_hit(scene, tile, origin, direction)
    if scene.reflective is not None:
        return whitted(scene, memory, t, owner, extent, origin + 0.0 * direction, direction)
    hit = t < inf
    zero = splat(0.0, t)
    radiance = Vec(zero, zero, zero)
    if any(hit):
        radiance, _ = shade(scene, memory, t, owner, extent, origin, direction, hit)
    return background_light(scene, hit, radiance, direction)


def shade(
    scene: SceneArrays, memory: Any, t: Number, owner: Number, extent: Number, origin: Vec, direction: Vec, hit: Mask
) -> tuple[Vec, Surface]:
    """Shade the hits of rays without following reflections; returns their radiance and their surfaces."""
    surface = surfaces(scene, memory, owner, origin + t * direction, t, direction, hit)
    normal, shading_normal = surface.normal, surface.shading_normal
    back_side = hit & (dot(normal, direction) > 0.0)
    if rarely(back_side):  # both sides of a surface are shaded alike
        normal = where(back_side, -normal, normal)
        shading_normal = where(back_side, -shading_normal, shading_normal)
    light, highlight = direct_light(scene, memory, surface, normal, shading_normal, direction, extent, hit)
    radiance = tint(light, surface.colour)
    if scene.reflective is not None:
        radiance = radiance * maximum(1.0 - surface.reflective.x - surface.reflective.y, 0.0)
    if scene.specular is not None and has_rows(scene.specular):
        radiance = radiance + highlight
    return radiance, surface


def whitted(
    scene: SceneArrays, memory: Any, t: Number, owner: Number, extent: Number, origin: Vec, direction: Vec
) -> Vec:
    """Return the radiance along rays with known hits, following reflected and refracted rays depth first."""
    stack = ray_stack()
    weight = splat(1.0, t)
    level = 0
    waiting = 0  # packets on the stack
    radiance = Vec(splat(0.0, t), splat(0.0, t), splat(0.0, t))
    while True:
        active = weight > 0.0
        hit = active & (t < inf)
        if any(hit):
            own, surface = shade(scene, memory, t, owner, extent, origin, direction, hit)
            point, normal, reflective = surface.point, surface.normal, surface.reflective
            radiance = where(hit, radiance + weight * own, radiance)  # `own` may be NaN for rays that do not hit
            if level < scene.depth and has_rows(scene.reflective):
                rounding = clearance(point, extent)
                against = -dot(normal, direction)
                facing = where(against < 0.0, -normal, normal)
                shading_normal = where(against < 0.0, -surface.shading_normal, surface.shading_normal)
                mirror_normal = reflecting_normal(shading_normal, facing, direction)
                cosine = -dot(mirror_normal, direction)
                # Snell's law, with the ratio of the indices of refraction in front of the surface and behind it.
                ratio = where(against < 0.0, reflective.z, 1.0 / reflective.z)
                squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine)
                total = squared < 0.0  # total internal reflection
                refracted = where(hit & ~total, weight * reflective.y, 0.0)
                reflected = where(hit, weight * reflective.x + where(total, weight * reflective.y, 0.0), 0.0)
                if any(reflected > MIN_WEIGHT):
                    onward = unit(direction + 2.0 * cosine * mirror_normal)
                    kept = where(reflected > MIN_WEIGHT, reflected, 0.0)
                    waiting = push_rays(stack, waiting, point + rounding * facing, onward, kept, level)
                if any(refracted > MIN_WEIGHT):
                    onward = unit(ratio * direction + (ratio * cosine - sqrt(maximum(squared, 0.0))) * mirror_normal)
                    kept = where(refracted > MIN_WEIGHT, refracted, 0.0)
                    waiting = push_rays(stack, waiting, point - rounding * facing, onward, kept, level)
        radiance = radiance + weighted_background(scene, where(active & ~hit, weight, 0.0), direction)
        if waiting == 0:
            break
        waiting -= 1
        at = waiting * RAY_ROWS * width(t)
        origin, direction = load_vec(stack, at, t), load_vec(stack, at + DIRECTION * width(t), t)
        weight = load(stack, at + WEIGHT * width(t))
        level = int(lane(load(stack, at + LEVEL * width(t)), 0))
        t, owner, extent = queries.closest_hit(scene.bvh, origin, direction, weight > 0.0)
    return radiance


def reflecting_normal(shading_normal: Vec, facing: Vec, direction: Vec) -> Vec:
    """Return the normal for reflection and refraction: the shading normal, if that reflects the ray off the surface.

    Otherwise it is the geometric normal on the ray's side, `facing`.
    """
    cosine = -dot(shading_normal, direction)
    height = dot(direction, facing) + 2.0 * cosine * dot(shading_normal, facing)
    return where((cosine > 0.0) & (height > 0.0), shading_normal, facing)


def ray_stack() -> Any:
    """Allocate the stack of rays still to trace; compiled, it lies on the stack of the thread."""
    return np.zeros(STACK_SIZE)


def push_rays(stack: Any, waiting: int, origin: Vec, direction: Vec, weight: Number, level: int) -> int:
    """Push a packet of rays, one level deeper, onto the stack, and return the new number of packets on it."""
    count = width(weight)
    at = waiting * RAY_ROWS * count
    put_vec(stack, at, origin)
    put_vec(stack, at + DIRECTION * count, direction)
    put(stack, at + WEIGHT * count, weight)
    put(stack, at + LEVEL * count, splat(level + 1.0, weight))
    return waiting + 1


def load_vec(stack: Any, at: int, like: Number) -> Vec:
    """Load the vectors of a packet of rays from index `at` of the stack."""
    count = width(like)
    return Vec(load(stack, at), load(stack, at + count), load(stack, at + 2 * count))
