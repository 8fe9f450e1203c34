"""Direct lighting of a surface: ambient light and, from each light source, Lambert's law, highlights and shadows."""

from __future__ import annotations

from typing import Any

from minirt.kernel.bvh import queries
from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.lights import incident_light
from minirt.kernel.shading.specular import specular
from minirt.kernel.shading.surfaces import Surface
from minirt.kernel.trace import ROUNDING, unoccluded
from minirt.lanes import Vec, any, dot, splat, unit_roundoff, where
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


def clearance(point: Vec, extent: Number) -> Number:
    """Return the offset from a surface at which a ray starts: clear of it, and of surfaces that coincide with it."""
    return ROUNDING * unit_roundoff(extent) * (largest(point) + extent)


def direct_light(
    scene: SceneArrays,
    memory: Any,
    surface: Surface,
    normal: Vec,
    shading_normal: Vec,
    direction: Vec,
    extent: Number,
    hit: Mask,
) -> tuple[Vec, Vec]:
    """Compute the light that falls onto surfaces, and the highlights that they reflect against the ray's direction.

    The light is ambient light and, by Lambert's cosine law, that of every light source that is not occluded. It reaches
    the side of `normal`; cosines are those of `shading_normal`. Rays that do not hit get no light.
    """
    u = unit_roundoff(extent)
    rounding = clearance(surface.point, extent)
    start = surface.point + rounding * normal
    total = where(hit, Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(0.0, 0.0, 0.0))
    zero = splat(0.0, extent)
    highlight = Vec(zero, zero, zero)
    for i in range(scene.lights.shape[0]):
        position = Vec(scene.lights[i, 0], scene.lights[i, 1], scene.lights[i, 2])
        intensity = Vec(scene.lights[i, 3], scene.lights[i, 4], scene.lights[i, 5])
        to_light, distance, strength = incident_light(scene.spots, i, position, start)
        cosine = dot(shading_normal, to_light) * strength
        lit = hit & (cosine > 0.0)
        if any(lit):
            # A surface occludes no light source that lies on it.
            reach = distance - 4.0 * (rounding + ROUNDING * u * largest(position))
            lit = trace_shadow_rays(scene, memory, i, start, to_light, reach, lit)
            total = total + where(lit, cosine, 0.0) * intensity
            if scene.specular is not None and has_rows(scene.specular):
                share = specular(surface.specular, shading_normal, to_light, direction, lit)
                highlight = highlight + share * strength * intensity
    return total, highlight


def trace_shadow_rays(
    scene: SceneArrays, memory: Any, light: int, start: Vec, to_light: Vec, reach: Number, lit: Mask
) -> Mask:
    """Return the `lit` rays to a light source that nothing occludes nearer than `reach`.

    Rays to a parallel light share no point: they traverse the BVH, if there is one, in place of a light buffer.
    """
    if scene.spots is None or scene.bvh is None:
        return unoccluded(scene, memory, light, start, to_light, reach, lit)
    if not (has_rows(scene.spots) and has_rows(scene.bvh.nodes)) or scene.spots[light, 6] < 0.5:
        return unoccluded(scene, memory, light, start, to_light, reach, lit)
    return queries.unoccluded(scene.bvh, start, to_light, reach, lit)


def tint(light: Vec, colour: Vec) -> Vec:
    """Multiply light by the colour of a surface, channel by channel."""
    return Vec(light.x * colour.x, light.y * colour.y, light.z * colour.z)
