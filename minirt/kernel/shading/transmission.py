"""Transmission of light from light sources through glass: shadow rays that carry a share of each colour.

A shadow ray that something occludes is followed from surface to surface, straight on. Opaque surfaces end it. Each
surface of glass lets its share through; with Fresnel's equations, that of the angle outside, since a ray leaves a pane
or a ball at the angle at which it entered. `SceneArrays.transparent` (n, 4) has the shares of reflection and
refraction, the index of refraction, and how far Fresnel's equations count.
"""

from __future__ import annotations

from minirt.kernel.bvh import queries
from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.fresnel import shares_at_angle
from minirt.kernel.shading.media import absorbed, brightest, filter_of, medium_behind
from minirt.kernel.shading.surfaces import clearance, row_of, surface_of_kind, tint
from minirt.kernel.trace import for_each_kind
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, first, lane, rarely, splat, where

MOST_SURFACES = 256  # that a shadow ray may cross; beyond them it counts as occluded

Way = tuple[Vec, Vec, Vec]  # where a shadow ray starts, the shares of the light that are left, and the medium


def light_through_glass(
    scene: SceneArrays, start: Vec, to_light: Vec, reach: Number, medium: Vec, lit: Mask, clear: Mask
) -> Vec:
    """Return the shares of red, green and blue of a light source that reach the start of shadow rays.

    Of the `lit` rays those that are `clear` meet nothing nearer than `reach`. Rays start in a `medium`.
    """
    share = where(clear, splat(1.0, reach), 0.0)
    light = Vec(share, share, share)
    occluded = lit & ~clear
    if has_rows(scene.transparent) and any(occluded):
        light, medium, reach = follow_shadow_rays(scene, start, to_light, reach, medium, light, occluded)
    if scene.media is not None and has_rows(scene.media):
        light = absorbed(light, medium, reach)
    return light


def follow_shadow_rays(
    scene: SceneArrays, start: Vec, to_light: Vec, reach: Number, medium: Vec, light: Vec, occluded: Mask
) -> tuple[Vec, Vec, Number]:
    """Follow `occluded` shadow rays from surface to surface.

    Returns the shares that are left behind the last one, and the medium and the distance to the light source there.
    """
    light = Vec(where(occluded, 1.0, light.x), where(occluded, 1.0, light.y), where(occluded, 1.0, light.z))
    active = occluded
    for _ in range(MOST_SURFACES):
        t, owner, extent = queries.closest_hit(scene.bvh, start, to_light, active)
        active = active & (t < reach)
        if not any(active):
            break
        if scene.media is not None and has_rows(scene.media):
            light = where(active, absorbed(light, medium, where(active, t, 0.0)), light)
        reach = where(active, reach - t, reach)
        point = start + where(active, t, 0.0) * to_light
        remaining = active
        while rarely(remaining):
            index = int(lane(owner, first(remaining)))
            crossing = remaining & (owner == index)
            behind = behind_surface(scene, index, point, to_light, extent, light, medium)
            start = where(crossing, behind[0], start)
            light = where(crossing, behind[1], light)
            medium = where(crossing, behind[2], medium)
            remaining = remaining & ~crossing
        active = active & (brightest(light) > 0.0)
    ended = where(active, 0.0, 1.0)
    return ended * light, medium, reach


def behind_surface(
    scene: SceneArrays, index: int, point: Vec, direction: Vec, extent: Number, light: Vec, medium: Vec
) -> Way:
    """Return where rays go on that cross the surface of a shape, and the light and the medium behind it."""
    slot = scene.slots[index]
    on, normal, shading_normal = for_each_kind(
        surface_of_kind, scene.groups, (point, point, point), (slot[0], slot[1], point)
    )
    cosine = fabs(dot(shading_normal, direction))
    reflective, fresnel = row_of(scene.transparent, index, extent), splat(scene.transparent[index, 3], extent)
    light = shares_at_angle(reflective, fresnel, cosine, cosine).y * light
    leaves = dot(normal, direction) > 0.0
    start = on + where(leaves, clearance(on, extent), -clearance(on, extent)) * normal
    if scene.media is not None and has_rows(scene.media):
        light = tint(light, filter_of(scene.media, index, extent))
        medium = medium_behind(medium, row_of(scene.media, index, extent), leaves)
    return start, light, medium
