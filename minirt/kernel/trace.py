"""Rays against all shapes of a scene."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.rows import Rows, index_of, intersect, read, surface
from minirt.kernel.traced import Traced
from minirt.lanes import Vec, any, dot, fabs, first, lane, maximum, splat, where
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask

ROUNDING = 16 * 2.0**-53  # of a point on a surface, relative to its largest coordinate and the extent of the shape
NEARBY = 1e-5  # two hits so close to each other, relative to their distance, may be one place


def over_kinds(step: Callable[..., Any], groups: tuple[Rows, ...], state: Any, given: Any) -> Any:
    """The state after `state = step(rows, state, given)` for the rows of each kind in turn.

    Compiled, it is the same steps one after the other, each with the formulas of its kind in it.
    """
    for rows in groups:
        state = step(rows, state, given)
    return state


def largest(v: Vec) -> Number:
    """The largest coordinate, without its sign."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))


def nearest(scene: Traced, origin: Vec, direction: Vec) -> tuple[Number, Number]:
    """The distance to the first hit of each ray and the index of the shape that is hit; infinity and -1 where none is.

    Where two surfaces coincide within rounding the shape with the lower index is hit, on the whole of the overlap.
    """
    nothing = splat(inf), splat(-1.0)
    best, owner = over_kinds(nearest_of_kind, scene.groups, nothing, (scene.extents, origin, direction))
    return best, owner


def nearest_of_kind(rows: Rows, state: tuple[Number, Number], given: tuple[Any, Vec, Vec]) -> tuple[Number, Number]:
    """`nearest` over the shapes of one kind, where others gave `state`."""
    best, owner = state
    extents, origin, direction = given
    for i in range(rows.shape[0]):
        shape = read(rows, i)
        hit, t = intersect(shape, origin, direction)
        closer = hit & (t < best)
        contested = hit & (fabs(t - best) <= NEARBY * t)
        if any(contested):
            index = index_of(rows, i)
            point = origin + t * direction
            _, normal = surface(shape, point)
            gap = fabs(t - best) * fabs(dot(normal, direction))  # between the surfaces
            rounding = ROUNDING * (largest(point) + largest(origin) + extents[int(index)])
            same = contested & (gap <= 4.0 * rounding)
            closer = (closer & ~same) | (same & (index < owner))
        if any(closer):
            best = where(closer, t, best)
            owner = where(closer, index_of(rows, i), owner)
    return best, owner


def occluded(scene: Traced, origin: Vec, direction: Vec, distance: Number, asked: Mask) -> Mask:
    """Of the rays that are `asked` for, those that hit anything nearer than `distance`."""
    return asked & ~over_kinds(free_of_kind, scene.groups, asked, (origin, direction, distance))


def free_of_kind(rows: Rows, free: Mask, given: tuple[Vec, Vec, Number]) -> Mask:
    """Of the rays that were free so far, those that the shapes of one kind do not stop either."""
    origin, direction, distance = given
    for i in range(rows.shape[0]):
        if not any(free):
            break
        hit, t = intersect(read(rows, i), origin, direction)
        free = free & ~(hit & (t < distance))
    return free


def surfaces(scene: Traced, owner: Number, point: Vec, hit: Mask) -> tuple[Vec, Vec]:
    """For rays that hit: the point put onto the surface of the shape that is hit, and the normal there.

    The rays of a packet hit few different shapes; each shape's formula is asked once, for all of its rays.
    """
    on, normal = point, point
    left = hit
    while any(left):
        index = int(lane(owner, first(left)))
        mine = left & (owner == index)
        group, i = scene.places[index, 0], scene.places[index, 1]
        on, normal, _ = over_kinds(surface_of_kind, scene.groups, (on, normal, 0), (group, i, point, mine))
        left = left & ~mine
    return on, normal


def surface_of_kind(rows: Rows, state: tuple[Vec, Vec, int], given: tuple[int, int, Vec, Mask]) -> tuple[Vec, Vec, int]:
    """`surfaces` for the rays `mine`, if they hit row i of this kind; the last of the state counts the kinds."""
    on, normal, group = state
    wanted, i, point, mine = given
    if group == wanted:
        moved, out = surface(read(rows, i), point)
        on = where(mine, moved, on)
        normal = where(mine, out, normal)
    return on, normal, group + 1
