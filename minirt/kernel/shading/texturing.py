"""What is painted on shapes by their coordinates u and v: checkerboards, pictures and reliefs."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.rows import mapping, read
from minirt.kernel.scene_arrays import Group
from minirt.kernel.shading.texture_lookup import height_gradient, texture_lookup
from minirt.kernel.trace import for_each_kind
from minirt.lanes import Vec, copysign, cross, dot, fabs, floor, inverse_root, splat, unit, where
from minirt.lanes.vec import Number


class SurfaceMaps(NamedTuple):
    """What is painted on n shapes, and the pictures. Each of the first four is None where no shape has such.

    The numbers of the pictures begin with 1; a shape without one has 0.
    """

    checks: Any  # (n, 4) edge of a square in u and v, or 0; and the second colour
    textures: Any  # (n,) the picture that takes the place of the colour
    bumps: Any  # (n, 2) the picture whose first channel is a height, and by how much it raises the surface
    normals: Any  # (n,) the picture of normals
    used: Any  # (n,) 0 for shapes on which nothing is painted
    texels: Any  # the pictures one after the other: rows from the top, pixels from the left, channels in [0, 1]
    pictures: Any  # (k, 4) for each picture where it begins in `texels`, its width, height and channels


Mapped = tuple[Number, Number, Vec, Vec, int]


def apply_maps(
    skins: Any, groups: tuple[Group, ...], index: int, place: Any, point: Vec, normal: Vec, colour: Vec
) -> tuple[Vec, Vec]:
    """The normal by which places of a shape are lit, and their colour; the shape is at `place`, a group and a row."""
    if skins.used[index] != 0:
        nothing = splat(0.0, point.x)
        given = place[0], place[1], point, normal
        u, v, along_u, along_v, _ = for_each_kind(mapping_of_kind, groups, (nothing, nothing, point, point, 0), given)
        colour = checkered(skins.checks, index, u, v, textured(skins.textures, skins, index, u, v, colour))
        normal = bump_mapped(skins.bumps, skins, index, u, v, along_u, along_v, normal)
        normal = normal_mapped(skins.normals, skins, index, u, v, along_u, along_v, normal)
    return normal, colour


def mapping_of_kind(group: Group, state: Mapped, given: tuple[int, int, Vec, Vec]) -> Mapped:
    """`mapping` of row i of this kind, if it is the one that is wanted; the last of the state counts the kinds."""
    u, v, along_u, along_v, number = state
    wanted, i, point, normal = given
    if number == wanted:
        u, v, to_u, to_v = mapping(read(group.rows, i), point, normal)
        along_u = Vec(splat(to_u.x, point.x), splat(to_u.y, point.x), splat(to_u.z, point.x))
        along_v = Vec(splat(to_v.x, point.x), splat(to_v.y, point.x), splat(to_v.z, point.x))
    return u, v, along_u, along_v, number + 1


def checkered(checks: Any, index: int, u: Number, v: Number, colour: Vec) -> Vec:
    """The colour, and the second one in every other square."""
    if checks is None:
        return colour
    size = checks[index, 0]
    if size == 0.0:
        return colour
    half = 0.5 * (floor(u / size) + floor(v / size))
    return where(half == floor(half), colour, Vec(checks[index, 1], checks[index, 2], checks[index, 3]))


def textured(textures: Any, skins: Any, index: int, u: Number, v: Number, colour: Vec) -> Vec:
    """The colour of the picture, where there is one."""
    if textures is None:
        return colour
    if textures[index] == 0:
        return colour
    return texture_lookup(skins.texels, skins.pictures, textures[index] - 1, u, v)


def bump_mapped(
    bumps: Any, skins: Any, index: int, u: Number, v: Number, along_u: Vec, along_v: Vec, normal: Vec
) -> Vec:
    """The normal of a surface raised by the heights of a picture (Blinn, Simulation of Wrinkled Surfaces, 1978).

    All lengths are in widths of the picture as it lies there. Of a normal that is not that of the tangents the slope
    along the surface is subtracted (Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008).
    """
    if bumps is None:
        return normal
    if bumps[index, 0] == 0.0:
        return normal
    over_u, over_v = height_gradient(skins.texels, skins.pictures, int(bumps[index, 0]) - 1, u, v)
    per_width = inverse_length(along_u)
    right, up = per_width * along_u, per_width * along_v
    area = dot(cross(right, up), normal)
    strength = bumps[index, 1] * copysign(1.0, area)
    change = strength * (over_u * cross(normal, up) - over_v * cross(normal, right))
    return unit(where(area == 0.0, normal, fabs(area) * normal + change))


def normal_mapped(
    normals: Any, skins: Any, index: int, u: Number, v: Number, along_u: Vec, along_v: Vec, normal: Vec
) -> Vec:
    """The normal that a picture has in terms of the tangents and of the plain normal: in red, green and blue what it
    has along u, v and the normal."""
    if normals is None:
        return normal
    if normals[index] == 0:
        return normal
    seen = decode_normal(texture_lookup(skins.texels, skins.pictures, normals[index] - 1, u, v))
    right, up = inverse_length(along_u) * along_u, inverse_length(along_v) * along_v
    found = seen.x * right + seen.y * up + seen.z * normal
    squared = dot(found, found)
    return unit(where(squared > 0.0, found, normal))


def decode_normal(colour: Vec) -> Vec:
    """From colours, of which 255 is 1, to numbers of which 128 is 0 and 255 is 1."""
    zero, scale = 128.0 / 255.0, 255.0 / 127.0
    return Vec((colour.x - zero) * scale, (colour.y - zero) * scale, (colour.z - zero) * scale)


def inverse_length(v: Vec) -> Number:
    """1 / |v|, but 0 where v is 0."""
    squared = dot(v, v)
    nothing = squared == 0.0
    return where(nothing, 0.0, inverse_root(where(nothing, 1.0, squared)))
