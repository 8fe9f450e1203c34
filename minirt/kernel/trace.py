"""Closest hits of coherent rays: primary rays of a tile of the picture.

Rays come in packets, one ray for each SIMD lane. They are tested against the shapes that culling left for their tile,
in order of distance, each first by its bounding cone.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.beam_traversal import fold_over_mesh
from minirt.kernel.scene_arrays import (
    AXIS,
    COSINE,
    LEAST_DISTANCE,
    PRIMITIVE,
    ROW,
    Group,
    SceneArrays,
    intersect,
    may_meet,
    range_in_tile,
    read_row,
    surface,
    vector,
)
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, max_norm, maximum, rarely, splat, unit_roundoff, where

ROUNDING = 16  # error of a surface point: unit roundoffs of its largest coordinate and of the extent of the shape
COINCIDENT = 2.0**-14  # two hits that differ by no more than this, relative to their distance, may be one place
# For each ray the distance, and the index and the extent of the shape that it hits; and for the packet the index of one
# of these shapes, -1 if not known.
ClosestHit = tuple[Number, Number, Number, int]
DISTANCE, OWNER, EXTENT = 0, 1, 2


def for_each_kind(step: Callable[..., Any], groups: tuple[Group, ...], state: Any, arguments: Any) -> Any:
    """Fold `state = step(group, state, arguments)` over the groups, one for each kind of shape.

    Compiled, the loop is unrolled, and each step contains the formulas of its own kind.
    """
    for group in groups:
        state = step(group, state, arguments)
    return state


def of_shape(
    formula: Callable[..., Any], groups: tuple[Group, ...], slot: Any, arguments: tuple[Any, ...], like: Any
) -> Any:
    """Return `formula(shape, *arguments)` for the shape in a slot, (group, row); `like` is a value of the same type."""
    return for_each_kind(of_shape_in_group, groups, like, (formula, slot[0], slot[1], arguments))


def of_shape_in_group(group: Any, state: Any, arguments: tuple[Callable[..., Any], int, int, tuple[Any, ...]]) -> Any:
    """Continue `of_shape`: compute the formula if the shape is in this group."""
    formula, number, row, others = arguments
    if number == group.number:
        return formula(read_row(group, row), *others)
    return state


def is_empty(scene: SceneArrays, tile: int) -> bool:
    """Whether no shape can be seen in a tile of the picture."""
    return bool(for_each_kind(count_kind, scene.groups, 0, tile) == 0)


def count_kind(group: Group, count: int, tile: int) -> int:
    """Add the number of shapes of one kind in a tile to `count`."""
    start, end = range_in_tile(group, tile)
    return count + end - start


def closest_hit(scene: SceneArrays, tile: int, origin: Vec, direction: Vec) -> ClosestHit:
    """Find the closest hit of each primary ray in a tile: distance, index and extent of the shape that is hit.

    A ray that hits nothing gets infinity, -1 and 0. Where two surfaces coincide within rounding, the shape with the
    lower index is hit on the whole overlap, and the extent is the larger of the two.
    """
    no_hit = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x), -1
    found: ClosestHit = for_each_kind(closest_of_kind, scene.groups, no_hit, (scene, tile, origin, direction))
    return found


Arguments = tuple[SceneArrays, int, Vec, Vec]  # and the tile, the eye and the directions of its rays


def closest_of_kind(group: Group, state: ClosestHit, arguments: Arguments) -> ClosestHit:
    """Continue `closest_hit` over the shapes of one kind; `state` has the closest hits of the kinds before.

    The shapes of a tile are in order of distance: behind the first one that is too far there is nothing to test.
    """
    scene, tile, origin, direction = arguments
    start, end = range_in_tile(group, tile)
    for i in range(start, end):
        cone, listed = scene.cones[scene.tile_shapes[i]], scene.listed[scene.tile_shapes[i]]
        nearer = state[DISTANCE] > cone[LEAST_DISTANCE]
        if not any(nearer):
            break
        if cone[COSINE] <= -1.0 or rarely(in_cone(cone, direction)):
            row, index = listed[ROW], listed[PRIMITIVE]
            if group.trees is None:
                state = closest_of_shape(group, row, index, nearer, state, arguments)
            else:
                rays = splat(origin, direction.x), direction, splat(-1.0, direction.x)  # -1: they start on no shape
                state = fold_over_mesh(closest_of_shape, search_limit, group, row, rays, nearer, state, arguments)
    return state


def closest_of_shape(
    group: Group, row: int, index: int, active: Mask, state: ClosestHit, arguments: Arguments
) -> ClosestHit:
    """Continue `closest_hit` by one shape, or by a triangle of a mesh, which only `active` rays may meet."""
    scene, _, origin, direction = arguments
    shape = read_row(group, row)
    if group.triangles is not None or any(may_meet(shape, origin, None, direction, active)):
        hit, t = intersect(shape, origin, direction)
        extent = scene.colours_and_extents[index, 3]
        if group.triangles is not None:
            extent = triangle_extent(shape)
        state = closer_hit(shape, index, extent, hit, t, origin, direction, state)
    return state


def triangle_extent(shape: Any) -> float:
    """Return the largest coordinate of a triangle of a mesh."""
    return max(max_norm(shape.a), max_norm(shape.b), max_norm(shape.c))


def search_limit(state: ClosestHit, arguments: Arguments) -> Number:
    """Return how far to search for hits nearer than the closest ones, or coincident with them."""
    return state[DISTANCE] * (1.0 + 2.0 * COINCIDENT)


def closer_hit(
    shape: Any, index: int, shape_extent: float, hit: Mask, t: Number, origin: Vec, direction: Vec, state: ClosestHit
) -> ClosestHit:
    """Return the closest hits, which were `state`, after the hits of shape `index` at distances t.

    The nearer hit wins. Where both lie within rounding of each other, the shape with the lower index wins, and the
    larger extent counts.
    """
    best, owner, extent, last = state
    new_extent = splat(shape_extent, best)
    closer = hit & (t < best)
    contested = hit & (best < inf)
    if rarely(contested):
        contested = contested & (fabs(t - best) <= COINCIDENT * t)
    if any(contested):
        point = origin + t * direction
        _, normal = surface(shape, point)
        gap = fabs(t - best) * fabs(dot(normal, direction))  # between the surfaces
        rounding = ROUNDING * unit_roundoff(best) * (max_norm(point) + max_norm(origin) + new_extent)
        same = contested & (gap <= 4.0 * rounding)
        order = where(same, where(index < owner, -inf, inf), t)  # the distance by which the hits are compared
        closer = hit & (order < best)
        new_extent = where(same, maximum(new_extent, extent), new_extent)
        extent = where(same, new_extent, extent)
    if any(closer):
        best = where(closer, t, best)
        owner = where(closer, index, owner)
        extent = where(closer, new_extent, extent)
        last = int(index)
    return best, owner, extent, last


def clearance(point: Vec, extent: Number) -> Number:
    """Return the offset from a surface at which a ray starts: clear of it, and of surfaces that coincide with it."""
    return ROUNDING * unit_roundoff(extent) * (max_norm(point) + extent)


def in_cone(cone: Any, direction: Vec) -> Mask:
    """Whether a direction from the apex of a bounding cone lies in the cone."""
    return dot(vector(cone, AXIS), direction) >= cone[COSINE]
