"""Direct lighting of the reference renderer: lights, shadows and highlights."""

from __future__ import annotations

from contextvars import ContextVar
from typing import NamedTuple

import numpy as np

from minirt.materials import Mirror
from minirt.scene import Lamp, Light, ParallelLight, Scene, SpotLight
from minirt.shapes import Disc, Mesh, Plane, Shape, Square, Triangle
from tests.reference.hits import SAME_SURFACE, crossings, first_in_front
from tests.reference.texturing import patterns_of
from tests.reference.uv_mapping import normals, shading, smooth_points
from tests.reference.vectors import Array, dot, length, rgb, unit

# The source of random points in lights and lenses; None for hard shadows and a pinhole.
RANDOM: ContextVar[np.random.Generator | None] = ContextVar("RANDOM", default=None)
OFF_SURFACE = 1e-10  # offset from a surface at which rays start, relative to the coordinates


def from_lamp(lamp: Lamp, points: Array) -> tuple[Array, Array, Array]:
    """Unit directions from points towards a light, its distance, and the share of its intensity that reaches there."""
    if isinstance(lamp, ParallelLight):
        towards = np.broadcast_to(-np.array(lamp.direction), points.shape)
        return towards, np.full(points.shape[:-1], np.inf), np.ones(points.shape[:-1])
    assert isinstance(lamp, Light | SpotLight)
    way = np.array(lamp.position) - points
    distance, towards = length(way), unit(way)
    share = np.ones_like(distance)
    if isinstance(lamp, SpotLight):
        half = np.radians(lamp.angle) / 2
        cosine, edge, full = -dot(towards, np.array(lamp.direction)), np.cos(half), np.cos(half * (1 - lamp.rim))
        if full > edge:
            t = np.clip((cosine - edge) / (full - edge), 0, 1)
            share = 3 * t**2 - 2 * t**3
        else:
            share = np.where(cosine > edge, 1.0, 0.0)
    if lamp.fade:
        share = share * np.maximum(0, 1 - distance / lamp.fade)
    return towards, distance, share


def to_random_point(lamp: Lamp, towards: Array, distance: Array) -> tuple[Array, Array]:
    """Unit directions from points towards random points of a light with a size, and their distances.

    These are in a disc about its centre that faces each point.
    """
    x, y = random_in_disc(len(towards))
    helper = np.where(np.abs(towards[:, :1]) < 0.6, [[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]])
    across = unit(np.cross(towards, helper))
    within = x[:, None] * across + y[:, None] * np.cross(towards, across)
    assert lamp.size
    if isinstance(lamp, ParallelLight):
        return unit(towards + np.tan(np.radians(lamp.size / 2)) * within), distance
    way = distance[:, None] * towards + lamp.size / 2 * within
    return unit(way), length(way)


def aim(lamp: Lamp, points: Array) -> tuple[Array, Array, Array]:
    """The same as `from_lamp`, towards random points of lights with a size where there is a source of them."""
    towards, distance, share = from_lamp(lamp, points)
    if lamp.size and RANDOM.get() is not None:
        towards, distance = to_random_point(lamp, towards, distance)
    return towards, distance, share


def random_in_disc(count: int) -> tuple[Array, Array]:
    """Random points in the unit disc, equally likely everywhere."""
    random = RANDOM.get()
    assert random
    radius, angle = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
    return radius * np.cos(angle), radius * np.sin(angle)


class Surface(NamedTuple):
    """n points at which rays have hit surfaces, of one shape or of several."""

    points: Array  # (n, 3)
    smooth: Array  # (n, 3) the points of the smooth surface above facets
    normal: Array  # (n, 3) towards the viewer
    base: Array  # (n, 3) by which the points are lit without bump and normal maps
    bent: Array  # (n, 3) by which they are lit
    colour: Array  # (n, 3)
    direction: Array  # (n, 3) of the rays that arrive
    far: Array  # (n,) height above the surface at which further rays start
    own: Array  # (n,) share of the diffuse light that is seen
    glow: Array  # (n,)
    specular: Array  # (n, 3) share and exponent of highlights, and 1 for Blinn's
    bumpy: Array  # (n,) whether a map or a pattern may bend the normals


def surface_of(
    shape: Shape, points: Array, normal: Array, bent: Array, colour: Array, direction: Array, far: Array, own: Array
) -> Surface:
    """The points of a shape with its material."""
    base = shading(shape, points, normal)
    base = np.where((dot(base, normal) < 0)[:, None], -base, base)
    highlight = (shape.specular.share, shape.specular.exponent, shape.specular.blinn) if shape.specular else (0, 1, 0)
    constants = shape.glow or 0.0, highlight, bool(shape.bump or shape.normal_map or patterns_of(shape))
    spread = (np.broadcast_to(each, (len(points), *np.shape(each))) for each in constants)
    smooth = smooth_points(shape, points, normal)
    return Surface(points, smooth, normal, base, bent, colour, direction, far, own, *spread)


def shaded(scene: Scene, at: Surface) -> Array:
    """Diffuse light and highlights that points of surfaces send to the viewer, and their glow, (n, 3)."""
    own, direction, bent = at.own[:, None], at.direction, at.bent
    total = at.glow[:, None] * at.colour
    if scene.ambient is not None:
        total += own * at.colour * scene.ambient.brightness * rgb(scene.ambient.colour)
    starts, raised = (each + at.far[:, None] * at.normal for each in (at.points, at.smooth))
    for lamp in scene.lights:
        towards, distance, share = aim(lamp, starts)
        cosine = dot(bent, towards)
        # A facet that faces away from the light is in its own shadow: there rays start on the smooth surface.
        beneath, way, _ = aim(lamp, raised)
        facing = dot(at.normal, towards) > 0
        origins, rays = (np.where(facing[:, None], *each) for each in ((starts, raised), (towards, beneath)))
        reach = np.where(facing, distance, way)
        lit, reached = cosine > 0, np.zeros_like(starts)
        reached[lit] = light_through(scene, origins[lit], rays[lit], reach[lit])
        share = np.where(at.bumpy, share * let_through_by_bumps(at.base, bent, towards), share)
        light = lamp.brightness * share[:, None] * reached * rgb(lamp.colour)
        total += own * cosine[:, None] * at.colour * light
        strength, exponent, blinn = at.specular.T
        half_way, mirrored = unit(towards - direction), 2 * cosine[:, None] * bent - towards
        angle = np.where(blinn == 1, dot(bent, half_way), dot(mirrored, -direction))
        total += (strength * np.maximum(0, angle) ** exponent)[:, None] * light
    return total


def let_through_by_bumps(base: Array, bent: Array, towards: Array) -> Array:
    """The share of light that bumps let through, by the tangents of the angles between base, bumps and light.

    Smith's shadowing for GGX facets: 2 / (1 + sqrt(1 + a^2 tan^2)), with a^2 an eighth of the squared tangent between
    the normals (Estevez, Lecocq and Stein 2019).
    """
    squared = np.minimum(squared_tangent(base, bent) / 8, 1)
    up = dot(base, towards) > 0
    with np.errstate(invalid="ignore"):
        return np.where(up, 2 / (1 + np.sqrt(1 + squared * squared_tangent(base, towards))), 0)


def squared_tangent(one: Array, other: Array) -> Array:
    """The squared tangent of the angle between unit vectors."""
    cosine, across = dot(one, other), np.cross(one, other)
    with np.errstate(divide="ignore"):
        return dot(across, across) / cosine**2


def mirror_and_glass(shape: Shape) -> tuple[float, float]:
    """Shares of reflected and refracted light, at most 1 together."""
    back = shape.mirror.share if isinstance(shape.mirror, Mirror) else 0.0
    through = shape.glass.share if shape.glass else 0.0
    return back / max(1.0, back + through), through / max(1.0, back + through)


def reflectance(angle: Array, before: float, behind: float) -> Array:
    """Share of unpolarised light that is reflected at an angle to the normal, between media of two indices."""
    sine = np.sin(angle) * before / behind
    with np.errstate(invalid="ignore", divide="ignore"):
        there = np.arcsin(sine)
        across = np.sin(angle - there) / np.sin(angle + there)
        along = np.tan(angle - there) / np.tan(angle + there)
    mean = (across**2 + along**2) / 2
    return np.where(sine > 1, 1.0, np.where(angle < 1e-6, ((before - behind) / (before + behind)) ** 2, mean))


def shares(shape: Shape, cosine: Array, outside: Array) -> tuple[Array, Array]:
    """Shares of reflected and refracted light of rays that arrive with a cosine, from outside or from inside."""
    back, through = mirror_and_glass(shape)
    if not shape.fresnel:
        return np.full(cosine.shape, back), np.full(cosine.shape, through)
    angle = np.arccos(np.clip(cosine, 0, 1))
    if shape.glass and through:
        n = shape.glass.ior
        part = np.where(outside, reflectance(angle, 1.0, n), reflectance(angle, n, 1.0))
        reflected = part * (back + through)
    else:
        root = min(np.sqrt(back), 1 - 1e-9)
        reflected = reflectance(angle, 1.0, (1 + root) / (1 - root))
    mixed = shape.fresnel * reflected + (1 - shape.fresnel) * back
    return mixed, (back + through - mixed if through else np.zeros_like(mixed))


def all_crossings(shape: Shape, origins: Array, directions: Array) -> Array:
    """The sorted distances at which lines cross a shape, (k, n), infinity behind the last ones."""
    assert not isinstance(shape, Mesh), "the reference renderer finds only the first crossing of a mesh"
    found = np.array(crossings(shape, origins, directions))
    return np.sort(np.where(np.isnan(found), np.inf, found), axis=0)


def is_tinted(shape: Shape) -> bool:
    """Whether a shape is tinted glass."""
    return bool(shape.tint and shape.glass and shape.glass.share)


def is_sheet(shape: Shape) -> bool:
    """Whether a shape has no inside."""
    return isinstance(shape, Square | Disc | Triangle)


def way_inside(shape: Shape, origins: Array, directions: Array, distances: Array) -> Array:
    """The length of the part of each ray, from 0 to a distance, that lies inside a shape."""
    if isinstance(shape, Plane):
        height, slope = (
            dot(origins - np.array(shape.point), np.array(shape.normal)),
            dot(directions, np.array(shape.normal)),
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            at = np.clip(np.where(slope == 0, np.inf, -height / slope), 0, distances)
        at = np.where(-height * slope > 0, at, distances)  # what is behind the line's start does not count
        with np.errstate(invalid="ignore"):
            return np.where(height < 0, at, np.where(at < distances, distances - at, 0.0))
    at = np.clip(all_crossings(shape, origins, directions), 0, distances)
    with np.errstate(invalid="ignore"):
        pairs = at[1::2] - at[0 : 2 * (len(at) // 2) : 2]
    return np.nansum(pairs, axis=0)


def left_by_media(scene: Scene, origins: Array, directions: Array, distances: Array) -> Array:
    """Shares of red, green and blue that tinted glass leaves of light along rays up to a distance, (n, 3)."""
    left = np.ones_like(directions)
    for shape in scene.shapes:
        if is_tinted(shape) and not is_sheet(shape):
            assert shape.tint
            way = way_inside(shape, origins, directions, distances)[:, None] / shape.tint.distance
            left = left * np.where(way > 0, rgb(shape.tint.colour) ** way, 1.0)
    return left


def light_through(scene: Scene, starts: Array, towards: Array, distances: Array) -> Array:
    """Shares of red, green and blue of a lamp that reach points through glass and past opaque shapes, (n, 3)."""
    limit, left = distances * (1 - SAME_SURFACE), np.arange(len(starts))
    opaque, glass = ([s for s in scene.shapes if bool(mirror_and_glass(s)[1]) == clear] for clear in (False, True))
    for shape in opaque:
        left = left[first_in_front(shape, starts[left], towards[left]) >= limit[left]]
    all_shares = np.zeros_like(starts)
    starts, towards, distances, limit = (each[left] for each in (starts, towards, distances, limit))
    share = left_by_media(scene, starts, towards, distances)
    for shape in glass:
        for at in all_crossings(shape, starts, towards):
            crossed = (at > 0) & (at < limit)
            normal = normals(shape, starts[crossed] + at[crossed, None] * towards[crossed])
            _, through = shares(shape, np.abs(dot(normal, towards[crossed])), np.ones(crossed.sum(), bool))
            share[crossed] *= through[:, None]
            if is_tinted(shape) and is_sheet(shape):
                assert shape.tint
                share[crossed] *= rgb(shape.tint.colour)
    all_shares[left] = share
    return all_shares
