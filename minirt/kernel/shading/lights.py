"""Light sources: point, spot and parallel lights, those with a size, and their specular highlights."""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays, has_rows, vector
from minirt.kernel.shadow_rays import PARALLEL, ShadowRays, is_parallel
from minirt.kernel.trace import ROUNDING
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    copysign,
    dot,
    greatest,
    inverse_root,
    load,
    load_vec,
    max_norm,
    maximum,
    minimum,
    save,
    splat,
    unit,
    unit_roundoff,
    where,
    width,
)
from minirt.lanes.mathematics import power

EDGE, PER_RISE, PER_REACH = 3, 4, 5  # columns of `SceneArrays.spots`, see `incident_light`; and `PARALLEL`


def incident_light(spots: Any, light: int, position: Vec, point: Vec) -> tuple[Vec, Number, Number]:
    """Return the unit direction from a point towards a light source, its distance, and its relative strength there.

    `spots` (m, 7) has for each light: the direction in which it shines; the cosine of the angle from there to the edge
    of a spot's cone; one over the further increase of the cosine up to where the spot has its full strength; one over
    the distance at which the light has faded to nothing (0: never); and 1 for parallel light, whose distance is
    infinite. None or no rows: all lights shine in all directions and do not fade.
    """
    offset = position - point
    squared = dot(offset, offset)
    per_length = inverse_root(squared)
    to_light = offset * per_length
    distance = squared * per_length
    if not has_rows(spots):
        return to_light, distance, splat(1.0, distance)
    axis = vector(spots[light], 0)
    parallel = spots[light, PARALLEL] > 0.5
    to_light = where(parallel, -axis, to_light)
    distance = where(parallel, inf, distance)
    inside = clamp_to_unit((-dot(to_light, axis) - spots[light, EDGE]) * spots[light, PER_RISE])  # 0 beside the cone
    strength = where(parallel, 1.0, smoothstep(inside) * maximum(1.0 - distance * spots[light, PER_REACH], 0.0))
    return to_light, distance, strength


FARTHER = 0.125  # of a cell of a grid: how much farther its list holds, for rounding


class LightGrid(NamedTuple):
    """Grids of cubic cells, the finest first, with lists of the light sources that reach what is in a cell or, along
    any axis, up to an edge above it.

    List c is `sources[starts[c]:starts[c + 1]]`, in the order of the scene. The last list has all light sources.
    """

    grids: Any  # (g, 8) least corner; cells along a scene unit, and along each edge; the list of its first cell
    starts: Any  # int32
    sources: Any  # int32


def sources_in_reach(grid: LightGrid, point: Vec, rounding: Number, hit: Mask) -> tuple[int, int]:
    """Return the range in `LightGrid.sources` of the light sources that may reach the points of the rays `hit`.

    The points are known up to `rounding`. The list is that of a cell of the finest grid in which all of them have one
    cell; it is the last list, of all light sources, where no grid has such a cell.
    """
    cell, number = -1, grid.starts.shape[0] - 2
    low_x, low_y, low_z = least(point.x, hit), least(point.y, hit), least(point.z, hit)
    high_x, high_y, high_z = -least(-point.x, hit), -least(-point.y, hit), -least(-point.z, hit)
    inexact = -least(-rounding, hit)
    for level in range(grid.grids.shape[0]):
        box = grid.grids[level]
        per_unit, columns, rows, layers = box[3], box[4], box[5], box[6]
        x = cell_along(low_x, high_x, box[0], per_unit, columns)
        y = cell_along(low_y, high_y, box[1], per_unit, rows)
        z = cell_along(low_z, high_z, box[2], per_unit, layers)
        has_cell, is_exact = min(x, y, z) >= 0.0, 4.0 * inexact * per_unit < FARTHER
        if cell < 0 and has_cell and is_exact:
            cell = int((z * rows + y) * columns + x)
            number = int(box[7]) + cell
    return int(grid.starts[number]), int(grid.starts[number + 1])


def least(x: Number, rays: Mask) -> float:
    """Return the least number of some rays."""
    return -greatest(where(rays, -x, -inf))


def cell_along(low: float, high: float, corner: float, scale: float, cells: float) -> float:
    """Return the number of a cell, on an axis, whose list holds from `low` to `high`; -1 if there is none."""
    cell = float(int(min(max((low - corner) * scale, 0.0), cells - 1.0)))
    return cell if min((high - corner) * scale, cells) <= cell + 2.0 else -1.0


def clamp_to_unit(x: Number) -> Number:
    """Clamp a number to [0, 1]."""
    return minimum(maximum(x, 0.0), 1.0)


def smoothstep(x: Number) -> Number:
    """Hermite's cubic: from 0 at 0 to 1 at 1, with slope 0 at both ends."""
    return x * x * (3.0 - 2.0 * x)


# What a packet reads of many light sources does not fit a processor's cache. So all packets of a tile meet one part of
# them after the other, as if these were samples: each part shines so much brighter that the mean is the light of all.
TOGETHER = 128  # light sources of a part, at most
PART, FURTHER = 0, 3  # columns of the last row of `memory`: the number of the part, and how many parts there are beside


def parts_of_lights(scene: SceneArrays) -> int:
    """Return the number of parts, a power of two; one where grids list the few light sources that reach a point."""
    parts = 1
    if scene.light_grid is None or not has_rows(scene.light_grid.grids):
        while parts * TOGETHER < scene.lights.shape[0]:
            parts *= 2
    return parts


def remember_part(scene: SceneArrays, memory: Any, part: int, parts: int) -> None:
    """Keep the number of a part in `memory`, where the shading of all hits finds it."""
    memory[scene.lights.shape[0], PART] = part
    memory[scene.lights.shape[0], FURTHER] = parts - 1


def remembered_part(scene: SceneArrays, memory: Any) -> tuple[int, int, float]:
    """Return the range of the light sources of the part that shines, and how much brighter it does."""
    count = scene.lights.shape[0]
    part, parts = int(memory[count, PART]), int(memory[count, FURTHER]) + 1
    return part * count // parts, (part + 1) * count // parts, 1.0 * parts


# In scenes with a lens or with light sources that have a size, each ray of a packet has an eye and points of lights of
# its own: a row of `rays` of `minirt.kernel.frame` has eight numbers for each ray, its direction, the offset of its eye
# in the scene, and x and y of a point in the unit disc, which serves all lights. Each light turns the disc about its
# centre by an angle of its own.
#
# A light of radius r at c is the disc about c that faces the point p that it lights. Its sample is c + r o. A shape
# that lies between p and the sample, moved by -r o or less, lies between p and c: culling from c, by directions from p
# to c, holds for all samples where shapes are grown by r (see `minirt.rendering.packing.visibility`).
NUMBERS = 8  # for each ray of a packet, in a row of `rays`
EYE, DISC = 3, 6  # the first of those of the eye and of the disc
KEPT = 4  # column of the last row of `memory` from which the points in the disc are


def sampled_eye(scene: SceneArrays, rays: Any) -> Vec:
    """Return the eye of each ray of a packet: a point of the lens."""
    eye = splat(vector(scene.camera, 0), load(rays, 0))
    if has_rows(scene.lens):
        eye = eye + load_vec(rays, EYE * width(rays))
    return eye


def remember_sample(scene: SceneArrays, memory: Any, rays: Any) -> None:
    """Keep the points in the disc of a packet's rays in `memory`, where the shading of all its hits finds them."""
    if has_rows(scene.soft):
        count, row = width(rays), memory[memory.shape[0] - 1]
        save(load(rays, DISC * count), row, KEPT)
        save(load(rays, (DISC + 1) * count), row, KEPT + count)


def sampled_position(
    soft: Any, memory: Any, light: int, position: Vec, to_light: Vec, distance: Number
) -> tuple[Vec, Vec, Number]:
    """Return for each ray the position of its sample of a light source, the direction towards it, and its distance.

    Given are those of the centre, which are returned if no light source has a size. `soft` (m, 4) has for each light
    its radius; the tangent of half its angular diameter, for parallel light; and cosine and sine of the angle by which
    the light turns the disc of samples. Each ray's place on the unit disc is in `memory`, see `remember_sample`.
    """
    position = splat(position, distance)
    if has_rows(soft):
        row = memory[memory.shape[0] - 1]
        x, y = load(row, KEPT), load(row, KEPT + width(distance))
        across, down = perpendicular(to_light)
        radius, tangent, cosine, sine = soft[light, 0], soft[light, 1], soft[light, 2], soft[light, 3]
        offset = (cosine * x - sine * y) * across + (sine * x + cosine * y) * down
        towards = to_light + (radius / distance + tangent) * offset
        squared = dot(towards, towards)
        per_length = inverse_root(squared)
        position = position + radius * offset
        to_light = towards * per_length
        distance = distance * (squared * per_length)
    return position, to_light, distance


def aim(
    scene: SceneArrays, memory: Any, light: int, point: Vec, rounding: Number, owner: Number, normal: Vec, left: int
) -> tuple[ShadowRays, Number]:
    """Return the shadow rays from some points to a light source, and the strength of the light there without shadows.

    The strength is a share of the light's intensity: 1 but for spot lights and for lights that fade. The points lie on
    shapes, `owner`, whose `normal` is towards the ray that hit them, and are known up to `rounding`. Rays end a little
    before the light source, so no surface on which it lies counts. See `sampled_position` and `ShadowRays`.
    """
    position = vector(scene.lights[light], 0)
    to_centre, distance, strength = incident_light(scene.spots, light, position, point)
    to_light = to_centre
    if scene.soft is not None:
        position, to_light, distance = sampled_position(scene.soft, memory, light, position, to_centre, distance)
    distance = distance - 4.0 * (rounding + ROUNDING * unit_roundoff(distance) * max_norm(position))
    own = where(dot(normal, to_light) > 0.0, owner, -1.0)
    return ShadowRays(light, position, to_centre, point, to_light, distance, own, left), strength


def is_spread(scene: SceneArrays, light: int) -> bool:
    """Whether a light source is not a point: it is parallel light, or it has a size."""
    return is_parallel(scene, light) or (has_rows(scene.soft) and scene.soft[light, 0] > 0.0)


def perpendicular(axis: Vec) -> tuple[Vec, Vec]:
    """Return two unit vectors that are perpendicular to a unit vector and to each other (Duff et al., Building an
    orthonormal basis, revisited, 2017)."""
    sign = copysign(1.0, axis.z)
    a = -1.0 / (sign + axis.z)
    b = axis.x * axis.y * a
    across = Vec(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x)
    return across, Vec(b, sign + axis.y * axis.y * a, -axis.y)


def specular(material: Vec, normal: Vec, to_light: Vec, direction: Vec, lit: Mask) -> Number:
    """Return the share of a light source's intensity that a surface reflects as a highlight; 0 for rays not `lit`.

    `direction` is that of the viewing ray. `material` is a row of `SceneArrays.specular`: coefficient k, exponent n and
    1 for Blinn's form. Phong 1975: k (r.v)^n with the mirrored direction r of the light and the direction v of the
    viewer; Blinn 1977: k (n.h)^n with the vector h halfway between light and viewer.
    """
    phong = 2.0 * dot(normal, to_light) * dot(normal, -direction) + dot(to_light, direction)
    blinn = dot(normal, unit(to_light - direction))
    base = minimum(where(material.z > 0.5, blinn, phong), 1.0)
    shining = lit & (base > 0.0) & (material.x > 0.0)
    share = splat(0.0, base)
    if any(shining):
        share = where(shining, material.x * power(where(shining, base, 1.0), material.y), 0.0)
    return share
