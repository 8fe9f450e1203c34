"""Surface at each hit: point, normals, material with maps applied, Fresnel's equations and media.

`SceneArrays.media` (n, 6) has for each shape the absorption of red, green and blue inside it (Beer-Lambert law), in
halvings of the light for each scene unit, and the shares of red, green and blue that its surface lets through: less
than 1 for sheets, which have no inside. The absorption where shapes overlap is the sum of theirs.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays, has_rows, shading, surface, vector
from minirt.kernel.shading.patterns import SPACING, apply_patterns, pixel_footprint
from minirt.kernel.shading.texturing import apply_maps
from minirt.kernel.trace import ClosestHit, of_shape
from minirt.lanes import Mask, Number, Vec, any, dot, first, lane, maximum, rarely, splat, sqrt, where
from minirt.lanes.mathematics import LOWEST, exp2

MIN_WEIGHT = 2.0**-10  # rays that would add less than this share of their light to a pixel are not traced
VANISHING = 2.0**-40  # what is left of an absorption after a subtraction, relative to it, that rounding may have left
FILTER = 3  # column of `SceneArrays.media` from which the shares are that a surface lets through
TINY = 2.0**-500  # keeps the quotients finite where a ray grazes a surface between two equal indices


def reflectance(cosine: Number, ratio: Number) -> Number:
    """Return the share of the light that is reflected, the mean over both polarisations (Fresnel 1823).

    `cosine` >= 0 is that of the angle between the ray and the normal. `ratio` is the index of refraction before the
    surface by that behind it. The rest of the light is refracted; it is none beyond the angle of total reflection.
    """
    squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine)
    behind = sqrt(maximum(squared, 0.0))  # cosine of the angle between the refracted ray and the normal
    across = (ratio * cosine - behind) / maximum(ratio * cosine + behind, TINY)
    along = (cosine - ratio * behind) / maximum(cosine + ratio * behind, TINY)
    return where(squared < 0.0, 1.0, 0.5 * (across * across + along * along))


def shares_at_angle(reflective: Vec, fresnel: Number, cosine: Number, leaves: Mask) -> Vec:
    """Return a row of `SceneArrays.reflective` with the shares of reflection and refraction for the angle of a ray.

    Glass divides both shares together by Fresnel's equations; the share of a mirror that is no glass grows as that of a
    varnish. `fresnel`, from 0 to 1, mixes these shares with the constant ones. Whether a ray `leaves` a shape matters
    for glass; a mirror is alike on both sides.
    """
    constant, refracted, ior = reflective.x, reflective.y, reflective.z
    is_glass = refracted > 0.0
    share = reflectance(cosine, where(is_glass & leaves, ior, 1.0 / ior))
    reflected = constant + fresnel * (share * where(is_glass, constant + refracted, 1.0) - constant)
    return Vec(reflected, where(is_glass, constant + refracted - reflected, 0.0), where(is_glass, ior, 1.0))


def absorbed(light: Vec, medium: Vec, distance: Number) -> Vec:
    """Return what is left of light after a distance, which may be infinite, in a medium."""
    if any(brightest(medium) > 0.0):
        red, green = transmittance(medium.x, distance), transmittance(medium.y, distance)
        light = tint(light, Vec(red, green, transmittance(medium.z, distance)))
    return light


def transmittance(absorption: Number, distance: Number) -> Number:
    """Return the share of light that is left: 2^-(absorption * distance)."""
    halvings = where(absorption > 0.0, absorption * distance, 0.0)
    return exp2(maximum(-halvings, LOWEST))


def medium_behind(medium: Vec, rates: Vec, leaves: Mask) -> Vec:
    """Return the medium behind the surface of a shape with the absorption `rates`, which a ray enters or leaves."""
    red, green = rate_behind(medium.x, rates.x, leaves), rate_behind(medium.y, rates.y, leaves)
    return Vec(red, green, rate_behind(medium.z, rates.z, leaves))


def rate_behind(rate: Number, change: Number, leaves: Mask) -> Number:
    """Return the absorption of one colour behind a surface, without what rounding leaves."""
    rest = rate - change
    return where(leaves, where(rest > VANISHING * change, rest, 0.0), rate + change)


def brightest(light: Vec) -> Number:
    """Return the largest channel."""
    return maximum(maximum(light.x, light.y), light.z)


class Ray(NamedTuple):
    """A packet of rays."""

    origin: Vec
    direction: Vec
    weight: Number  # of its light in the pixel
    fade: Number  # one over the distance at which the light is gone, or 0
    colour: Vec  # shares of red, green and blue that tinted glass has left, in scenes that have any
    medium: Vec  # absorption of red, green and blue along the ray, likewise


class Surface(NamedTuple):
    """The surface that each ray hits."""

    point: Vec  # the hit, put onto the surface
    side: Number  # 1 where the ray comes from outside, -1 where it leaves the shape
    normal: Vec  # geometric normal, on the side from which the ray comes
    shading_normal: Vec  # the normal for lighting: smooth, bump mapped or normal mapped
    base_normal: Vec  # the same without bump map and normal map
    colour: Vec  # red, green, blue in [0, 1]
    specular: Vec  # the shape's row of `SceneArrays.specular`
    reflective: Vec  # shares of reflection and refraction of the ray, and the index of refraction
    glow: Number  # the shape's row of `SceneArrays.glow`
    fades: Vec  # the shape's row of `SceneArrays.fades`, and 0
    absorption: Vec  # inside the shape, see `minirt.kernel.shading.surfaces`
    filter: Vec  # shares of the light that the surface lets through, likewise


def surfaces(scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit, hit: Mask) -> Surface:
    """Compute the surfaces that rays hit, from the shapes that own the hits and from the points within rounding.

    The rays of a packet hit few different shapes, mostly one: a shape that some ray hits is evaluated for all rays, and
    further shapes only correct their own rays.
    """
    t, owner, _, index = found
    point = ray.origin + t * ray.direction
    if rarely(index < 0):
        index = int(lane(owner, first(hit)))
    result = surface_at(scene, memory, index, point, t, ray.direction)
    remaining = hit & (owner != index)
    while rarely(remaining):
        index = int(lane(owner, first(remaining)))
        owned = remaining & (owner == index)
        result = where(owned, surface_at(scene, memory, index, point, t, ray.direction), result)
        remaining = remaining & ~owned
    return result


def surface_at(scene: SceneArrays, memory: Any, index: int, point: Vec, t: Number, direction: Vec) -> Surface:
    """Compute the surface of shape `index` for all rays of the packet, which come in a `direction` from a distance t.

    `point` is where they meet it, within rounding; `memory` has the spacing of samples, see `remember_spacing`.
    """
    on, normal, base_normal = surface_of(scene, index, point)
    colour = row_of(scene.colours_and_extents, index, point.x)
    shading_normal = base_normal
    if scene.surface_maps is not None:
        shading_normal, colour = apply_maps(scene, index, on, base_normal, colour)
    if scene.patterns is not None:
        spacing = memory[scene.lights.shape[0], SPACING]
        footprint = spacing * pixel_footprint(scene.camera, on, t, direction, normal)
        shading_normal, colour = apply_patterns(scene.patterns, index, on, footprint, shading_normal, colour)
    side = where(dot(normal, direction) > 0.0, splat(-1.0, point.x), 1.0)
    behind = side < 0.0
    if rarely(behind):  # both sides of a surface are shaded alike
        normal = where(behind, -normal, normal)
        shading_normal = where(behind, -shading_normal, shading_normal)
        base_normal = where(behind, -base_normal, base_normal)
    reflective = row_of(scene.reflective, index, point.x)
    if has_rows(scene.fresnel):
        cosine = -dot(reflecting_normal(shading_normal, normal, direction), direction)
        fresnel = splat(scene.fresnel[index], point.x)
        reflective = shares_at_angle(reflective, fresnel, maximum(cosine, 0.0), behind)
    fades = splat(Vec(0.0, 0.0, 0.0), point.x)
    if has_rows(scene.fades):
        fades = splat(Vec(scene.fades[index, 0], scene.fades[index, 1], 0.0), point.x)
    glow = splat(scene.glow[index], point.x) if has_rows(scene.glow) else splat(0.0, point.x)
    specular, media = row_of(scene.specular, index, point.x), row_of(scene.media, index, point.x)
    passing = row_of(scene.media, index, point.x, FILTER)
    return Surface(
        on, side, normal, shading_normal, base_normal, colour, specular, reflective, glow, fades, media, passing
    )


def surface_of(scene: SceneArrays, index: int, point: Vec) -> tuple[Vec, Vec, Vec]:
    """Compute points on the surface of a shape, near some points, its normals and its shading normals there."""
    return of_shape(surface_and_shading, scene.groups, scene.slots[index], (point,), (point, point, point))


def surface_and_shading(shape: Any, point: Vec) -> tuple[Vec, Vec, Vec]:
    """Compute the points on the surface of a packed shape, its normals and its shading normals."""
    on, out = surface(shape, point)
    normal = splat(out, point.x)
    return on, normal, shading(shape, on, normal)


def row_of(table: Any, index: int, like: Number, at: int = 0) -> Vec:
    """Return three numbers of a row of a table, from column `at` on, the same for all rays; zeros without the table."""
    return splat(vector(table[index], at), like) if has_rows(table) else splat(Vec(0.0, 0.0, 0.0), like)


def reflecting_normal(shading_normal: Vec, facing: Vec, direction: Vec) -> Vec:
    """Return the normal for reflection and refraction: the shading normal, if that reflects the ray off the surface.

    Otherwise it is the geometric normal on the ray's side, `facing`.
    """
    cosine = -dot(shading_normal, direction)
    height = dot(direction, facing) + 2.0 * cosine * dot(shading_normal, facing)
    return where((cosine > 0.0) & (height > 0.0), shading_normal, facing)


def tint(light: Vec, colour: Vec) -> Vec:
    """Multiply light by the colour of a surface, channel by channel."""
    return Vec(light.x * colour.x, light.y * colour.y, light.z * colour.z)
