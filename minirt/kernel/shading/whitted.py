"""The light that a ray brings back, by way of mirrors and glass too: Whitted, An Improved Illumination Model for Shaded
Display, 1980.

A surface that mirrors the share k of the light and lets the share g through sends on a ray for each, and shows
1 - k - g of its own light. `bounces` (n, 3) has k, g and the index of refraction for each shape. Glass throws a shadow
as if it were opaque: light that it would gather or tint is left out.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel.bvh import queries
from minirt.kernel.bvh.nodes import put, put_vec
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.environment import background_light, weighted_background
from minirt.kernel.shading.shade import clearance, direct_light, tint
from minirt.kernel.shading.surfaces import Surface, surfaces
from minirt.kernel.trace import closest_hit
from minirt.lanes import Vec, any, dot, lane, load, maximum, rarely, splat, sqrt, unit, where, width
from minirt.lanes.operations import BYTES, Mask
from minirt.lanes.vec import Number

MAX_DEPTH = 32  # bounces, at most
MIN_WEIGHT = 2.0**-10  # share of the light of a picture below which a ray is not followed
ORIGIN, DIRECTION, WEIGHT, LEVEL = 0, 3, 6, 7  # of a ray that is to be followed, in rows of lanes
RAY_ROWS = 8
STACK_SIZE = (MAX_DEPTH + 2) * RAY_ROWS * BYTES // 8


def incoming_radiance(scene: SceneArrays, memory: Any, tile: int, origin: Vec, direction: Vec) -> Vec:
    """The light that arrives at `origin` against `direction`."""
    t, owner, extent = closest_hit(scene, tile, origin, direction)
    if scene.reflective is not None:
        return whitted(scene, memory, t, owner, extent, origin + 0.0 * direction, direction)
    hit = t < inf
    nothing = splat(0.0, t)
    light = Vec(nothing, nothing, nothing)
    if any(hit):
        light, _ = shade(scene, memory, t, owner, extent, origin, direction, hit)
    return background_light(scene, hit, light, direction)


def shade(
    scene: SceneArrays, memory: Any, t: Number, owner: Number, extent: Number, origin: Vec, direction: Vec, hit: Mask
) -> tuple[Vec, Surface]:
    """The light of their own that surfaces send back along rays that hit them, and the surfaces."""
    found = surfaces(scene, memory, owner, origin + t * direction, hit)
    normal, bent = found.normal, found.shading_normal
    away = hit & (dot(normal, direction) > 0.0)
    if rarely(away):  # the side that is seen counts
        normal = where(away, -normal, normal)
        bent = where(away, -bent, bent)
    total, shine = direct_light(scene, memory, found, normal, bent, direction, extent, hit)
    own = tint(total, found.colour)
    if scene.reflective is not None:
        own = own * maximum(1.0 - found.reflective.x - found.reflective.y, 0.0)
    if scene.specular is not None:
        own = own + shine
    return own, found


def whitted(
    scene: SceneArrays, memory: Any, t: Number, owner: Number, extent: Number, origin: Vec, direction: Vec
) -> Vec:
    """The light along rays whose hits are known, and along those that they send on, depth first."""
    paths = ray_stack()
    weight = splat(1.0, t)
    level = 0
    waiting = 0
    light = Vec(splat(0.0, t), splat(0.0, t), splat(0.0, t))
    while True:
        asked = weight > 0.0
        hit = asked & (t < inf)
        if any(hit):
            own, found = shade(scene, memory, t, owner, extent, origin, direction, hit)
            point, normal, bounces = found.point, found.normal, found.reflective
            light = where(hit, light + weight * own, light)  # rays that do not hit may have no number here
            if level < scene.depth:
                rounding = clearance(point, extent)
                against = -dot(normal, direction)
                facing = where(against < 0.0, -normal, normal)
                bent = where(against < 0.0, -found.shading_normal, found.shading_normal)
                mirroring = reflecting_normal(bent, facing, direction)
                cosine = -dot(mirroring, direction)
                # Snell's law: the ratio of the indices in front of the surface and behind it.
                ratio = where(against < 0.0, bounces.z, 1.0 / bounces.z)
                squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine)
                total = squared < 0.0  # reflection
                through = where(hit & ~total, weight * bounces.y, 0.0)
                back = where(hit, weight * bounces.x + where(total, weight * bounces.y, 0.0), 0.0)
                if any(back > MIN_WEIGHT):
                    way = unit(direction + 2.0 * cosine * mirroring)
                    waiting = push_rays(
                        paths, waiting, point + rounding * facing, way, where(back > MIN_WEIGHT, back, 0.0), level
                    )
                if any(through > MIN_WEIGHT):
                    way = unit(ratio * direction + (ratio * cosine - sqrt(maximum(squared, 0.0))) * mirroring)
                    kept = where(through > MIN_WEIGHT, through, 0.0)
                    waiting = push_rays(paths, waiting, point - rounding * facing, way, kept, level)
        light = light + weighted_background(scene, where(asked & ~hit, weight, 0.0), direction)
        if waiting == 0:
            break
        waiting -= 1
        at = waiting * RAY_ROWS * width(t)
        origin, direction = load_vec(paths, at, t), load_vec(paths, at + DIRECTION * width(t), t)
        weight = load(paths, at + WEIGHT * width(t))
        level = int(lane(load(paths, at + LEVEL * width(t)), 0))
        t, owner, extent = queries.closest_hit(scene.bvh, origin, direction, weight > 0.0)
    return light


def reflecting_normal(bent: Vec, facing: Vec, direction: Vec) -> Vec:
    """The normal by which a surface mirrors and refracts: that by which it is lit, unless it is turned away from the
    ray or would throw it below the surface."""
    cosine = -dot(bent, direction)
    risen = dot(direction, facing) + 2.0 * cosine * dot(bent, facing)
    return where((cosine > 0.0) & (risen > 0.0), bent, facing)


def ray_stack() -> Any:
    """Room for the rays that wait; compiled, it is a thread's own."""
    return np.zeros(STACK_SIZE)


def push_rays(paths: Any, waiting: int, origin: Vec, direction: Vec, weight: Number, level: int) -> int:
    """Put rays to those that wait, and count them."""
    count = width(weight)
    at = waiting * RAY_ROWS * count
    put_vec(paths, at, origin)
    put_vec(paths, at + DIRECTION * count, direction)
    put(paths, at + WEIGHT * count, weight)
    put(paths, at + LEVEL * count, splat(level + 1.0, weight))
    return waiting + 1


def load_vec(paths: Any, at: int, like: Number) -> Vec:
    """The vectors of rays that waited."""
    count = width(like)
    return Vec(load(paths, at), load(paths, at + count), load(paths, at + 2 * count))
