"""Direct lighting of a surface: ambient light and, from each light source, Lambert's law, highlights and shadows."""

from __future__ import annotations

from typing import Any

from minirt.kernel import bvh_traversal
from minirt.kernel.scene_arrays import SceneArrays, has_rows, vector
from minirt.kernel.shading.lights import incident_light, sampled_position, sources_in_reach, specular
from minirt.kernel.shading.shadows import bump_fading, has_bumps, light_through_glass, smooth_points
from minirt.kernel.shading.surfaces import MIN_WEIGHT, Surface, clearance, tint
from minirt.kernel.shadow_rays import ShadowRays, unoccluded
from minirt.kernel.trace import ROUNDING
from minirt.lanes import Mask, Number, Vec, any, dot, max_norm, maximum, rarely, splat, unit_roundoff, where


def direct_light(
    scene: SceneArrays,
    memory: Any,
    surface: Surface,
    direction: Vec,
    owner: Number,
    extent: Number,
    medium: Vec,
    hit: Mask,
) -> tuple[Vec, Vec]:
    """Compute the light that falls onto surfaces, and the highlights that they reflect against the ray's direction.

    The light is ambient light and, by Lambert's cosine law, that of every light source that is not occluded. It reaches
    the side from which the ray comes, which is in a `medium`; cosines are those of the shading normal. Rays that do not
    hit get no light. `owner` has the index of the shape at each hit.
    """
    normal, shading_normal = surface.normal, surface.shading_normal
    u = unit_roundoff(extent)
    rounding = clearance(surface.point, extent)
    start = surface.point + rounding * normal
    total = where(hit, vector(scene.ambient, 0), Vec(0.0, 0.0, 0.0))
    zero = splat(0.0, extent)
    highlight = Vec(zero, zero, zero)
    first, end = 0, scene.lights.shape[0]
    if scene.light_grid is not None and has_rows(scene.light_grid.grids):
        first, end = sources_in_reach(scene.light_grid, surface.point, rounding, hit)
    for number in range(first, end):
        i = number
        if scene.light_grid is not None and has_rows(scene.light_grid.grids):
            i = int(scene.light_grid.sources[number])
        intensity = vector(scene.lights[i], 3)
        rays, strength = aim(scene, memory, i, start)
        to_light = rays.direction
        if (scene.surface_maps is not None or scene.patterns is not None) and has_bumps(scene):
            strength = strength * bump_fading(surface.base_normal, shading_normal, to_light)
        cosine = dot(shading_normal, to_light) * strength
        lit = hit & (cosine > 0.0)
        if any(lit):
            # A surface occludes no light source that lies on it.
            tolerance = 4.0 * (rounding + ROUNDING * u * max_norm(rays.position))
            if has_rows(scene.smooth):
                turned_away = lit & (dot(normal, to_light) <= 0.0)
                if rarely(turned_away):
                    smooth = smooth_points(scene, owner, surface.point, normal, turned_away)
                    rays, _ = aim(scene, memory, i, where(turned_away, smooth + rounding * normal, start))
            rays = shortened(rays, tolerance)
            share, light = zero, intensity
            if scene.transparent is None:
                lit = trace_shadow_rays(scene, memory, rays, lit, False)
            if has_rows(scene.specular):
                share = specular(surface.specular, shading_normal, to_light, direction, lit)
            if scene.transparent is not None:
                seen = (own_share(surface) > MIN_WEIGHT) | (share > MIN_WEIGHT)
                light = tint(shares_of_light(scene, memory, rays, medium, lit, seen), intensity)
            total = total + where(lit, cosine, 0.0) * light
            if has_rows(scene.specular):
                highlight = highlight + share * strength * light
    return total, highlight


def aim(scene: SceneArrays, memory: Any, light: int, point: Vec) -> tuple[ShadowRays, Number]:
    """Return the rays from some points to a light source, and the relative strength of the light at the points."""
    centre = vector(scene.lights[light], 0)
    to_centre, distance, strength = incident_light(scene.spots, light, centre, point)
    if scene.soft is None:
        return ShadowRays(light, centre, to_centre, point, to_centre, distance), strength
    position, to_light, distance = sampled_position(scene.soft, memory, light, centre, to_centre, distance)
    return ShadowRays(light, position, to_centre, point, to_light, distance), strength


def shortened(rays: ShadowRays, length: Number) -> ShadowRays:
    """Return rays that end by a length before the light source."""
    return ShadowRays(rays.light, rays.position, rays.towards, rays.origin, rays.direction, rays.distance - length)


def own_share(surface: Surface) -> Number:
    """Return the share of a surface's own shading, beside what it reflects and refracts."""
    return maximum(1.0 - surface.reflective.x - surface.reflective.y, 0.0)


def trace_shadow_rays(scene: SceneArrays, memory: Any, rays: ShadowRays, lit: Mask, glass: bool) -> Mask:
    """Return the `lit` rays to a light source that nothing occludes before their end; `glass` as in `unoccluded`.

    Rays to a parallel light, or to a light source with a size, share no point: they traverse the BVH, if there is one,
    in place of a light buffer.
    """
    if scene.bvh is None or (scene.spots is None and scene.soft is None):
        return unoccluded(scene, memory, rays, lit, glass)
    if not (has_rows(scene.bvh.nodes) and is_spread(scene, rays.light)):
        return unoccluded(scene, memory, rays, lit, glass)
    if has_rows(scene.transparent) and not glass:
        return lit  # the BVH finds out later, for all shapes at once
    return bvh_traversal.unoccluded(scene.bvh, rays.origin, rays.direction, rays.distance, lit)


def is_spread(scene: SceneArrays, light: int) -> bool:
    """Whether a light source is not a point: it is parallel light, or it has a size."""
    spread = False
    if has_rows(scene.spots):
        spread = scene.spots[light, 6] > 0.5
    if has_rows(scene.soft):
        spread = spread or scene.soft[light, 0] > 0.0
    return spread


def shares_of_light(scene: SceneArrays, memory: Any, rays: ShadowRays, medium: Vec, lit: Mask, seen: Mask) -> Vec:
    """Return the shares of red, green and blue of a light source that reach the origin of `lit` shadow rays.

    Most rays meet nothing, or something opaque, and need not be followed through glass; nor need those whose light is
    not `seen`.
    """
    clear = lit
    for phase in range(2 if has_rows(scene.transparent) else 1):
        clear = trace_shadow_rays(scene, memory, rays, clear, phase == 1)
        if phase == 0:
            lit = clear
    return light_through_glass(scene, rays, medium, lit & (clear | seen), clear)
