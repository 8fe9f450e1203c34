"""Closest-hit and shadow queries for coherent rays: primary rays of a screen tile, and shadow rays to one light source.

Rays come in packets, one ray for each SIMD lane. They are tested against the shapes that culling left for their tile or
light-buffer cell, in order of distance, each first by its bounding cone.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.culling.light_buffer import is_close, remember_cell
from minirt.kernel.rows import intersect, is_batched, may_meet, occludes, read, surface
from minirt.kernel.scene_arrays import Group, SceneArrays, has_rows, range_in_cell, range_in_tile
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

ROUNDING = 16  # error of a surface point: unit roundoffs of its largest coordinate and of the extent of the shape
COINCIDENT = 2.0**-14  # two hits that differ by no more than this, relative to their distance, may be one place
# Bounding cones of meshes are tested in batches, so that no branch waits for a single test: saves a tenth of the time
# of a mesh, but with few shapes costs more than it saves.
BATCH = 16


def for_each_kind(step: Callable[..., Any], groups: tuple[Group, ...], state: Any, arguments: Any) -> Any:
    """Fold `state = step(group, state, arguments)` over the groups, one for each kind of shape.

    Compiled, the loop is unrolled, and each step contains the formulas of its own kind.
    """
    for group in groups:
        state = step(group, state, arguments)
    return state


def is_empty(scene: SceneArrays, tile: int) -> bool:
    """Whether no shape can be seen in a tile of the picture."""
    return bool(for_each_kind(count_kind, scene.groups, 0, tile) == 0)


def count_kind(group: Group, count: int, tile: int) -> int:
    """Add the number of shapes of one kind in a tile to `count`."""
    start, end = range_in_tile(group, tile)
    return count + end - start


def closest_hit(scene: SceneArrays, tile: int, origin: Vec, direction: Vec) -> tuple[Number, Number, Number]:
    """Find the closest hit of each primary ray in a tile: distance, index and extent of the shape that is hit.

    A ray that hits nothing gets infinity, -1 and 0. Where two surfaces coincide within rounding, the shape with the
    lower index is hit on the whole overlap, and the extent is the larger of the two.
    """
    no_hit = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x)
    best, owner, extent = for_each_kind(closest_of_kind, scene.groups, no_hit, (scene, tile, origin, direction))
    return best, owner, extent


def closest_of_kind(
    group: Group, state: tuple[Number, Number, Number], arguments: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """Continue `closest_hit` over the shapes of one kind; `state` has the closest hits of the kinds before."""
    return (closest_batched if is_batched(group.rows) else closest_one_by_one)(group, state, arguments)


def closest_one_by_one(
    group: Group, state: tuple[Number, Number, Number], arguments: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """Continue `closest_hit` over the shapes of one kind, one shape after the other."""
    scene, tile, origin, direction = arguments
    start, end = range_in_tile(group, tile)
    for i in range(start, end):
        index = scene.tile_shapes[i]
        cone = scene.cones[index]
        if not any(state[0] > cone[4]):
            break
        everywhere = cone[3] <= -1.0
        if everywhere or rarely(in_cone(cone, direction)):
            shape = read(group.rows, scene.slots[index, 1])
            if everywhere or any(may_meet(shape, origin, None, direction, state[0] > cone[4])):
                hit, t = intersect(shape, origin, direction)
                state = closer_hit(shape, index, scene.colours_and_extents[index, 3], hit, t, origin, direction, state)
    return state


def closest_batched(
    group: Group, state: tuple[Number, Number, Number], arguments: tuple[SceneArrays, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """Continue `closest_hit` over the shapes of one kind, testing the bounding cones of a whole batch first."""
    scene, tile, origin, direction = arguments
    start, end = range_in_tile(group, tile)
    while start < end:
        farthest = greatest(state[0])
        candidates = 0  # a bit for each shape of the batch
        for i in range(start, min(start + BATCH, end)):
            cone = scene.cones[scene.tile_shapes[i]]
            if not farthest > cone[4]:
                end = i
                break
            candidates |= int(any(in_cone(cone, direction))) << (i - start)
        while candidates != 0:
            index = scene.tile_shapes[start + lowest(candidates)]
            candidates &= candidates - 1
            cone = scene.cones[index]
            active = state[0] > cone[4]
            if not any(active):
                return state
            shape = read(group.rows, scene.slots[index, 1])
            if cone[3] <= -1.0 or any(may_meet(shape, origin, None, direction, active)):
                hit, t = intersect(shape, origin, direction)
                state = closer_hit(shape, index, scene.colours_and_extents[index, 3], hit, t, origin, direction, state)
        start += BATCH
    return state


def closer_hit(
    shape: Any,
    index: int,
    shape_extent: float,
    hit: Mask,
    t: Number,
    origin: Vec,
    direction: Vec,
    state: tuple[Number, Number, Number],
) -> tuple[Number, Number, Number]:
    """Update the closest hits, `state`, by the hits of one shape at distance t.

    The nearer hit wins. Where both lie within rounding of each other, the shape with the lower index wins.
    """
    best, owner, extent = state
    new_extent = splat(shape_extent, best)
    closer = hit & (t < best)
    contested = hit & (best < inf)
    if rarely(contested):
        contested = contested & (fabs(t - best) <= COINCIDENT * t)
    if any(contested):
        point = origin + t * direction
        _, normal = surface(shape, point)
        gap = fabs(t - best) * fabs(dot(normal, direction))  # between the surfaces
        rounding = ROUNDING * unit_roundoff(best) * (largest(point) + largest(origin) + new_extent)
        same = contested & (gap <= 4.0 * rounding)
        closer = (closer & (same ^ True)) | (same & (index < owner))
        new_extent = where(same, maximum(new_extent, extent), new_extent)
        extent = where(same, new_extent, extent)
    if any(closer):
        best = where(closer, t, best)
        owner = where(closer, index, owner)
        extent = where(closer, new_extent, extent)
    return best, owner, extent


def in_cone(cone: Any, direction: Vec) -> Mask:
    """Whether a direction from the apex of a bounding cone lies in the cone."""
    return dot(Vec(cone[0], cone[1], cone[2]), direction) >= cone[3]


def unoccluded(
    scene: SceneArrays,
    memory: Any,
    light: int,
    origin: Vec,
    direction: Vec,
    distance: Number,
    active: Mask,
    glass: bool,
) -> Mask:
    """Trace shadow rays to a light source: the `active` rays that hit nothing nearer than `distance`.

    Only opaque shapes count, or with `glass` only transparent ones; in kernels without glass all shapes.
    Only shapes in the light-buffer cell of a ray are tested (Haines and Greenberg 1986). The shapes of a cell hold for
    directions close around it too, and `memory` (m, 4) caches for each light the direction that was last looked up and
    its cell: most rays of a packet, and of the next packet, need no other lookup.
    """
    if scene.light_buffer_cells == 1:
        return for_each_kind(
            unoccluded_by_kind, scene.groups, active, (scene, light, 0, active, origin, direction, distance, glass)
        )
    visible = active
    remaining = active
    for _ in range(width(distance)):  # at most one lookup for each ray
        if not any(remaining):
            break
        in_cell = remaining & is_close(memory[light], scene.light_buffers[light], direction)
        if rarely(not any(in_cell)):
            remember_cell(
                memory[light], scene.light_buffers[light], scene.light_buffer_cells, direction, first(remaining)
            )
            in_cell = remaining & is_close(memory[light], scene.light_buffers[light], direction)
        arguments = (scene, light, int(memory[light, 3]), in_cell, origin, direction, distance, glass)
        visible = for_each_kind(unoccluded_by_kind, scene.groups, visible, arguments)
        remaining = remaining & ~in_cell
    return visible


def unoccluded_by_kind(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove the shadow rays that a shape of one kind occludes from `visible`; only rays `in_cell` are tested."""
    return (unoccluded_batched if is_batched(group.rows) else unoccluded_one_by_one)(group, visible, arguments)


def unoccluded_one_by_one(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove occluded shadow rays from `visible`, testing the shapes of one kind one after the other."""
    scene, light, cell, in_cell, origin, direction, distance, glass = arguments
    position = Vec(scene.lights[light, 0], scene.lights[light, 1], scene.lights[light, 2])
    start, end = range_in_cell(group, light, cell)
    for i in range(start, end):
        index = scene.light_shapes[i]
        cone = scene.light_cones[light, index]
        if not any(visible & in_cell & (distance > cone[4])):
            break
        everywhere = cone[3] <= -1.0
        if counts(scene, index, glass) and (everywhere or rarely(in_cell & in_cone(cone, -direction))):
            shape = read(group.rows, scene.slots[index, 1])
            if everywhere or any(may_meet(shape, position, origin, direction, visible & in_cell)):
                hit, t = occludes(shape, origin, direction)
                visible = visible & ~(in_cell & hit & (t < distance))
    return visible


def unoccluded_batched(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove occluded shadow rays from `visible`, testing the bounding cones of a whole batch of shapes first."""
    scene, light, cell, in_cell, origin, direction, distance, glass = arguments
    position = Vec(scene.lights[light, 0], scene.lights[light, 1], scene.lights[light, 2])
    start, end = range_in_cell(group, light, cell)
    while start < end:
        farthest = greatest(where(visible & in_cell, distance, -inf))
        candidates = 0
        for i in range(start, min(start + BATCH, end)):
            cone = scene.light_cones[light, scene.light_shapes[i]]
            if not farthest > cone[4]:
                end = i
                break
            if counts(scene, scene.light_shapes[i], glass):
                candidates |= int(any(in_cell & in_cone(cone, -direction))) << (i - start)
        while candidates != 0:
            index = scene.light_shapes[start + lowest(candidates)]
            candidates &= candidates - 1
            shape = read(group.rows, scene.slots[index, 1])
            everywhere = scene.light_cones[light, index, 3] <= -1.0
            if everywhere or any(may_meet(shape, position, origin, direction, visible & in_cell)):
                hit, t = occludes(shape, origin, direction)
                visible = visible & ~(in_cell & hit & (t < distance))
        start += BATCH
    return visible


def counts(scene: SceneArrays, index: int, glass: bool) -> bool:
    """Whether a shape counts as an occluder: the transparent ones with `glass`, the opaque ones without."""
    if scene.transparent is None:
        return True
    return (has_rows(scene.transparent) and scene.transparent[index, 1] > 0.0) == glass
