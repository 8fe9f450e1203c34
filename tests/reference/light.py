"""Direct lighting of the reference renderer: lights, shadows and highlights."""

from __future__ import annotations

import numpy as np

from minirt.scene import Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.shape import Shape
from tests.reference.glass import light_through
from tests.reference.vectors import Array, dot, length, rgb, unit

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
    starts = points + far[:, None] * normal
    for lamp in scene.lights:
        towards, distance, share = from_lamp(lamp, starts)
        cosine = dot(bent, towards)
        reached = np.where((cosine > 0)[:, None], light_through(scene, starts, towards, distance), 0.0)
        light = lamp.brightness * share[:, None] * reached * rgb(lamp.colour)
        total += own * cosine[:, None] * colour * light
        if shape.specular:
            if shape.specular.blinn:
                angle = dot(bent, unit(towards - direction))
            else:
                angle = dot(2 * cosine[:, None] * bent - towards, -direction)
            total += shape.specular.share * np.maximum(0, angle)[:, None] ** shape.specular.exponent * light
    return total
