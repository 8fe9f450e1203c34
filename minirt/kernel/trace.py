"""Rays against all shapes of a scene."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.rows import intersect, read, surface
from minirt.kernel.traced import Group, Traced
from minirt.lanes import (
    Vec,
    any,
    dot,
    fabs,
    first,
    floor,
    lane,
    maximum,
    minimum,
    rarely,
    splat,
    unit_roundoff,
    where,
    width,
)
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask

ROUNDING = 16  # of a point on a surface: unit roundoffs of its largest coordinate and of the extent of the shape
NEARBY = 2.0**-14  # two hits so close to each other, relative to their distance, may be one place


def over_kinds(step: Callable[..., Any], groups: tuple[Group, ...], state: Any, given: Any) -> Any:
    """The state after `state = step(group, state, given)` for the shapes of each kind in turn.

    Compiled, it is the same steps one after the other, each with the formulas of its kind in it.
    """
    for group in groups:
        state = step(group, state, given)
    return state


def is_empty(scene: Traced, tile: int) -> bool:
    """Whether no shape can be seen in a tile of the picture."""
    return bool(over_kinds(count_of_kind, scene.groups, 0, tile) == 0)


def count_of_kind(group: Group, count: int, tile: int) -> int:
    """The number of shapes of a kind in a tile, and `count`."""
    return count + int(group.starts[tile + 1] - group.starts[tile])


def largest(v: Vec) -> Number:
    """The largest coordinate, without its sign."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))


def nearest(scene: Traced, tile: int, origin: Vec, direction: Vec) -> tuple[Number, Number, Number]:
    """The distance to the first hit of each ray, the index of the shape that is hit and its extent; infinity, -1 and 0
    where none is.

    The rays come from the eye and lie in a tile of the picture. Where two surfaces coincide within rounding the shape
    with the lower index is hit, on the whole of the overlap, and the extent is the larger of the two.
    """
    nothing = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x)
    best, owner, extent = over_kinds(nearest_of_kind, scene.groups, nothing, (scene, tile, origin, direction))
    return best, owner, extent


def nearest_of_kind(
    group: Group, state: tuple[Number, Number, Number], given: tuple[Traced, int, Vec, Vec]
) -> tuple[Number, Number, Number]:
    """`nearest` over the shapes of one kind, where others gave `state`."""
    scene, tile, origin, direction = given
    for i in range(group.starts[tile], group.starts[tile + 1]):
        index = scene.seen[i]
        view = scene.views[index]
        if not any(state[0] > view[4]):
            break
        if view[3] <= -1.0 or rarely(within(view, direction)):
            shape = read(group.rows, scene.places[index, 1])
            hit, t = intersect(shape, origin, direction)
            state = nearer(shape, index, scene.looks[index, 3], hit, t, origin, direction, state)
    return state


def nearer(
    shape: Any,
    index: int,
    reach: float,
    hit: Mask,
    t: Number,
    origin: Vec,
    direction: Vec,
    state: tuple[Number, Number, Number],
) -> tuple[Number, Number, Number]:
    """The state of `nearest`, or in its place, where that is nearer, the hit of a shape of extent `reach` at t."""
    best, owner, extent = state
    wide = splat(reach, best)
    closer = hit & (t < best)
    contested = hit & (best < inf)
    if rarely(contested):
        contested = contested & (fabs(t - best) <= NEARBY * t)
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


def within(cone: Any, direction: Vec) -> Mask:
    """Whether a direction from the tip of a cone lies in it."""
    return dot(Vec(cone[0], cone[1], cone[2]), direction) >= cone[3]


def unhidden(scene: Traced, memory: Any, lamp: int, origin: Vec, direction: Vec, distance: Number, asked: Mask) -> Mask:
    """Of the rays towards a lamp that are `asked` for, those that hit nothing nearer than `distance`.

    Only shapes that the lamp sees in the direction of a ray are tried. The list of a cell holds for directions around
    it too, and `memory` (m, 4) keeps for each lamp the direction that was last looked up and its cell: mostly the rays
    of a packet, and those of the next, need no other.
    """
    if scene.grid == 1:
        return over_kinds(unhidden_by_kind, scene.groups, asked, (scene, lamp, 0, asked, origin, direction, distance))
    free = asked
    left = asked
    for _ in range(width(distance)):  # at most a look for each ray
        if not any(left):
            break
        mine = left & close(memory[lamp], direction, scene.spread)
        if rarely(not any(mine)):
            look_up(memory[lamp], scene.grid, direction, first(left))
            mine = left & close(memory[lamp], direction, scene.spread)
        given = (scene, lamp, int(memory[lamp, 3]), mine, origin, direction, distance)
        free = over_kinds(unhidden_by_kind, scene.groups, free, given)
        left = left & ~mine
    return free


def close(remembered: Any, direction: Vec, spread: float) -> Mask:
    """Whether a direction is as close to the remembered one as the lists of cells allow."""
    return dot(Vec(remembered[0], remembered[1], remembered[2]), direction) >= spread


def look_up(remembered: Any, grid: int, direction: Vec, ray: int) -> None:
    """Remember the direction of a ray of the packet towards the lamp, and the cell that it comes through."""
    x, y, z = lane(direction.x, ray), lane(direction.y, ray), lane(direction.z, ray)
    remembered[0] = x
    remembered[1] = y
    remembered[2] = z
    remembered[3] = cell(Vec(-x, -y, -z), grid)


def unhidden_by_kind(group: Group, free: Mask, given: tuple[Traced, int, int, Mask, Vec, Vec, Number]) -> Mask:
    """Of the rays that are free so far, those that the shapes of one kind do not stop; only `mine` are tried."""
    scene, lamp, at, mine, origin, direction, distance = given
    for i in range(group.lamp_starts[lamp, at], group.lamp_starts[lamp, at + 1]):
        index = scene.lit[i]
        view = scene.lamp_views[lamp, index]
        if not any(free & mine & (distance > view[4])):
            break
        if view[3] <= -1.0 or rarely(mine & within(view, -direction)):
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


def surfaces(scene: Traced, memory: Any, owner: Number, point: Vec, hit: Mask) -> tuple[Vec, Vec, Vec]:
    """For rays that hit: the point put onto the surface of the shape that is hit, and the normal and the colour there.

    The rays of a packet hit few different shapes, mostly one. The first that is asked is the last one of the packet
    before, which `memory` keeps, and what it answers is taken for all rays; others only correct it for theirs.
    """
    index = int(memory[scene.lights.shape[0], 0])
    left = hit & (owner != index)
    if rarely(left) and not any(hit & (owner == index)):
        index = int(lane(owner, first(hit)))
        left = hit & (owner != index)
    on, normal = surface_at(scene, index, point)
    look = colour_of(scene, index)
    colour = Vec(splat(look.x, point.x), splat(look.y, point.x), splat(look.z, point.x))
    while rarely(left):
        index = int(lane(owner, first(left)))
        mine = left & (owner == index)
        moved, out = surface_at(scene, index, point)
        on = where(mine, moved, on)
        normal = where(mine, out, normal)
        colour = where(mine, colour_of(scene, index), colour)
        left = left & ~mine
    memory[scene.lights.shape[0], 0] = index
    return on, normal, colour


def surface_at(scene: Traced, index: int, point: Vec) -> tuple[Vec, Vec]:
    """`surface` of a shape, for all rays."""
    given = scene.places[index, 0], scene.places[index, 1], point
    on, normal, _ = over_kinds(surface_of_kind, scene.groups, (point, point, 0), given)
    return on, normal


def surface_of_kind(group: Group, state: tuple[Vec, Vec, int], given: tuple[int, int, Vec]) -> tuple[Vec, Vec, int]:
    """`surface` of row i of this kind, if it is the one that is wanted; the last of the state counts the kinds."""
    on, normal, number = state
    wanted, i, point = given
    if number == wanted:
        on, out = surface(read(group.rows, i), point)
        normal = Vec(splat(out.x, point.x), splat(out.y, point.x), splat(out.z, point.x))
    return on, normal, number + 1


def colour_of(scene: Traced, index: int) -> Vec:
    """The colour of a shape."""
    return Vec(scene.looks[index, 0], scene.looks[index, 1], scene.looks[index, 2])
