"""Rays against all shapes of a scene."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.culling.light_buffer import is_close, remember_cell
from minirt.kernel.rows import intersect, is_batched, may_meet, read, surface
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.lanes import (
    Vec,
    any,
    dot,
    fabs,
    first,
    greatest,
    lowest,
    maximum,
    rarely,
    splat,
    unit_roundoff,
    where,
    width,
)
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number

ROUNDING = 16  # of a point on a surface: unit roundoffs of its largest coordinate and of the extent of the shape
COINCIDENT = 2.0**-14  # two hits so close to each other, relative to their distance, may be one place
# Cones of a crowd that are tried in a row, so that no branch waits for them: a tenth of the time of a mesh, but with
# few shapes more than it saves.
BATCH = 16


def for_each_kind(step: Callable[..., Any], groups: tuple[Group, ...], state: Any, given: Any) -> Any:
    """The state after `state = step(group, state, given)` for the shapes of each kind in turn.

    Compiled, it is the same steps one after the other, each with the formulas of its kind in it.
    """
    for group in groups:
        state = step(group, state, given)
    return state


def is_empty(scene: SceneArrays, tile: int) -> bool:
    """Whether no shape can be seen in a tile of the picture."""
    return bool(for_each_kind(count_kind, scene.groups, 0, tile) == 0)


def count_kind(group: Group, count: int, tile: int) -> int:
    """The number of shapes of a kind in a tile, and `count`."""
    return count + int(group.tile_starts[tile + 1] - group.tile_starts[tile])


def closest_hit(scene: SceneArrays, tile: int, origin: Vec, direction: Vec) -> tuple[Number, Number, Number]:
    """The distance to the first hit of each ray, the index of the shape that is hit and its extent; infinity, -1 and 0
    where none is.

    The rays come from the eye and lie in a tile of the picture. Where two surfaces coincide within rounding the shape
    with the lower index is hit, on the whole of the overlap, and the extent is the larger of the two.
    """
    nothing = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x)
    best, owner, extent = for_each_kind(closest_of_kind, scene.groups, nothing, (scene, tile, origin, direction))
    return best, owner, extent


def closest_of_kind(
    group: Group, state: tuple[Number, Number, Number], given: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """`closest_hit` over the shapes of one kind, where others gave `state`."""
    return (closest_batched if is_batched(group.rows) else closest_one_by_one)(group, state, given)


def closest_one_by_one(
    group: Group, state: tuple[Number, Number, Number], given: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """The same, shape by shape."""
    scene, tile, origin, direction = given
    for i in range(group.tile_starts[tile], group.tile_starts[tile + 1]):
        index = scene.tile_shapes[i]
        view = scene.cones[index]
        if not any(state[0] > view[4]):
            break
        everywhere = view[3] <= -1.0
        if everywhere or rarely(in_cone(view, direction)):
            shape = read(group.rows, scene.slots[index, 1])
            if everywhere or any(may_meet(shape, origin, None, direction, state[0] > view[4])):
                hit, t = intersect(shape, origin, direction)
                state = closer_hit(shape, index, scene.colours_and_extents[index, 3], hit, t, origin, direction, state)
    return state


def closest_batched(
    group: Group, state: tuple[Number, Number, Number], given: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """The same, with the cones of some shapes tried before anything else of them."""
    scene, tile, origin, direction = given
    start, end = int(group.tile_starts[tile]), int(group.tile_starts[tile + 1])
    while start < end:
        farthest = greatest(state[0])
        met = 0
        for i in range(start, min(start + BATCH, end)):
            view = scene.cones[scene.tile_shapes[i]]
            if not farthest > view[4]:
                end = i
                break
            met |= int(any(in_cone(view, direction))) << (i - start)
        while met != 0:
            index = scene.tile_shapes[start + lowest(met)]
            met &= met - 1
            view = scene.cones[index]
            asked = state[0] > view[4]
            if not any(asked):
                return state
            shape = read(group.rows, scene.slots[index, 1])
            if view[3] <= -1.0 or any(may_meet(shape, origin, None, direction, asked)):
                hit, t = intersect(shape, origin, direction)
                state = closer_hit(shape, index, scene.colours_and_extents[index, 3], hit, t, origin, direction, state)
        start += BATCH
    return state


def closer_hit(
    shape: Any,
    index: int,
    reach: float,
    hit: Mask,
    t: Number,
    origin: Vec,
    direction: Vec,
    state: tuple[Number, Number, Number],
) -> tuple[Number, Number, Number]:
    """The state of `closest_hit`, or in its place, where that is nearer, the hit of a shape of extent `reach` at t."""
    best, owner, extent = state
    wide = splat(reach, best)
    closer = hit & (t < best)
    contested = hit & (best < inf)
    if rarely(contested):
        contested = contested & (fabs(t - best) <= COINCIDENT * t)
    if any(contested):
        point = origin + t * direction
        _, normal = surface(shape, point)
        gap = fabs(t - best) * fabs(dot(normal, direction))  # between the surfaces
        rounding = ROUNDING * unit_roundoff(best) * (largest(point) + largest(origin) + wide)
        same = contested & (gap <= 4.0 * rounding)
        closer = (closer & (same ^ True)) | (same & (index < owner))
        wide = where(same, maximum(wide, extent), wide)
        extent = where(same, wide, extent)
    if any(closer):
        best = where(closer, t, best)
        owner = where(closer, index, owner)
        extent = where(closer, wide, extent)
    return best, owner, extent


def in_cone(cone: Any, direction: Vec) -> Mask:
    """Whether a direction from the tip of a cone lies in it."""
    return dot(Vec(cone[0], cone[1], cone[2]), direction) >= cone[3]


def unoccluded(
    scene: SceneArrays, memory: Any, lamp: int, origin: Vec, direction: Vec, distance: Number, asked: Mask
) -> Mask:
    """Of the rays towards a lamp that are `asked` for, those that hit nothing nearer than `distance`.

    Only shapes that the lamp sees in the direction of a ray are tried. The list of a cell holds for directions around
    it too, and `memory` (m, 4) keeps for each lamp the direction that was last looked up and its cell: mostly the rays
    of a packet, and those of the next, need no other.
    """
    if scene.light_buffer_cells == 1:
        return for_each_kind(
            unoccluded_by_kind, scene.groups, asked, (scene, lamp, 0, asked, origin, direction, distance)
        )
    free = asked
    left = asked
    for _ in range(width(distance)):  # at most a look for each ray
        if not any(left):
            break
        mine = left & is_close(memory[lamp], scene.light_buffers[lamp], direction)
        if rarely(not any(mine)):
            remember_cell(memory[lamp], scene.light_buffers[lamp], scene.light_buffer_cells, direction, first(left))
            mine = left & is_close(memory[lamp], scene.light_buffers[lamp], direction)
        given = (scene, lamp, int(memory[lamp, 3]), mine, origin, direction, distance)
        free = for_each_kind(unoccluded_by_kind, scene.groups, free, given)
        left = left & ~mine
    return free


def unoccluded_by_kind(group: Group, free: Mask, given: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number]) -> Mask:
    """Of the rays that are free so far, those that the shapes of one kind do not stop; only `mine` are tried."""
    return (unoccluded_batched if is_batched(group.rows) else unoccluded_one_by_one)(group, free, given)


def unoccluded_one_by_one(
    group: Group, free: Mask, given: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number]
) -> Mask:
    """The same, shape by shape."""
    scene, lamp, at, mine, origin, direction, distance = given
    place = Vec(scene.lights[lamp, 0], scene.lights[lamp, 1], scene.lights[lamp, 2])
    for i in range(group.light_starts[lamp, at], group.light_starts[lamp, at + 1]):
        index = scene.light_shapes[i]
        view = scene.light_cones[lamp, index]
        if not any(free & mine & (distance > view[4])):
            break
        everywhere = view[3] <= -1.0
        if everywhere or rarely(mine & in_cone(view, -direction)):
            shape = read(group.rows, scene.slots[index, 1])
            if everywhere or any(may_meet(shape, place, origin, direction, free & mine)):
                hit, t = intersect(shape, origin, direction)
                free = free & ~(mine & hit & (t < distance))
    return free


def unoccluded_batched(group: Group, free: Mask, given: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number]) -> Mask:
    """The same, with the cones of some shapes tried before anything else of them."""
    scene, lamp, at, mine, origin, direction, distance = given
    place = Vec(scene.lights[lamp, 0], scene.lights[lamp, 1], scene.lights[lamp, 2])
    start, end = int(group.light_starts[lamp, at]), int(group.light_starts[lamp, at + 1])
    while start < end:
        farthest = greatest(where(free & mine, distance, -inf))
        met = 0
        for i in range(start, min(start + BATCH, end)):
            view = scene.light_cones[lamp, scene.light_shapes[i]]
            if not farthest > view[4]:
                end = i
                break
            met |= int(any(mine & in_cone(view, -direction))) << (i - start)
        while met != 0:
            index = scene.light_shapes[start + lowest(met)]
            met &= met - 1
            shape = read(group.rows, scene.slots[index, 1])
            everywhere = scene.light_cones[lamp, index, 3] <= -1.0
            if everywhere or any(may_meet(shape, place, origin, direction, free & mine)):
                hit, t = intersect(shape, origin, direction)
                free = free & ~(mine & hit & (t < distance))
        start += BATCH
    return free
