"""What light leaves a surface towards the eye."""

from __future__ import annotations

from typing import Any

from minirt.kernel.bvh import queries
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.lights import incident_light
from minirt.kernel.shading.specular import specular
from minirt.kernel.shading.surfaces import Surface
from minirt.kernel.trace import ROUNDING, unoccluded
from minirt.lanes import Vec, any, dot, splat, unit_roundoff, where
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


def clearance(point: Vec, extent: Number) -> Number:
    """How far from a surface a ray starts so that it is outside of it, and of surfaces that coincide with it."""
    return ROUNDING * unit_roundoff(extent) * (largest(point) + extent)


def direct_light(
    scene: SceneArrays, memory: Any, found: Surface, normal: Vec, bent: Vec, direction: Vec, extent: Number, hit: Mask
) -> tuple[Vec, Vec]:
    """The light that falls onto a surface from the side of its normal: ambient light and, by Lambert's cosine law, the
    light of every lamp that no shape hides; and of that what is a highlight along `direction`. It is lit as if its
    normal were `bent`. Rays that do not hit bring none."""
    u = unit_roundoff(extent)
    rounding = clearance(found.point, extent)
    start = found.point + rounding * normal
    total = where(hit, Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(0.0, 0.0, 0.0))
    nothing = splat(0.0, extent)
    shine = Vec(nothing, nothing, nothing)
    for i in range(scene.lights.shape[0]):
        lamp = Vec(scene.lights[i, 0], scene.lights[i, 1], scene.lights[i, 2])
        light = Vec(scene.lights[i, 3], scene.lights[i, 4], scene.lights[i, 5])
        towards, distance, strength = incident_light(scene.spots, i, lamp, start)
        cosine = dot(bent, towards) * strength
        lit = hit & (cosine > 0.0)
        if any(lit):
            reach = distance - 4.0 * (rounding + ROUNDING * u * largest(lamp))  # a surface hides no lamp on it
            lit = trace_shadow_rays(scene, memory, i, start, towards, reach, lit)
            total = total + where(lit, cosine, 0.0) * light
            if scene.specular is not None:
                shine = shine + specular(found.specular, bent, towards, direction, lit) * strength * light
    return total, shine


def trace_shadow_rays(
    scene: SceneArrays, memory: Any, lamp: int, start: Vec, towards: Vec, reach: Number, lit: Mask
) -> Mask:
    """`unoccluded`; the rays to a lamp whose light is parallel share no end, and walk the tree where there is one."""
    if scene.spots is None or scene.bvh is None or scene.spots[lamp, 6] < 0.5:
        return unoccluded(scene, memory, lamp, start, towards, reach, lit)
    return queries.unoccluded(scene.bvh, start, towards, reach, lit)


def tint(light: Vec, colour: Vec) -> Vec:
    """Light of one colour on a surface of another."""
    return Vec(light.x * colour.x, light.y * colour.y, light.z * colour.z)
