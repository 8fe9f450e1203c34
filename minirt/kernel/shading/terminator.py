"""Shadow terminator: soft where the shading normal and the geometric normal disagree about the side of a light source.

A facet of a smooth mesh that faces away from a light source lies in its own shadow, although its shading normals may
still face the light source: the edge of the light shows the facets. So shadow rays start on the smooth surface that
the normals at the corners suggest. Bumps that face a light source behind the surface would end in a hard edge: their
light fades as the light source sets.
"""

from __future__ import annotations

from typing import Any

from minirt.kernel.rows import read, smooth_point
from minirt.kernel.scene_arrays import Group, SceneArrays, has_rows
from minirt.kernel.trace import for_each_kind
from minirt.lanes import Mask, Number, Vec, any, dot, first, lane, maximum, minimum, sqrt, where

ROUGHNESS = 0.125  # squared roughness of bumps whose normal leans by 45 degrees
LEAST_COSINE = 2.0**-26  # of a shading normal that counts as leaning less than 90 degrees


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
            slot = scene.slots[index]
            moved = for_each_kind(smooth_point_of_kind, scene.groups, point, (slot[0], slot[1], point, normal))
            result = where(owned, moved, result)
        remaining = remaining & ~owned
    return result


def smooth_point_of_kind(group: Group, state: Vec, arguments: tuple[int, int, Vec, Vec]) -> Vec:
    """Move points onto the smooth surface of the shape in row i of group `number` if it is of this kind."""
    number, i, point, normal = arguments
    if number == group.number:
        return smooth_point(read(group.rows, i), point, normal)
    return state


def bump_fading(base: Vec, bumped: Vec, to_light: Vec) -> Number:
    """Return the share of light that bumps let through; 1 where the bumped normal is that of the surface, `base`.

    The microfacet shadowing of a surface so rough that its facets have the bumped normal (Estevez, Lecocq and Stein, A
    Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem, Ray Tracing Gems, 2019, chapter 12). With
    the cosine c of the light over the base and the roughness a it is 2 c / (c + sqrt(c^2 + a^2 (1 - c^2))).
    """
    apart = bumped - base
    chord = dot(apart, apart)  # exactly 0 for a flat bump, unlike the sine of the angle
    leaning = maximum(1.0 - 0.5 * chord, LEAST_COSINE)  # cosine between the normals
    squared = minimum(ROUGHNESS * chord * (1.0 - 0.25 * chord) / (leaning * leaning), 1.0)
    cosine = maximum(dot(base, to_light), 0.0)
    root = sqrt(cosine * cosine + squared * maximum(1.0 - cosine * cosine, 0.0))
    total = cosine + root
    return where(total > 0.0, 2.0 * cosine / where(total > 0.0, total, 1.0), 0.0)


def has_bumps(scene: SceneArrays) -> bool:
    """Whether any shape of a scene has a bump map, a normal map or a raised pattern."""
    if scene.patterns is not None and is_used(scene.patterns.heights):
        return True
    if scene.surface_maps is None:
        return False
    return is_used(scene.surface_maps.bumps) or is_used(scene.surface_maps.normals)


def is_used(table: Any) -> bool:
    """Whether any shape of a scene has this kind of map."""
    if table is None:
        return False
    return has_rows(table)
