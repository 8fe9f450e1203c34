"""What is where a ray hits: the surface and how it looks."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.rows import read, shading, surface
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.kernel.shading.texturing import apply_maps
from minirt.kernel.trace import for_each_kind
from minirt.lanes import Vec, any, first, lane, rarely, splat, where
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


class Surface(NamedTuple):
    """A place of a shape for each ray."""

    point: Vec  # on the surface
    normal: Vec  # of the shape, outward where there is an outside
    shading_normal: Vec  # the normal by which it is lit
    colour: Vec
    specular: Vec  # its row of `Traced.gloss`
    reflective: Vec  # and of `Traced.bounces`


def surfaces(scene: SceneArrays, memory: Any, owner: Number, point: Vec, hit: Mask) -> Surface:
    """The surfaces that rays hit within rounding of a point.

    The rays of a packet hit few different shapes, mostly one. The first that is asked is the last one of the packet
    before, which `memory` keeps, and what it answers is taken for all rays; others only correct it for theirs.
    """
    index = int(memory[scene.lights.shape[0], 0])
    left = hit & (owner != index)
    if rarely(left) and not any(hit & (owner == index)):
        index = int(lane(owner, first(hit)))
        left = hit & (owner != index)
    found = surface_at(scene, index, point)
    while rarely(left):
        index = int(lane(owner, first(left)))
        mine = left & (owner == index)
        other = surface_at(scene, index, point)
        found = Surface(
            where(mine, other.point, found.point),
            where(mine, other.normal, found.normal),
            where(mine, other.shading_normal, found.shading_normal),
            where(mine, other.colour, found.colour),
            where(mine, other.specular, found.specular),
            where(mine, other.reflective, found.reflective),
        )
        left = left & ~mine
    memory[scene.lights.shape[0], 0] = index
    return found


def surface_at(scene: SceneArrays, index: int, point: Vec) -> Surface:
    """The surface of one shape, for all rays."""
    place = scene.slots[index]
    on, normal, bent, _ = for_each_kind(
        surface_of_kind, scene.groups, (point, point, point, 0), (place[0], place[1], point)
    )
    nothing = splat(0.0, point.x)
    gloss = bounces = Vec(nothing, nothing, nothing)
    colour = row_of(scene.colours_and_extents, index, point.x)
    if scene.surface_maps is not None:
        bent, colour = apply_maps(scene.surface_maps, scene.groups, index, place, on, bent, colour)
    if scene.specular is not None:
        gloss = row_of(scene.specular, index, point.x)
    if scene.reflective is not None:
        bounces = row_of(scene.reflective, index, point.x)
    return Surface(on, normal, bent, colour, gloss, bounces)


def surface_of_kind(
    group: Group, state: tuple[Vec, Vec, Vec, int], given: tuple[int, int, Vec]
) -> tuple[Vec, Vec, Vec, int]:
    """`surface` and `shading` of row i of this kind, if it is the one that is wanted; the last of the state counts the
    kinds."""
    on, normal, bent, number = state
    wanted, i, point = given
    if number == wanted:
        shape = read(group.rows, i)
        on, out = surface(shape, point)
        normal = Vec(splat(out.x, point.x), splat(out.y, point.x), splat(out.z, point.x))
        bent = shading(shape, on, normal)
    return on, normal, bent, number + 1


def row_of(table: Any, index: int, like: Number) -> Vec:
    """The first three numbers of a row, for all rays."""
    return Vec(splat(table[index, 0], like), splat(table[index, 1], like), splat(table[index, 2], like))
