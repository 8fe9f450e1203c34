"""Direct lighting of a surface: ambient light and, from each light source, Lambert's law, highlights and shadows."""

from __future__ import annotations

from typing import Any

from minirt.kernel.bvh import queries
from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.lights import incident_light
from minirt.kernel.shading.ray_stack import MIN_WEIGHT
from minirt.kernel.shading.specular import specular
from minirt.kernel.shading.surfaces import Surface, clearance, tint
from minirt.kernel.shading.transmission import light_through_glass
from minirt.kernel.trace import ROUNDING, unoccluded
from minirt.lanes import Vec, any, dot, maximum, splat, unit_roundoff, where
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


def direct_light(
    scene: SceneArrays,
    memory: Any,
    surface: Surface,
    normal: Vec,
    shading_normal: Vec,
    direction: Vec,
    extent: Number,
    medium: Vec,
    hit: Mask,
) -> tuple[Vec, Vec]:
    """Compute the light that falls onto surfaces, and the highlights that they reflect against the ray's direction.

    The light is ambient light and, by Lambert's cosine law, that of every light source that is not occluded. It reaches
    the side of `normal`, which is in a `medium`; cosines are those of `shading_normal`. Rays that do not hit get no
    light.
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
            if scene.transparent is None:
                lit = trace_shadow_rays(scene, memory, i, start, to_light, reach, lit, False)
                total = total + where(lit, cosine, 0.0) * intensity
                if scene.specular is not None and has_rows(scene.specular):
                    share = specular(surface.specular, shading_normal, to_light, direction, lit)
                    highlight = highlight + share * strength * intensity
            else:
                share = zero
                if scene.specular is not None and has_rows(scene.specular):
                    share = specular(surface.specular, shading_normal, to_light, direction, lit)
                seen = (own_share(surface) > MIN_WEIGHT) | (share > MIN_WEIGHT)
                shares = shares_of_light(scene, memory, i, start, to_light, reach, medium, lit, seen)
                total = total + where(lit, cosine, 0.0) * tint(shares, intensity)
                highlight = highlight + share * strength * tint(shares, intensity)
    return total, highlight


def own_share(surface: Surface) -> Number:
    """Return the share of a surface's own shading, beside what it reflects and refracts."""
    return maximum(1.0 - surface.reflective.x - surface.reflective.y, 0.0)


def trace_shadow_rays(
    scene: SceneArrays, memory: Any, light: int, start: Vec, to_light: Vec, reach: Number, lit: Mask, glass: bool
) -> Mask:
    """Return the `lit` rays to a light source that nothing occludes nearer than `reach`; `glass` as in `unoccluded`.

    Rays to a parallel light share no point: they traverse the BVH, if there is one, in place of a light buffer.
    """
    if scene.spots is None or scene.bvh is None:
        return unoccluded(scene, memory, light, start, to_light, reach, lit, glass)
    if not (has_rows(scene.spots) and has_rows(scene.bvh.nodes)) or scene.spots[light, 6] < 0.5:
        return unoccluded(scene, memory, light, start, to_light, reach, lit, glass)
    if scene.transparent is not None and has_rows(scene.transparent) and not glass:
        return lit  # the BVH finds out later, for all shapes at once
    return queries.unoccluded(scene.bvh, start, to_light, reach, lit)


def shares_of_light(
    scene: SceneArrays,
    memory: Any,
    light: int,
    start: Vec,
    to_light: Vec,
    reach: Number,
    medium: Vec,
    lit: Mask,
    seen: Mask,
) -> Vec:
    """Return the shares of red, green and blue of a light source that reach the start of `lit` shadow rays.

    Most rays meet nothing, or something opaque, and need not be followed through glass; nor need those whose light is
    not `seen`.
    """
    clear = lit
    for phase in range(2 if has_rows(scene.transparent) else 1):
        clear = trace_shadow_rays(scene, memory, light, start, to_light, reach, clear, phase == 1)
        if phase == 0:
            lit = clear
    return light_through_glass(scene, start, to_light, reach, medium, lit & (clear | seen), clear)
