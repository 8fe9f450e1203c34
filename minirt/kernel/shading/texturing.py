"""Textures, checkerboards, bump maps and normal maps of surfaces, and the background with its environment map.

Textures are looked up bilinearly, with repeat addressing, one sample for each SIMD lane.
"""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays, has_rows, mapping, vector
from minirt.kernel.trace import of_shape
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    copysign,
    cross,
    dot,
    fabs,
    floor,
    gather,
    inverse_root,
    maximum,
    minimum,
    splat,
    sqrt,
    unit,
    where,
)
from minirt.lanes.mathematics import arctan2
from minirt.shapes.frames import Mapped


def texture_lookup(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> Vec:
    """Look up the colour of picture number `which` at u, v: from 0 to 1 from left to right and from bottom to top.

    `texels` holds the pixels of all pictures; `pictures` has for each its first texel, width, height and channels. The
    four pixels around a place are interpolated linearly, by its distances from their centres.
    """
    red = channel_lookup(texels, pictures, which, 0, u, v)
    green = channel_lookup(texels, pictures, which, 1, u, v)
    blue = channel_lookup(texels, pictures, which, 2, u, v)
    return Vec(red, green, blue)


def channel_lookup(texels: Any, pictures: Any, which: int, channel: int, u: Number, v: Number) -> Number:
    """Look up one channel of a picture at u, v, interpolated like `texture_lookup`."""
    layout = pictures[which]
    base, columns, rows, step = layout[0] + channel, layout[1], layout[2], layout[3]
    x = u * columns - 0.5
    y = (1.0 - v) * rows - 0.5
    left, top = floor(x), floor(y)
    across, down = minimum(x - left, 1.0), minimum(y - top, 1.0)  # no NaN, as in `wrap`
    x0, x1 = wrap(left, columns), wrap(left + 1.0, columns)
    y0, y1 = wrap(top, rows) * columns, wrap(top + 1.0, rows) * columns
    upper = lerp(gather(texels, base, step * (y0 + x0)), gather(texels, base, step * (y0 + x1)), across)
    lower = lerp(gather(texels, base, step * (y1 + x0)), gather(texels, base, step * (y1 + x1)), across)
    return lerp(upper, lower, down)


def wrap(index: Number, size: float) -> Number:
    """Wrap the index of a pixel, a whole number, to [0, size); 0 for NaN, which rays that hit nothing have."""
    return minimum(maximum(index - size * floor(index / size), 0.0), size - 1.0)


def lerp(a: Number, b: Number, share: Number) -> Number:
    """Linear interpolation from a at share 0 to b at share 1."""
    return a + share * (b - a)


def height_gradient(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> tuple[Number, Number]:
    """Gradient of a height map, a picture's first channel, along u and v: central differences over a pixel."""
    columns, rows = pictures[which, 1], pictures[which, 2]
    right = channel_lookup(texels, pictures, which, 0, u + 0.5 / columns, v)
    left = channel_lookup(texels, pictures, which, 0, u - 0.5 / columns, v)
    above = channel_lookup(texels, pictures, which, 0, u, v + 0.5 / rows)
    below = channel_lookup(texels, pictures, which, 0, u, v - 0.5 / rows)
    return (right - left) * columns, (above - below) * rows


class SurfaceMaps(NamedTuple):
    """The maps of n shapes, and the pictures that they use. A kind of map that no shape has is None or has no rows.

    Pictures are numbered from 1; a shape without the map has 0.
    """

    checks: Any  # (n, 4) checkerboard: edge of a square in u and v, or 0; and the second colour
    textures: Any  # (n,) the picture that replaces the colour
    bumps: Any  # (n, 2) the picture whose first channel is the height, and the strength of the bumps
    normals: Any  # (n,) the picture of a normal map
    used: Any  # (n,) 0 for shapes without any map
    texels: Any  # all pictures one after the other: rows from the top, pixels from the left, channels in [0, 1]
    pictures: Any  # (k, 4) for each picture its first index in `texels`, its width, height and channels
    placements: Any = None  # (n, 15) scale, shift, cosine and sine of u and v, own axes of a sphere; 0 for most shapes


def apply_maps(scene: SceneArrays, index: int, point: Vec, normal: Vec, colour: Vec) -> tuple[Vec, Vec]:
    """Apply the maps of a shape to its shading normals and colours at some points."""
    maps, slot = scene.surface_maps, scene.slots[index]
    if has_rows(maps.used) and maps.used[index] != 0:
        zero = splat(0.0, point.x)
        arguments = point, in_own_frame(maps.placements, index, normal)
        u, v, along_u, along_v = of_shape(mapping_on_lanes, scene.groups, slot, arguments, (zero, zero, point, point))
        u, v, along_u, along_v = placed(maps.placements, index, u, v, along_u, along_v)
        colour = checkered(maps.checks, index, u, v, textured(maps, index, u, v, colour))
        normal = bump_mapped(maps, index, u, v, along_u, along_v, normal)
        normal = normal_mapped(maps, index, u, v, along_u, along_v, normal)
    return normal, colour


def mapping_on_lanes(shape: Any, point: Vec, normal: Vec) -> Mapped:
    """Compute u, v and tangents of a packed shape; a tangent that is the same everywhere becomes lanes, too."""
    u, v, along_u, along_v = mapping(shape, point, normal)
    return u, v, splat(along_u, point.x), splat(along_v, point.x)


def in_own_frame(placements: Any, index: int, normal: Vec) -> Vec:
    """Return a normal in the axes of a turned shape whose `mapping` takes those of the scene for its own."""
    if not has_rows(placements) or placements[index, 0] == 0.0:
        return normal
    x, y, z = own_axes(placements, index)
    return Vec(dot(normal, x), dot(normal, y), dot(normal, z))


def own_axes(placements: Any, index: int) -> tuple[Vec, Vec, Vec]:
    """Return the own x, y and z axes of a shape; those of the scene where its `mapping` knows how it is turned."""
    return vector(placements[index], 6), vector(placements[index], 9), vector(placements[index], 12)


def placed(placements: Any, index: int, u: Number, v: Number, along_u: Vec, along_v: Vec) -> Mapped:
    """Return u and v, shifted, turned and scaled, and the tangents along the new ones, in the scene's axes."""
    if not has_rows(placements) or placements[index, 0] == 0.0:
        return u, v, along_u, along_v
    scale_u, scale_v = placements[index, 0], placements[index, 1]
    u, v = u - placements[index, 2], v - placements[index, 3]
    c, s = placements[index, 4], placements[index, 5]
    x, y, z = own_axes(placements, index)
    along_u = along_u.x * x + along_u.y * y + along_u.z * z
    along_v = along_v.x * x + along_v.y * y + along_v.z * z
    return (
        scale_u * (c * u + s * v),
        scale_v * (c * v - s * u),
        (1.0 / scale_u) * (c * along_u + s * along_v),
        (1.0 / scale_v) * (c * along_v - s * along_u),
    )


def checkered(checks: Any, index: int, u: Number, v: Number, colour: Vec) -> Vec:
    """Return the second colour of the checkerboard in every other square, and `colour` in all other squares."""
    if not has_rows(checks) or checks[index, 0] == 0.0:
        return colour
    size = checks[index, 0]
    half = 0.5 * (floor(u / size) + floor(v / size))
    return where(half == floor(half), colour, vector(checks[index], 1))


def textured(maps: Any, index: int, u: Number, v: Number, colour: Vec) -> Vec:
    """Return the colour of the shape's texture at u, v, or `colour` if it has none."""
    if not has_rows(maps.textures) or maps.textures[index] == 0:
        return colour
    return texture_lookup(maps.texels, maps.pictures, maps.textures[index] - 1, u, v)


def bump_mapped(maps: Any, index: int, u: Number, v: Number, along_u: Vec, along_v: Vec, normal: Vec) -> Vec:
    """Bump mapping: the normal of the surface raised by a height map (Blinn, Simulation of Wrinkled Surfaces, 1978).

    Lengths are in widths of the picture on the surface. The surface gradient of the height is subtracted from the
    normal, which need not be that of the tangents (Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008).
    """
    if not has_rows(maps.bumps) or maps.bumps[index, 0] == 0.0:
        return normal
    slope_u, slope_v = height_gradient(maps.texels, maps.pictures, int(maps.bumps[index, 0]) - 1, u, v)
    per_width = inverse_length(along_u)
    right, up = per_width * along_u, per_width * along_v
    area = dot(cross(right, up), normal)
    strength = maps.bumps[index, 1] * copysign(1.0, area)
    change = strength * (slope_u * cross(normal, up) - slope_v * cross(normal, right))
    return unit(where(area == 0.0, normal, fabs(area) * normal + change))


def normal_mapped(maps: Any, index: int, u: Number, v: Number, along_u: Vec, along_v: Vec, normal: Vec) -> Vec:
    """Normal mapping: the normal that a picture encodes in tangent space.

    Red, green and blue are its components along u, v and the normal before.
    """
    if not has_rows(maps.normals) or maps.normals[index] == 0:
        return normal
    decoded = decode_normal(texture_lookup(maps.texels, maps.pictures, maps.normals[index] - 1, u, v))
    right, up = inverse_length(along_u) * along_u, inverse_length(along_v) * along_v
    mapped = decoded.x * right + decoded.y * up + decoded.z * normal
    squared = dot(mapped, mapped)
    return unit(where(squared > 0.0, mapped, normal))


def decode_normal(colour: Vec) -> Vec:
    """Decode colours in [0, 1] to components of a normal: byte 128 to 0, byte 255 to 1."""
    zero, scale = 128.0 / 255.0, 255.0 / 127.0
    return Vec((colour.x - zero) * scale, (colour.y - zero) * scale, (colour.z - zero) * scale)


def inverse_length(v: Vec) -> Number:
    """Return 1 / |v|, but 0 where v is 0."""
    squared = dot(v, v)
    is_zero = squared == 0.0
    return where(is_zero, 0.0, inverse_root(where(is_zero, 1.0, squared)))


class Environment(NamedTuple):
    """An equirectangular environment map: +z is in its middle, +y along its upper edge, -x to the right of +z."""

    texels: Any  # its pixels, as in `minirt.kernel.shading.texturing.SurfaceMaps`
    pictures: Any  # (1, 4) its layout, likewise


def has_environment(scene: SceneArrays) -> bool:
    """Whether a scene has an environment map."""
    return scene.environment is not None and has_rows(scene.environment.pictures)


def background_light(scene: SceneArrays, hit: Mask, radiance: Vec, direction: Vec) -> Vec:
    """Return `radiance` for rays that hit a shape, and the background's radiance for all other rays."""
    if scene.background is not None:
        radiance = where(hit, radiance, vector(scene.background, 0))
    if scene.environment is not None and has_rows(scene.environment.pictures) and any(~hit):
        radiance = where(hit, radiance, environment_lookup(scene.environment, direction))
    return radiance


def weighted_background(scene: SceneArrays, weight: Number, direction: Vec) -> Vec:
    """Return the background's radiance times the weight of each ray; black for rays of weight 0."""
    zero = splat(0.0, weight)
    black = Vec(zero, zero, zero)
    counts = weight > 0.0
    return where(counts, weight * background_light(scene, ~counts, black, direction), black)


def environment_lookup(environment: Environment, direction: Vec) -> Vec:
    """Look up the radiance of an environment map in a direction."""
    u, v = equirectangular(direction)
    edge = 0.5 / environment.pictures[0, 2]  # no blending across the poles: nothing is above the upper row of pixels
    return texture_lookup(environment.texels, environment.pictures, 0, u, minimum(maximum(v, edge), 1.0 - edge))


def equirectangular(direction: Vec) -> tuple[Number, Number]:
    """Equirectangular projection of a direction: u from 0 at the left to 1 at the right, v from 0 below to 1 above."""
    u = 0.5 + arctan2(-direction.x, direction.z) * (0.5 / pi)
    v = 0.5 + arctan2(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)) * (1.0 / pi)
    return u, v
