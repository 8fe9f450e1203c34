"""Direct lighting of a surface: ambient light and, from each light source, Lambert's law, highlights and shadows.

A facet of a smooth mesh that faces away from a light source lies in its own shadow, although its shading normals may
still face the light source: the edge of the light shows the facets. So shadow rays start on the smooth surface that
the normals at the corners suggest. Bumps that face a light source behind the surface would end in a hard edge: their
light fades as the light source sets.

A shadow ray that something occludes is followed from surface to surface, straight on. Opaque surfaces end it. Each
surface of glass lets its share through; with Fresnel's equations, that of the angle outside, since a ray leaves a pane
or a ball at the angle at which it entered. `SceneArrays.transparent` (n, 5) has the shares of reflection and
refraction, the index of refraction, how far Fresnel's equations count, and 1 where a mesh has glass and opaque parts.
"""

from __future__ import annotations

from typing import Any

from minirt.kernel import bvh_traversal
from minirt.kernel.scene_arrays import SceneArrays, has_rows, smooth_point, vector
from minirt.kernel.shading.lights import aim, is_spread, remembered_part, sources_in_reach, specular
from minirt.kernel.shading.surfaces import (
    FILTER,
    MIN_WEIGHT,
    Ray,
    Surface,
    absorbed,
    brightest,
    medium_behind,
    row_of,
    shares_at_angle,
    surface_of,
    tint,
)
from minirt.kernel.shadow_rays import ShadowRays, shape_left, unoccluded
from minirt.kernel.trace import EXTENT, OWNER, ClosestHit, clearance, of_shape
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, first, lane, maximum, minimum, rarely, splat, sqrt, where

ROUGHNESS = 0.125  # squared roughness of bumps whose normal leans by 45 degrees
LEAST_COSINE = 2.0**-26  # of a shading normal that counts as leaning less than 90 degrees
MOST_SURFACES = 256  # that a shadow ray may cross; beyond them it counts as occluded


def direct_light(
    scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit, surface: Surface, hit: Mask
) -> tuple[Vec, Vec]:
    """Return the light that falls onto the surfaces at the hits of rays, and the highlights that they reflect back.

    The light is ambient light and, by Lambert's cosine law, that of every light source that is not occluded. It reaches
    the side from which the ray comes; cosines are those of the shading normal. Rays that do not hit get ambient light.
    `memory` is that of `minirt.kernel.frame.frame`.
    """
    normal, shading_normal = surface.normal, surface.shading_normal
    owner, rounding = found[OWNER], clearance(surface.point, found[EXTENT])
    start = surface.point + rounding * normal
    zero = splat(0.0, rounding)
    total = splat(vector(scene.ambient, 0), zero)
    highlight = Vec(zero, zero, zero)
    first_source, end, brightness = remembered_part(scene, memory)
    if scene.light_grid is not None and has_rows(scene.light_grid.grids):
        first_source, end = sources_in_reach(scene.light_grid, surface.point, rounding, hit)
    left = -1 if has_bumps(scene) else shape_left(found, surface.side, hit)
    for number in range(first_source, end):
        source = number
        if scene.light_grid is not None and has_rows(scene.light_grid.grids):
            source = int(scene.light_grid.sources[number])
        intensity = brightness * vector(scene.lights[source], 3)
        rays, strength = aim(scene, memory, source, start, rounding, owner, normal, left)
        to_light = rays.direction
        if (scene.surface_maps is not None or scene.patterns is not None) and has_bumps(scene):
            strength = strength * bump_fading(surface.base_normal, shading_normal, to_light)
        cosine = dot(shading_normal, to_light) * strength
        lit = hit & (cosine > 0.0)
        if any(lit):
            if has_rows(scene.smooth):
                turned_away = lit & (dot(normal, to_light) <= 0.0)
                if rarely(turned_away):
                    smooth = smooth_points(scene, owner, surface.point, normal, turned_away)
                    smooth_start = where(turned_away, smooth + rounding * normal, start)
                    rays, _ = aim(scene, memory, source, smooth_start, rounding, owner, normal, left)
            shine, light = zero, intensity
            if scene.transparent is None:  # else `shares_of_light` traces the rays
                lit = trace_shadow_rays(scene, memory, rays, lit, False)
            if has_rows(scene.specular):
                shine = specular(surface.specular, shading_normal, to_light, ray.direction, lit)
            if scene.transparent is not None:
                matters = (own_share(surface) > MIN_WEIGHT) | (shine > MIN_WEIGHT)
                light = tint(shares_of_light(scene, memory, rays, ray.medium, lit, matters), intensity)
            total = total + where(lit, cosine, 0.0) * light
            if has_rows(scene.specular):
                highlight = highlight + shine * strength * light
    return total, highlight


def own_share(surface: Surface) -> Number:
    """Return the share of a surface's own shading, beside what it reflects and refracts."""
    return maximum(1.0 - surface.reflective.x - surface.reflective.y, 0.0)


def trace_shadow_rays(scene: SceneArrays, memory: Any, rays: ShadowRays, lit: Mask, glass: bool) -> Mask:
    """Return the `lit` rays to a light source that nothing occludes before their end; `glass` as in `unoccluded`.

    Rays that share no point traverse the BVH, if there is one, in place of a light buffer.
    """
    if scene.bvh is None or (scene.spots is None and scene.soft is None):
        return unoccluded(scene, memory, rays, lit, glass)
    if not traverse_bvh(scene, rays):
        return unoccluded(scene, memory, rays, lit, glass)
    return bvh_traversal.unoccluded(scene.bvh, rays.origin, rays.direction, rays.distance, lit)


def traverse_bvh(scene: SceneArrays, rays: ShadowRays) -> bool:
    """Whether rays go to a parallel light, or to a light source with a size, and there is a BVH."""
    return has_rows(scene.bvh.nodes) and is_spread(scene, rays.light)


def shares_of_light(scene: SceneArrays, memory: Any, rays: ShadowRays, medium: Vec, lit: Mask, matters: Mask) -> Vec:
    """Return the shares of red, green and blue of a light source that reach the origin of `lit` shadow rays.

    Most rays meet nothing, or something opaque, and need not be followed through glass; nor need those whose light
    hardly `matters` to the pixel: glass is opaque to them. `medium` is the absorption at the origin. Where rays
    traverse the BVH, to follow them takes no longer than to find out which need it.
    """
    clear = lit
    if has_rows(scene.transparent) and traverse_bvh(scene, rays):
        clear = lit & ~lit  # none is known to be clear
    else:
        for phase in range(2 if has_rows(scene.transparent) else 1):  # against opaque shapes, and then against glass
            clear = trace_shadow_rays(scene, memory, rays, clear, phase == 1)
            if phase == 0:
                lit = clear
        lit = lit & (clear | matters)
    return light_through_glass(scene, rays, medium, lit, matters, clear)


def smooth_points(scene: SceneArrays, owner: Number, point: Vec, normal: Vec, rays: Mask) -> Vec:
    """Move the points of some rays from the facets of smooth meshes onto the smooth surface; other points stay.

    `owner` has the indices of the shapes that the rays hit, `normal` the geometric normals on the side of the rays.
    """
    result = point
    remaining = rays
    while any(remaining):
        index = int(lane(owner, first(remaining)))
        owned = remaining & (owner == index)
        if scene.smooth[index] != 0:
            moved = of_shape(smooth_point, scene.groups, scene.slots[index], (point, normal), point)
            result = where(owned, moved, result)
        remaining = remaining & ~owned
    return result


def bump_fading(base: Vec, bumped: Vec, to_light: Vec) -> Number:
    """Return the share of light that bumps let through: 1 where the normal `bumped` is that of the surface, `base`.

    It is 0 for light from behind the surface. The formula is the microfacet shadowing of a surface so rough that its
    facets have the bumped normal (Estevez, Lecocq and Stein, A Microfacet-Based Shadowing Function to Solve the Bump
    Terminator Problem, Ray Tracing Gems, 2019, chapter 12). With the cosine c of the light over the base and the
    roughness a it is 2 c / (c + sqrt(c^2 + a^2 (1 - c^2))).
    """
    apart = bumped - base
    squared_chord = dot(apart, apart)  # exactly 0 for a flat bump, unlike the sine of the angle
    leaning = maximum(1.0 - 0.5 * squared_chord, LEAST_COSINE)  # cosine between the normals
    squared_roughness = minimum(ROUGHNESS * squared_chord * (1.0 - 0.25 * squared_chord) / (leaning * leaning), 1.0)
    cosine = maximum(dot(base, to_light), 0.0)
    root = sqrt(cosine * cosine + squared_roughness * maximum(1.0 - cosine * cosine, 0.0))
    total = cosine + root
    return where(total > 0.0, 2.0 * cosine / where(total > 0.0, total, 1.0), 0.0)


def has_bumps(scene: SceneArrays) -> bool:
    """Whether any shape of a scene has a bump map, a normal map or a raised pattern."""
    if scene.patterns is not None and has_rows(scene.patterns.heights):
        return True
    if scene.surface_maps is None:
        return False
    return has_rows(scene.surface_maps.bumps) or has_rows(scene.surface_maps.normals)


def light_through_glass(
    scene: SceneArrays, rays: ShadowRays, medium: Vec, lit: Mask, matters: Mask, clear: Mask
) -> Vec:
    """Return the shares of red, green and blue of a light source that reach the origin of shadow rays.

    The `clear` rays meet nothing. Of the others the `lit` ones, whose points face the source, pass glass, which
    is opaque to rays whose light hardly `matters`; the rest get no light. `medium`: the absorption where they start.
    """
    share = where(clear, splat(1.0, rays.distance), 0.0)
    light = Vec(share, share, share)
    last_medium, last_length = medium, rays.distance  # of the last part of the way, for clear rays all of it
    followed = lit & ~clear
    if has_rows(scene.transparent) and any(followed):
        light, last_medium, last_length = follow_shadow_rays(scene, rays, medium, light, followed, matters)
    if has_rows(scene.media):
        light = absorbed(light, last_medium, last_length)
    return light


def follow_shadow_rays(
    scene: SceneArrays, rays: ShadowRays, medium: Vec, light: Vec, followed: Mask, matters: Mask
) -> tuple[Vec, Vec, Number]:
    """Follow the shadow rays of the mask `followed` from surface to surface, and return what is left at the end.

    Results are the shares of the light, which for other rays are those of `light`; and, behind the last surface, the
    medium and the distance that remains to the light source. All surfaces are opaque to rays whose light hardly
    `matters`. Rays still on their way after `MOST_SURFACES` end dark.
    """
    start, to_light, reach = rays.origin, rays.direction, rays.distance
    light = where(followed, Vec(1.0, 1.0, 1.0), light)
    active = followed
    for _ in range(MOST_SURFACES):
        t, owner, extent, _ = bvh_traversal.closest_hit(scene.bvh, start, to_light, active)
        active = active & (t < reach)
        light = where(active & ~matters, Vec(0.0, 0.0, 0.0), light)
        active = active & matters
        if not any(active):
            break
        if has_rows(scene.media):
            light = where(active, absorbed(light, medium, where(active, t, 0.0)), light)
        reach = where(active, reach - t, reach)
        point = start + where(active, t, 0.0) * to_light
        remaining = active
        while rarely(remaining):
            index = int(lane(owner, first(remaining)))
            crossing = remaining & (owner == index)
            onward, light_there, medium_there = behind_surface(scene, index, point, to_light, extent, light, medium)
            start = where(crossing, onward, start)
            light = where(crossing, light_there, light)
            medium = where(crossing, medium_there, medium)
            remaining = remaining & ~crossing
        active = active & (brightest(light) > 0.0)
    ended = where(active, 0.0, 1.0)
    return ended * light, medium, reach


def behind_surface(
    scene: SceneArrays, index: int, point: Vec, direction: Vec, extent: Number, light: Vec, medium: Vec
) -> tuple[Vec, Vec, Vec]:
    """Return where shadow rays go on that cross the surface of shape `index`, of that `extent`, at `point`, within
    rounding, and the light and the medium behind the surface; `light` and `medium` are those before it."""
    on, normal, shading_normal = surface_of(scene, index, point)
    cosine = fabs(dot(shading_normal, direction))
    reflective, fresnel = row_of(scene.transparent, index, extent), splat(scene.transparent[index, 3], extent)
    # Shadow rays take the shares of a ray that enters, on both sides of glass: no cosine is below 0.
    light = shares_at_angle(reflective, fresnel, cosine, cosine < 0.0).y * light
    leaves = dot(normal, direction) > 0.0
    start = on + where(leaves, clearance(on, extent), -clearance(on, extent)) * normal
    if has_rows(scene.media):
        light = tint(light, row_of(scene.media, index, extent, FILTER))
        medium = medium_behind(medium, row_of(scene.media, index, extent), leaves)
    return start, light, medium
