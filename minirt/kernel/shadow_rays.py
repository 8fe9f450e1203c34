"""Shadow queries for coherent rays: those to one light source from what the rays of a packet hit.

They are tested against the shapes that culling left for their light-buffer cell, in order of distance, each first by
its bounding cone (Haines and Greenberg 1986). The cells of a light cover the faces of a cube around it. Each cell has a
list of the shapes that can be hit in the circle around it; in the middle of a face, its radius is `CIRCLE`.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from minirt.kernel.beam_traversal import fold_over_mesh
from minirt.kernel.beams import vec_of
from minirt.kernel.scene_arrays import (
    AXIS,
    COSINE,
    LEAST_DISTANCE,
    PRIMITIVE,
    ROW,
    Group,
    SceneArrays,
    has_rows,
    is_convex,
    may_meet,
    occludes,
    range_in_cell,
    read_row,
    vector,
)
from minirt.kernel.trace import ClosestHit, for_each_kind
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, first, floor, minimum, rarely, splat, unit, where, width

CIRCLE = 1.1 * 2.0**0.5  # in half edges of a cell: with 16 of them or more on an edge it takes in all corners
CACHED = 5  # numbers that `remember_cell` writes: a direction,
CELL, SQUARED_RADIUS = 3, 4  # and in these columns a cell, and the square of the radius of its circle
PARALLEL = 6  # column of `SceneArrays.spots`: 1 for parallel light


def is_close(cached: Any, direction: Vec) -> Mask:
    """Whether directions are in the circle around the cached cell."""
    difference = direction - vector(cached, 0)
    return dot(difference, difference) <= cached[SQUARED_RADIUS]


def remember_cell(cached: Any, cells: int, direction: Vec, ray: int) -> None:
    """Cache the cell that a ray arrives through: the direction of its middle, towards the light, its number, and the
    square of the radius of the circle around it."""
    cell, middle = light_buffer_cell(-vec_of(direction, ray), cells)
    towards, radius = -unit(middle), CIRCLE / cells
    cached[0], cached[1], cached[2], cached[CELL] = towards.x, towards.y, towards.z, cell
    # As the light sees it, a face shrinks towards its edges.
    cached[SQUARED_RADIUS] = radius * radius / dot(middle, middle)


def light_buffer_cell(direction: Vec, cells: int) -> tuple[Number, Vec]:
    """Return the cell that a direction from the light falls into, (face * cells + row) * cells + column, and its middle
    on the cube from -1 to 1. There are `cells` cells along an edge.

    Faces 0 to 5 are +x, -x, +y, -y, +z, -z; on each, columns go along the next axis in the cycle x, y, z, rows along
    the one after it, both from -1 to 1.
    """
    ax, ay, az = fabs(direction.x), fabs(direction.y), fabs(direction.z)
    along_x = (ax >= ay) & (ax >= az)
    along_y = ~along_x & (ay >= az)
    major = where(along_x, direction.x, where(along_y, direction.y, direction.z))
    across = where(along_x, direction.y, where(along_y, direction.z, direction.x))
    down = where(along_x, direction.z, where(along_y, direction.x, direction.y))
    side = where(major > 0.0, 0.0, 1.0)
    face = where(along_x, 0.0, where(along_y, 2.0, 4.0)) + side
    half = 0.5 * cells
    scale = half / fabs(major)
    column = minimum(floor(across * scale + half), cells - 1.0)
    row = minimum(floor(down * scale + half), cells - 1.0)
    x, y, z = (column + 0.5) / half - 1.0, (row + 0.5) / half - 1.0, 1.0 - 2.0 * side
    middle = where(along_x, Vec(z, x, y), where(along_y, Vec(y, z, x), Vec(x, y, z)))
    return (face * cells + row) * cells + column, middle


class ShadowRays(NamedTuple):
    """Rays of a packet to one light source."""

    light: int
    position: Vec  # where the rays end
    towards: Vec  # directions towards the centre of the light source; it may have a size
    origin: Vec
    direction: Vec
    distance: Number  # of the end
    own: Number  # the index of the shape that a ray starts on and leads away from, which cannot occlude it; or -1
    left: int  # the index of a shape that all rays start on and lead away from, on its outside; or -1


def shape_left(found: ClosestHit, side: Number, hit: Mask) -> int:
    """Return the index of the one shape that all rays of the mask `hit` have met from its outside, or -1.

    If it is convex, shadow rays, which start clear of it and on the side of its normal, never meet it again. Packets on
    its lit side, whose light-buffer cells list it, need no test: that is half of the tests of shadow rays on fifty.rt,
    and a tenth of the frame.
    """
    _, owner, _, index = found
    return -1 if rarely(hit & ((owner != index) | (side < 0.0))) else index


def unoccluded(scene: SceneArrays, memory: Any, rays: ShadowRays, active: Mask, glass: bool) -> Mask:
    """Trace shadow rays, and return those of the `active` ones that hit nothing nearer than their end.

    Only opaque shapes count, or with `glass` only transparent ones; in kernels without glass all shapes count.
    Only shapes in the light-buffer cell of a ray are tested (Haines and Greenberg 1986). `memory` (m, `CACHED`) caches
    for each light the cell that was last looked up: most rays of a packet, and of the next packet, are in the circle
    around that cell and need no other lookup. Cells and cones are those of the directions `towards` the centre of the
    light source.
    """
    if scene.light_buffer_cells == 1:  # no light buffers: cell 0 has all shapes
        return for_each_kind(unoccluded_by_kind, scene.groups, active, (scene, rays, 0, active, glass))
    visible = active
    remaining = active
    for _ in range(width(rays.distance)):  # at most one lookup for each ray
        if not any(remaining):
            break
        in_cell = remaining & is_close(memory[rays.light], rays.towards)
        if rarely(not any(in_cell)):
            remember_cell(memory[rays.light], scene.light_buffer_cells, rays.towards, first(remaining))
            in_cell = remaining & is_close(memory[rays.light], rays.towards)
        arguments = (scene, rays, int(memory[rays.light, CELL]), in_cell, glass)
        visible = for_each_kind(unoccluded_by_kind, scene.groups, visible, arguments)
        remaining = remaining & ~in_cell
    return visible


# And the rays' cell, which of them are in it, and whether transparent shapes alone count or opaque ones alone: `glass`.
Arguments = tuple[SceneArrays, ShadowRays, int, Mask, bool]


def unoccluded_by_kind(group: Group, visible: Mask, arguments: Arguments) -> Mask:
    """Return the mask `visible` without the shadow rays that shapes of one kind occlude; rays `in_cell` are tested.

    The shapes of a cell are in order of distance: behind the first one that is too far there is nothing to test.
    """
    scene, rays, cell, in_cell, glass = arguments
    start, end = range_in_cell(group, rays.light, cell)
    for i in range(start, end):
        cone, listed = scene.light_cones[rays.light, scene.light_shapes[i]], scene.listed[scene.light_shapes[i]]
        row, index = listed[ROW], listed[PRIMITIVE]
        if not any(visible & in_cell & (rays.distance > cone[LEAST_DISTANCE])):
            break
        # Minus the cosine of the angle from the axis, as rays lead to the light.
        towards, cosine = dot(vector(cone, AXIS), rays.towards), cone[COSINE]
        counted = may_count(scene, index, glass) and not (index == rays.left and is_convex(read_row(group, row)))
        if counted and (cosine <= -1.0 or rarely(in_cell & (towards <= -cosine))):
            if group.trees is None:
                visible = unoccluded_by_shape(group, row, index, in_cell, visible, arguments)
            else:
                beams, active = rays_from_light(scene, rays), visible & in_cell
                visible = fold_over_mesh(unoccluded_by_shape, reach_of, group, row, beams, active, visible, arguments)
    return visible


def unoccluded_by_shape(group: Group, row: int, index: int, active: Mask, visible: Mask, arguments: Arguments) -> Mask:
    """Remove the shadow rays that one shape, or a triangle of a mesh, occludes from `visible`; only `active` ones may
    meet it."""
    scene, rays, _, _, glass = arguments
    shape = read_row(group, row)
    if counts(scene, index, glass) and (
        group.triangles is not None
        or is_parallel(scene, rays.light)
        or any(may_meet(shape, rays.position, rays.origin, rays.direction, visible & active))
    ):
        limit = where(visible & active, rays.distance, -inf)
        visible = visible & ~occludes(shape, rays.origin, rays.direction, limit)
    return visible


def rays_from_light(scene: SceneArrays, rays: ShadowRays) -> tuple[Vec, Vec, Number]:
    """Return the points of a light source that shadow rays lead to, and the ways from there to where the rays start;
    for parallel light, where they start and their directions; and the shapes that they start on."""
    if is_parallel(scene, rays.light):
        return rays.origin, rays.direction, rays.own
    position = splat(rays.position, rays.distance)
    return position, rays.origin - position, rays.own


def reach_of(visible: Mask, arguments: Arguments) -> Number:
    """Return the part of the `rays_from_light` in which shapes occlude the rays that are still visible."""
    scene, rays, _, _, _ = arguments
    return where(visible, splat(inf if is_parallel(scene, rays.light) else 1.0, rays.distance), -inf)


def is_parallel(scene: SceneArrays, light: int) -> bool:
    """Whether a light source is parallel light."""
    return has_rows(scene.spots) and scene.spots[light, PARALLEL] > 0.5


def counts(scene: SceneArrays, index: int, glass: bool) -> bool:
    """Whether a shape counts as an occluder: the transparent ones with `glass`, the opaque ones without."""
    if scene.transparent is None:
        return True
    return (has_rows(scene.transparent) and scene.transparent[index, 1] > 0.0) == glass


def may_count(scene: SceneArrays, index: int, glass: bool) -> bool:
    """Whether a shape, or some triangle of the mesh whose first one it is, counts as an occluder."""
    return counts(scene, index, glass) or (has_rows(scene.transparent) and scene.transparent[index, 4] > 0.0)
