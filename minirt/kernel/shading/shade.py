"""Direct lighting of a surface: ambient light and, from each light source, Lambert's law, highlights and shadows."""

from __future__ import annotations

from typing import Any

from minirt.kernel import bvh_traversal
from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.lights import incident_light, sampled_position, specular
from minirt.kernel.shading.shadows import bump_fading, has_bumps, light_through_glass, smooth_points
from minirt.kernel.shading.surfaces import MIN_WEIGHT, Surface, clearance, tint
from minirt.kernel.shadow_rays import unoccluded
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Mask, Number, Vec, any, dot, max_norm, maximum, rarely, splat, unit_roundoff, where


def direct_light(
    scene: SceneArrays,
    memory: Any,
    surface: Surface,
    normal: Vec,
    shading_normal: Vec,
    base_normal: Vec,
    direction: Vec,
    owner: Number,
    extent: Number,
    medium: Vec,
    hit: Mask,
) -> tuple[Vec, Vec]:
    """Compute the light that falls onto surfaces, and the highlights that they reflect against the ray's direction.

    The light is ambient light and, by Lambert's cosine law, that of every light source that is not occluded. It reaches
    the side of `normal`, which is in a `medium`; cosines are those of `shading_normal`, which bumps make of
    `base_normal`. Rays that do not hit get no light. `owner` has the index of the shape at each hit.
    """
    u = unit_roundoff(extent)
    rounding = clearance(surface.point, extent)
    start = surface.point + rounding * normal
    total = where(hit, Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(0.0, 0.0, 0.0))
    zero = splat(0.0, extent)
    highlight = Vec(zero, zero, zero)
    for i in range(scene.lights.shape[0]):
        centre = Vec(scene.lights[i, 0], scene.lights[i, 1], scene.lights[i, 2])
        intensity = Vec(scene.lights[i, 3], scene.lights[i, 4], scene.lights[i, 5])
        position, to_centre, to_light, distance, strength = aim(scene, memory, i, centre, start)
        if (scene.surface_maps is not None or scene.patterns is not None) and has_bumps(scene):
            strength = strength * bump_fading(base_normal, shading_normal, to_light)
        cosine = dot(shading_normal, to_light) * strength
        lit = hit & (cosine > 0.0)
        if any(lit):
            # A surface occludes no light source that lies on it.
            tolerance = 4.0 * (rounding + ROUNDING * u * max_norm(position))
            origin, ray, reach = start, to_light, distance - tolerance
            if scene.smooth is not None and has_rows(scene.smooth):
                turned_away = lit & (dot(normal, to_light) <= 0.0)
                if rarely(turned_away):
                    smooth = smooth_points(scene, owner, surface.point, normal, turned_away)
                    origin = where(turned_away, smooth + rounding * normal, start)
                    position, to_centre, ray, distance, _ = aim(scene, memory, i, centre, origin)
                    reach = distance - tolerance
            if scene.transparent is None:
                lit = trace_shadow_rays(scene, memory, i, position, to_centre, origin, ray, reach, lit, False)
                total = total + where(lit, cosine, 0.0) * intensity
                if scene.specular is not None and has_rows(scene.specular):
                    share = specular(surface.specular, shading_normal, to_light, direction, lit)
                    highlight = highlight + share * strength * intensity
            else:
                share = zero
                if scene.specular is not None and has_rows(scene.specular):
                    share = specular(surface.specular, shading_normal, to_light, direction, lit)
                seen = (own_share(surface) > MIN_WEIGHT) | (share > MIN_WEIGHT)
                shares = shares_of_light(scene, memory, i, position, to_centre, origin, ray, reach, medium, lit, seen)
                total = total + where(lit, cosine, 0.0) * tint(shares, intensity)
                highlight = highlight + share * strength * tint(shares, intensity)
    return total, highlight


def aim(scene: SceneArrays, memory: Any, light: int, centre: Vec, point: Vec) -> tuple[Vec, Vec, Vec, Number, Number]:
    """Return where the ray from a point to a light source at `centre` ends, the directions from the point towards that
    centre and towards that end, the distance of the end, and the relative strength of the light at the point."""
    to_centre, distance, strength = incident_light(scene.spots, light, centre, point)
    if scene.soft is None:
        return centre, to_centre, to_centre, distance, strength
    position, to_light, distance = sampled_position(scene.soft, memory, light, centre, to_centre, distance)
    return position, to_centre, to_light, distance, strength


def own_share(surface: Surface) -> Number:
    """Return the share of a surface's own shading, beside what it reflects and refracts."""
    return maximum(1.0 - surface.reflective.x - surface.reflective.y, 0.0)


def trace_shadow_rays(
    scene: SceneArrays,
    memory: Any,
    light: int,
    position: Vec,
    towards: Vec,
    start: Vec,
    to_light: Vec,
    reach: Number,
    lit: Mask,
    glass: bool,
) -> Mask:
    """Return the `lit` rays to a light source that nothing occludes nearer than `reach`; `glass` as in `unoccluded`.

    Rays to a parallel light, or to a light source with a size, share no point: they traverse the BVH, if there is one,
    in place of a light buffer.
    """
    if scene.bvh is None or (scene.spots is None and scene.soft is None):
        return unoccluded(scene, memory, light, position, towards, start, to_light, reach, lit, glass)
    if not (has_rows(scene.bvh.nodes) and is_spread(scene, light)):
        return unoccluded(scene, memory, light, position, towards, start, to_light, reach, lit, glass)
    if scene.transparent is not None and has_rows(scene.transparent) and not glass:
        return lit  # the BVH finds out later, for all shapes at once
    return bvh_traversal.unoccluded(scene.bvh, start, to_light, reach, lit)


def is_spread(scene: SceneArrays, light: int) -> bool:
    """Whether a light source is not a point: it is parallel light, or it has a size."""
    spread = False
    if scene.spots is not None and has_rows(scene.spots):
        spread = scene.spots[light, 6] > 0.5
    if scene.soft is not None and has_rows(scene.soft):
        spread = spread or scene.soft[light, 0] > 0.0
    return spread


def shares_of_light(
    scene: SceneArrays,
    memory: Any,
    light: int,
    position: Vec,
    towards: Vec,
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
        clear = trace_shadow_rays(scene, memory, light, position, towards, start, to_light, reach, clear, phase == 1)
        if phase == 0:
            lit = clear
    return light_through_glass(scene, start, to_light, reach, medium, lit & (clear | seen), clear)
