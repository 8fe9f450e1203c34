"""Recursive ray tracing with reflection and refraction (Whitted, An Improved Illumination Model for Shaded Display,
1980).

A surface with reflectance k and transmittance g sends on a reflected and a refracted ray, and contributes 1 - k - g of
its own shading. `SceneArrays.reflective` (n, 3) has k, g and the index of refraction of each shape. With Fresnel's
equations k and g depend on the angle; secondary rays may fade with their length, and tinted glass absorbs them. Packets
of rays that wait to be traced are on a stack.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel import bvh_traversal
from minirt.kernel.scene_arrays import SceneArrays, has_rows, vector
from minirt.kernel.shading.shade import direct_light, own_share
from minirt.kernel.shading.surfaces import (
    MIN_WEIGHT,
    Ray,
    Surface,
    absorbed,
    brightest,
    medium_behind,
    reflecting_normal,
    surfaces,
    tint,
)
from minirt.kernel.shading.texturing import background_light, weighted_background
from minirt.kernel.trace import DISTANCE, EXTENT, ClosestHit, clearance, closest_hit
from minirt.lanes import Mask, Number, Vec, any, dot, lane, load_vec, maximum, save_vec, splat, sqrt, unit, where, width

MAX_DEPTH = 32  # the largest depth that a scene may ask for
# Where a packet of waiting rays has its parts, in rows of lanes: its origin; its direction; its weight, level and fade;
# its colour and its medium, which scenes without tinted glass leave unused.
DIRECTION, WEIGHT, COLOUR, MEDIUM = 3, 6, 9, 12
RAY_ROWS = 15  # rows of lanes of a packet of waiting rays
STACK_SIZE = (MAX_DEPTH + 2) * RAY_ROWS * width(np.empty(0))


def ray_stack() -> Any:
    """Allocate the stack of rays still to trace; compiled, it lies on the stack of the thread."""
    return np.zeros(STACK_SIZE)


def push_rays(scene: SceneArrays, stack: Any, waiting: int, ray: Ray, level: int) -> int:
    """Push a packet of rays, one level deeper, onto the stack, and return the new number of packets on it."""
    count = width(ray.weight)
    at = waiting * RAY_ROWS * count
    save_vec(ray.origin, stack, at)
    save_vec(ray.direction, stack, at + DIRECTION * count)
    save_vec(Vec(ray.weight, splat(level + 1.0, ray.weight), ray.fade), stack, at + WEIGHT * count)
    if scene.media is not None:
        save_vec(ray.colour, stack, at + COLOUR * count)
        save_vec(ray.medium, stack, at + MEDIUM * count)
    return waiting + 1


def load_rays(scene: SceneArrays, stack: Any, number: int, zero: Number) -> tuple[Ray, int]:
    """Load a packet of rays from the stack, and its level."""
    count = width(zero)
    at = number * RAY_ROWS * count
    colour = medium = Vec(zero, zero, zero)
    if scene.media is not None:
        colour, medium = load_vec(stack, at + COLOUR * count), load_vec(stack, at + MEDIUM * count)
    origin, direction = load_vec(stack, at), load_vec(stack, at + DIRECTION * count)
    numbers = load_vec(stack, at + WEIGHT * count)
    return Ray(origin, direction, numbers.x, numbers.z, colour, medium), int(lane(numbers.y, 0))


def incoming_radiance(scene: SceneArrays, memory: Any, tile: int, origin: Vec, direction: Vec) -> Vec:
    """Trace primary rays of a tile, and return the radiance that arrives at `origin` along each."""
    found = closest_hit(scene, tile, origin, direction)
    ray = primary_ray(scene, origin, direction)
    if scene.reflective is not None:
        return whitted(scene, memory, ray, found)
    hit = found[DISTANCE] < inf
    radiance = splat(Vec(0.0, 0.0, 0.0), direction.x)
    if any(hit):
        radiance = where(hit, shade(scene, memory, ray, found, hit)[0], radiance)
    return background_light(scene, hit, radiance, direction)


def shade(scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit, hit: Mask) -> tuple[Vec, Surface]:
    """Shade the hits of rays without following reflections; returns their radiance and their surfaces."""
    surface = surfaces(scene, memory, ray, found, hit)
    light, highlight = direct_light(scene, memory, ray, found, surface, hit)
    radiance = tint(light, surface.colour)
    if scene.reflective is not None:
        radiance = radiance * own_share(surface)
    if has_rows(scene.specular):
        radiance = radiance + highlight
    if has_rows(scene.glow):
        radiance = radiance + where(hit, surface.glow, 0.0) * surface.colour
    return radiance, surface


def whitted(scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit) -> Vec:
    """Return the radiance along rays with known hits, `found`, following reflected and refracted rays depth first."""
    stack = ray_stack()
    zero = splat(0.0, ray.weight)
    level, waiting = 0, 0  # the latter counts packets on the stack
    radiance = Vec(zero, zero, zero)
    while True:
        t, direction = found[DISTANCE], ray.direction
        weight, colour = attenuated(scene, ray, t)
        active = weight > 0.0
        hit = active & (t < inf)
        if any(hit):
            own, surface = shade(scene, memory, ray, found, hit)
            point, facing, reflective = surface.point, surface.normal, surface.reflective
            # `own` may be NaN for rays that do not hit
            radiance = where(hit, radiance + weight * coloured(scene, own, colour), radiance)
            if level < scene.depth and has_rows(scene.reflective):
                rounding = clearance(point, found[EXTENT])
                leaves = surface.side < 0.0
                mirror_normal = reflecting_normal(surface.shading_normal, facing, direction)
                cosine = -dot(mirror_normal, direction)
                # Snell's law, with the ratio of the indices of refraction in front of the surface and behind it.
                ratio = where(leaves, reflective.z, 1.0 / reflective.z)
                squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine)  # of the cosine of the refracted ray
                is_total = squared < 0.0  # total internal reflection
                refracted = where(hit & ~is_total, weight * reflective.y, 0.0)
                reflected = where(hit, weight * reflective.x + where(is_total, weight * reflective.y, 0.0), 0.0)
                kept = worth_tracing(scene, reflected, colour)
                if any(kept > 0.0):
                    onward = unit(direction + 2.0 * cosine * mirror_normal)
                    fade = where(is_total, surface.fades.y, surface.fades.x)
                    mirrored = Ray(point + rounding * facing, onward, kept, fade, colour, ray.medium)
                    waiting = push_rays(scene, stack, waiting, mirrored, level)
                colour_behind, medium = colour_and_medium_behind(scene, surface, colour, ray.medium, leaves)
                kept = worth_tracing(scene, refracted, colour_behind)
                if any(kept > 0.0):
                    onward = unit(ratio * direction + (ratio * cosine - sqrt(maximum(squared, 0.0))) * mirror_normal)
                    through = Ray(point - rounding * facing, onward, kept, surface.fades.y, colour_behind, medium)
                    waiting = push_rays(scene, stack, waiting, through, level)
        beyond = weighted_background(scene, where(active & ~hit, weight, 0.0), direction)
        radiance = radiance + coloured(scene, beyond, colour)
        if waiting == 0:
            break
        waiting -= 1
        ray, level = load_rays(scene, stack, waiting, zero)
        found = bvh_traversal.closest_hit(scene.bvh, ray.origin, ray.direction, ray.weight > 0.0)
    return radiance


def primary_ray(scene: SceneArrays, origin: Vec, direction: Vec) -> Ray:
    """Return primary rays, which start in the medium of the eye; lanes where secondary rays take their place."""
    one = splat(1.0, direction.x)
    medium = splat(Vec(0.0, 0.0, 0.0), one)
    if scene.eye_medium is not None:
        medium = medium + vector(scene.eye_medium, 0)
    if scene.reflective is not None:
        origin = splat(origin, one)
    return Ray(origin, direction, one, splat(0.0, one), Vec(one, one, one), medium)


def attenuated(scene: SceneArrays, ray: Ray, t: Number) -> tuple[Number, Vec]:
    """Return weight and colour of rays after a distance t, which is infinite for rays that hit nothing."""
    weight, colour = ray.weight, ray.colour
    if has_rows(scene.fades):
        weight = where(ray.fade > 0.0, weight * maximum(1.0 - ray.fade * t, 0.0), weight)
    if has_rows(scene.media):
        colour = absorbed(colour, ray.medium, t)
    return weight, colour


def coloured(scene: SceneArrays, radiance: Vec, colour: Vec) -> Vec:
    """Multiply radiance by the colour of a ray, where rays can have one."""
    if scene.media is None:
        return radiance
    return tint(radiance, colour)


def worth_tracing(scene: SceneArrays, weight: Number, colour: Vec) -> Number:
    """Return the weights of rays, but 0 for rays whose share of a pixel is too small to trace them."""
    if scene.media is None:
        return where(weight > MIN_WEIGHT, weight, 0.0)
    return where(weight * brightest(colour) > MIN_WEIGHT, weight, 0.0)


def colour_and_medium_behind(
    scene: SceneArrays, surface: Surface, colour: Vec, medium: Vec, leaves: Mask
) -> tuple[Vec, Vec]:
    """Return colour and medium of rays that are refracted by a surface of tinted glass."""
    if has_rows(scene.media):
        colour = tint(colour, surface.filter)
        medium = medium_behind(medium, surface.absorption, leaves)
    return colour, medium
