"""Direct lighting of the reference renderer: lights, shadows and highlights."""

from __future__ import annotations

from contextvars import ContextVar

import numpy as np

from minirt.scene import Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.shape import Shape
from tests.reference.glass import light_through
from tests.reference.normals import shading, smooth_points
from tests.reference.patterns import patterns_of
from tests.reference.vectors import Array, dot, length, rgb, unit

# The source of random points in lights and lenses; None for hard shadows and a pinhole.
RANDOM: ContextVar[np.random.Generator | None] = ContextVar("RANDOM", default=None)
OFF_SURFACE = 1e-10  # offset from a surface at which rays start, relative to the coordinates


def from_lamp(lamp: Lamp, points: Array) -> tuple[Array, Array, Array]:
    """Unit directions from points towards a light, its distance, and the share of its intensity that reaches there."""
    if isinstance(lamp, ParallelLight):
        towards = np.broadcast_to(-np.array(lamp.direction), points.shape)
        return towards, np.full(points.shape[:-1], np.inf), np.ones(points.shape[:-1])
    assert isinstance(lamp, Light | SpotLight)
    way = np.array(lamp.position) - points
    distance, towards = length(way), unit(way)
    share = np.ones_like(distance)
    if isinstance(lamp, SpotLight):
        half = np.radians(lamp.angle) / 2
        cosine, edge, full = -dot(towards, np.array(lamp.direction)), np.cos(half), np.cos(half * (1 - lamp.rim))
        if full > edge:
            t = np.clip((cosine - edge) / (full - edge), 0, 1)
            share = 3 * t**2 - 2 * t**3
        else:
            share = np.where(cosine > edge, 1.0, 0.0)
    if lamp.fade:
        share = share * np.maximum(0, 1 - distance / lamp.fade)
    return towards, distance, share


def to_random_point(lamp: Lamp, towards: Array, distance: Array) -> tuple[Array, Array]:
    """Unit directions from points towards random points of a light with a size, and their distances.

    These are in a disc about its centre that faces each point.
    """
    x, y = random_in_disc(len(towards))
    helper = np.where(np.abs(towards[:, :1]) < 0.6, [[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])
    across = unit(np.cross(towards, helper))
    within = x[:, None] * across + y[:, None] * np.cross(towards, across)
    assert lamp.size
    if isinstance(lamp, ParallelLight):
        return unit(towards + np.tan(np.radians(lamp.size / 2)) * within), distance
    way = distance[:, None] * towards + lamp.size / 2 * within
    return unit(way), length(way)


def aim(lamp: Lamp, points: Array) -> tuple[Array, Array, Array]:
    """The same as `from_lamp`, towards random points of lights with a size where there is a source of them."""
    towards, distance, share = from_lamp(lamp, points)
    if lamp.size and RANDOM.get() is not None:
        towards, distance = to_random_point(lamp, towards, distance)
    return towards, distance, share


def random_in_disc(count: int) -> tuple[Array, Array]:
    """Random points in the unit disc, equally likely everywhere."""
    random = RANDOM.get()
    assert random
    radius, angle = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
    return radius * np.cos(angle), radius * np.sin(angle)


def shaded(
    scene: Scene,
    shape: Shape,
    points: Array,
    normal: Array,
    bent: Array,
    colour: Array,
    direction: Array,
    far: Array,
    own: Array,
) -> Array:
    """Diffuse light and highlights that points of a `shape` send back against `direction`, and its glow.

    `normal` points towards the viewer, and `bent` is the bumped normal. Shadow rays start `far` above the surface. Of
    the diffuse light the share `own` (n, 1) is seen.
    """
    total = (shape.glow or 0.0) * colour * np.ones_like(points)
    if scene.ambient is not None:
        total += own * colour * scene.ambient.brightness * rgb(scene.ambient.colour)
    base = shading(shape, points, normal)
    base = np.where((dot(base, normal) < 0)[:, None], -base, base)
    starts, raised = (each + far[:, None] * normal for each in (points, smooth_points(shape, points, normal)))
    for lamp in scene.lights:
        towards, distance, share = aim(lamp, starts)
        cosine = dot(bent, towards)
        # A facet that faces away from the light is in its own shadow: there rays start on the smooth surface.
        beneath, way, _ = aim(lamp, raised)
        facing = dot(normal, towards) > 0
        origins, rays = (np.where(facing[:, None], *each) for each in ((starts, raised), (towards, beneath)))
        reach = np.where(facing, distance, way)
        reached = np.where((cosine > 0)[:, None], light_through(scene, origins, rays, reach), 0.0)
        if shape.bump or shape.normal_map or patterns_of(shape):
            share = share * let_through_by_bumps(base, bent, towards)
        light = lamp.brightness * share[:, None] * reached * rgb(lamp.colour)
        total += own * cosine[:, None] * colour * light
        if shape.specular:
            if shape.specular.blinn:
                angle = dot(bent, unit(towards - direction))
            else:
                angle = dot(2 * cosine[:, None] * bent - towards, -direction)
            total += shape.specular.share * np.maximum(0, angle)[:, None] ** shape.specular.exponent * light
    return total


def let_through_by_bumps(base: Array, bent: Array, towards: Array) -> Array:
    """The share of light that bumps let through, by the tangents of the angles between base, bumps and light.

    Smith's shadowing for GGX facets: 2 / (1 + sqrt(1 + a^2 tan^2)), with a^2 an eighth of the squared tangent between
    the normals (Estevez, Lecocq and Stein 2019).
    """
    squared = np.minimum(squared_tangent(base, bent) / 8, 1)
    up = dot(base, towards) > 0
    with np.errstate(invalid="ignore"):
        return np.where(up, 2 / (1 + np.sqrt(1 + squared * squared_tangent(base, towards))), 0)


def squared_tangent(one: Array, other: Array) -> Array:
    """The squared tangent of the angle between unit vectors."""
    cosine, across = dot(one, other), np.cross(one, other)
    with np.errstate(divide="ignore"):
        return dot(across, across) / cosine**2
