"""Rays against all shapes of a scene."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.rows import intersect, read, surface
from minirt.kernel.traced import Group, Traced
from minirt.lanes import Vec, any, dot, fabs, first, floor, lane, maximum, minimum, splat, where
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask

ROUNDING = 16 * 2.0**-53  # of a point on a surface, relative to its largest coordinate and the extent of the shape
NEARBY = 1e-5  # two hits so close to each other, relative to their distance, may be one place


def over_kinds(step: Callable[..., Any], groups: tuple[Group, ...], state: Any, given: Any) -> Any:
    """The state after `state = step(group, state, given)` for the shapes of each kind in turn.

    Compiled, it is the same steps one after the other, each with the formulas of its kind in it.
    """
    for group in groups:
        state = step(group, state, given)
    return state


def largest(v: Vec) -> Number:
    """The largest coordinate, without its sign."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))


def nearest(scene: Traced, tile: int, origin: Vec, direction: Vec) -> tuple[Number, Number, Number]:
    """The distance to the first hit of each ray, the index of the shape that is hit and its extent; infinity, -1 and 0
    where none is.

    The rays come from the eye and lie in a tile of the picture. Where two surfaces coincide within rounding the shape
    with the lower index is hit, on the whole of the overlap, and the extent is the larger of the two.
    """
    nothing = splat(inf), splat(-1.0), splat(0.0)
    best, owner, extent = over_kinds(nearest_of_kind, scene.groups, nothing, (scene, tile, origin, direction))
    return best, owner, extent


def nearest_of_kind(
    group: Group, state: tuple[Number, Number, Number], given: tuple[Traced, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """`nearest` over the shapes of one kind, where others gave `state`."""
    best, owner, extent = state
    scene, tile, origin, direction = given
    for i in range(group.starts[tile], group.starts[tile + 1]):
        index = scene.seen[i]
        if not any(best > scene.near[index]):
            break
        shape = read(group.rows, scene.places[index, 1])
        hit, t = intersect(shape, origin, direction)
        closer = hit & (t < best)
        contested = hit & (fabs(t - best) <= NEARBY * t)
        reach = splat(scene.extents[index])
        if any(contested):
            point = origin + t * direction
            _, normal = surface(shape, point)
            gap = fabs(t - best) * fabs(dot(normal, direction))  # between the surfaces
            rounding = ROUNDING * (largest(point) + largest(origin) + reach)
            same = contested & (gap <= 4.0 * rounding)
            closer = (closer & ~same) | (same & (index < owner))
            reach = where(same, maximum(reach, extent), reach)
            extent = where(same, reach, extent)
        if any(closer):
            best = where(closer, t, best)
            owner = where(closer, index, owner)
            extent = where(closer, reach, extent)
    return best, owner, extent


def unhidden(scene: Traced, lamp: int, origin: Vec, direction: Vec, distance: Number, asked: Mask) -> Mask:
    """Of the rays towards a lamp that are `asked` for, those that hit nothing nearer than `distance`.

    Only shapes that the lamp sees in the direction of a ray are tried. The rays of a packet lie in few different cells
    of the cube around the lamp; each cell is done once, for all of its rays.
    """
    if scene.grid == 1:  # a single cell holds all shapes
        return over_kinds(unhidden_by_kind, scene.groups, asked, (scene, lamp, 0, asked, origin, direction, distance))
    cells = cell(-direction, scene.grid)
    free = asked
    left = asked
    while any(left):
        at = lane(cells, first(left))
        mine = left & (cells == at)
        given = (scene, lamp, int(at), mine, origin, direction, distance)
        free = over_kinds(unhidden_by_kind, scene.groups, free, given)
        left = left & ~mine
    return free


def unhidden_by_kind(group: Group, free: Mask, given: tuple[Traced, int, int, Mask, Vec, Vec, Number]) -> Mask:
    """Of the rays that are free so far, those that the shapes of one kind do not stop; only `mine` are tried."""
    scene, lamp, at, mine, origin, direction, distance = given
    for i in range(group.lamp_starts[lamp, at], group.lamp_starts[lamp, at + 1]):
        index = scene.lit[i]
        if not any(free & mine & (distance > scene.lamp_near[lamp, index])):
            break
        hit, t = intersect(read(group.rows, scene.places[index, 1]), origin, direction)
        free = free & ~(mine & hit & (t < distance))
    return free


def cell(direction: Vec, grid: int) -> Number:
    """The cell of a cube around a lamp that a direction from it goes through: (face * grid + row) * grid + column.

    Faces 0 to 5 are +x, -x, +y, -y, +z, -z; on each, columns go along the next axis in the cycle x, y, z, rows along
    the one after it, both from -1 to 1.
    """
    ax, ay, az = fabs(direction.x), fabs(direction.y), fabs(direction.z)
    along_x = (ax >= ay) & (ax >= az)
    along_y = ~along_x & (ay >= az)
    major = where(along_x, direction.x, where(along_y, direction.y, direction.z))
    across = where(along_x, direction.y, where(along_y, direction.z, direction.x))
    down = where(along_x, direction.z, where(along_y, direction.x, direction.y))
    face = where(along_x, 0.0, where(along_y, 2.0, 4.0)) + where(major > 0.0, 0.0, 1.0)
    half = 0.5 * grid
    scale = half / fabs(major)
    column = minimum(floor(across * scale + half), grid - 1.0)
    row = minimum(floor(down * scale + half), grid - 1.0)
    return (face * grid + row) * grid + column


def surfaces(scene: Traced, owner: Number, point: Vec, hit: Mask) -> tuple[Vec, Vec, Vec]:
    """For rays that hit: the point put onto the surface of the shape that is hit, and the normal and the colour there.

    The rays of a packet hit few different shapes; each shape is asked once, for all of its rays.
    """
    on, normal, colour = point, point, point
    left = hit
    while any(left):
        index = int(lane(owner, first(left)))
        mine = left & (owner == index)
        group, i = scene.places[index, 0], scene.places[index, 1]
        on, normal, _ = over_kinds(surface_of_kind, scene.groups, (on, normal, 0), (group, i, point, mine))
        colour = where(mine, Vec(scene.colours[index, 0], scene.colours[index, 1], scene.colours[index, 2]), colour)
        left = left & ~mine
    return on, normal, colour


def surface_of_kind(
    group: Group, state: tuple[Vec, Vec, int], given: tuple[int, int, Vec, Mask]
) -> tuple[Vec, Vec, int]:
    """`surfaces` for the rays `mine`, if they hit row i of this kind; the last of the state counts the kinds."""
    on, normal, number = state
    wanted, i, point, mine = given
    if number == wanted:
        moved, out = surface(read(group.rows, i), point)
        on = where(mine, moved, on)
        normal = where(mine, out, normal)
    return on, normal, number + 1
