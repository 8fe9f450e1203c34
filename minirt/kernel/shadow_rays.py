"""Shadow queries for coherent rays: those to one light source from what the rays of a packet hit.

They are tested against the shapes that culling left for their light-buffer cell, in order of distance, each first by
its bounding cone.
"""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.culling.light_buffer import is_close, remember_cell
from minirt.kernel.rows import is_batched, may_meet, occludes, read
from minirt.kernel.scene_arrays import Group, SceneArrays, has_rows, range_in_cell
from minirt.kernel.trace import BATCH, for_each_kind, in_cone
from minirt.lanes import Mask, Number, Vec, any, first, greatest, lowest, rarely, where, width


def unoccluded(
    scene: SceneArrays,
    memory: Any,
    light: int,
    position: Vec,
    towards: Vec,
    origin: Vec,
    direction: Vec,
    distance: Number,
    active: Mask,
    glass: bool,
) -> Mask:
    """Trace shadow rays to the `position` of a light source: the `active` rays that hit nothing nearer than `distance`.

    Only opaque shapes count, or with `glass` only transparent ones; in kernels without glass all shapes.
    Only shapes in the light-buffer cell of a ray are tested (Haines and Greenberg 1986). The shapes of a cell hold for
    directions close around it too, and `memory` (m, 4) caches for each light the direction that was last looked up and
    its cell: most rays of a packet, and of the next packet, need no other lookup. Cells and cones are those of the
    directions `towards` the centre of the light source; they differ from `direction` where that has a size.
    """
    if scene.light_buffer_cells == 1:
        return for_each_kind(
            unoccluded_by_kind,
            scene.groups,
            active,
            (scene, light, position, towards, 0, active, origin, direction, distance, glass),
        )
    visible = active
    remaining = active
    for _ in range(width(distance)):  # at most one lookup for each ray
        if not any(remaining):
            break
        in_cell = remaining & is_close(memory[light], scene.light_buffers[light], towards)
        if rarely(not any(in_cell)):
            remember_cell(
                memory[light], scene.light_buffers[light], scene.light_buffer_cells, towards, first(remaining)
            )
            in_cell = remaining & is_close(memory[light], scene.light_buffers[light], towards)
        cell = int(memory[light, 3])
        arguments = (scene, light, position, towards, cell, in_cell, origin, direction, distance, glass)
        visible = for_each_kind(unoccluded_by_kind, scene.groups, visible, arguments)
        remaining = remaining & ~in_cell
    return visible


def unoccluded_by_kind(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, Vec, Vec, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove the shadow rays that a shape of one kind occludes from `visible`; only rays `in_cell` are tested."""
    return (unoccluded_batched if is_batched(group.rows) else unoccluded_one_by_one)(group, visible, arguments)


def unoccluded_one_by_one(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, Vec, Vec, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove occluded shadow rays from `visible`, testing the shapes of one kind one after the other."""
    scene, light, position, towards, cell, in_cell, origin, direction, distance, glass = arguments
    start, end = range_in_cell(group, light, cell)
    for i in range(start, end):
        index = scene.light_shapes[i]
        cone = scene.light_cones[light, index]
        if not any(visible & in_cell & (distance > cone[4])):
            break
        everywhere = cone[3] <= -1.0
        if counts(scene, index, glass) and (everywhere or rarely(in_cell & in_cone(cone, -towards))):
            shape = read(group.rows, scene.slots[index, 1])
            if everywhere or any(may_meet(shape, position, origin, direction, visible & in_cell)):
                hit, t = occludes(shape, origin, direction)
                visible = visible & ~(in_cell & hit & (t < distance))
    return visible


def unoccluded_batched(
    group: Group, visible: Mask, arguments: tuple[SceneArrays, int, Vec, Vec, int, Mask, Vec, Vec, Number, bool]
) -> Mask:
    """Remove occluded shadow rays from `visible`, testing the bounding cones of a whole batch of shapes first."""
    scene, light, position, towards, cell, in_cell, origin, direction, distance, glass = arguments
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
                candidates |= int(any(in_cell & in_cone(cone, -towards))) << (i - start)
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
