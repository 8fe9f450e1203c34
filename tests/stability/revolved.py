"""Rays that are hard for a cylinder, a cone, a paraboloid and a hyperboloid, and the special places of these."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from minirt.shapes import Cone, Cylinder, Hyperboloid, Paraboloid, Shape
from tests.shapes.examples import place
from tests.shapes.regimes import (
    GREY,
    RAYS,
    Array,
    Random,
    Rays,
    log_uniform,
    random_directions,
    random_perpendiculars,
    unit,
)
from tests.stability.common import COUNT, along, at, axis_of, edge, pose_of, shots, sign
from tests.stability.places import Place, fan, flat, frame, line, ring, special, spot
from tests.stability.regime import Regime, U


def axis(_random: Random, shape: Any) -> Array:
    return np.tile(shape.axis, (RAYS, 1))


def up_or_down(random: Random, shape: Any) -> Array:
    return axis_of(shape) * sign(random)


def rim(random: Random, shape: Any) -> Array:
    """Random points of the upper rim, or of the only one."""
    up = shape.height / 2 if isinstance(shape, Cylinder | Hyperboloid) else shape.height
    return edge(tip(random, shape)[0] + up * axis_of(shape), shape, shape.diameter / 2, random)


def tip(_random: Random, shape: Any) -> Array:
    """The point that the shape is given by: the apex of a cone, the vertex of a paraboloid."""
    point = next(getattr(shape, name) for name in ("centre", "apex", "vertex") if hasattr(shape, name))
    return np.tile(point, (RAYS, 1))


def cylinder(random: Random, height: float | None = None) -> Cylinder:
    """A cylinder of about size 1."""
    point, way = pose_of(random)
    return Cylinder(point, way, random.uniform(0.5, 2), height or random.uniform(0.5, 3), GREY)


def inside_tube(random: Random, shape: Cylinder) -> tuple[Array, Array]:
    """Rays from the middle of a very long cylinder, 1e-8 to 1e-2 radians off its axis."""
    way = axis_of(shape)
    start = 0.4 * shape.diameter * random.uniform(-1, 1, (RAYS, 1)) * random_perpendiculars(random, way, RAYS)
    off = log_uniform(random, 1e-8, 1e-2, RAYS, 1) * random_perpendiculars(random, way, RAYS)
    return np.array(shape.centre) + start, unit(way + off)


def from_the_wall(random: Random, shape: Cylinder) -> tuple[Array, Array]:
    """Rays across a long cylinder from just inside its side: the closest approach to the centre is 1e-13 to 1e-6 off
    it."""
    way, radius = axis_of(shape), shape.diameter / 2
    out = random_perpendiculars(random, way, RAYS)
    tilt = random.uniform(0.3, 1.2, (RAYS, 1))
    directions = unit(np.sin(tilt) * way - np.cos(tilt) * out)
    near = radius * (1 - log_uniform(random, 1e-13, 1e-6, RAYS, 1))
    wall = np.array(shape.centre) + near * (out + np.cos(tilt) / np.sin(tilt) * way)
    return wall + random.uniform(0.01, 0.1, (RAYS, 1)) * directions, directions


def short_axis(seed: int) -> Rays:
    """Rays at cylinders whose axis is written 6e-8 too short, as one with seven digits is."""
    rays = at(seed, cylinder, lambda random, shape: place(shape) + random.uniform(-0.6, 0.6, (RAYS, 3)))
    shortened = [shape.replace(axis=tuple((1 - 6e-8) * x for x in shape.axis)) for shape in rays.shapes]
    return rays._replace(shapes=shortened)


def cone(random: Random, angle: tuple[float, float] = (20.0, 60.0)) -> Cone:
    """A cone of about size 1 with this half-angle in degrees."""
    slope = np.tan(np.radians(random.uniform(*angle)))
    height = random.uniform(0.5, 2) / max(1.0, slope)
    return Cone(*pose_of(random), 2 * slope * height, height, GREY)


def generator(random: Random, shape: Cone) -> Array:
    down = shape.height * axis_of(shape) + shape.diameter / 2 * random_perpendiculars(random, axis_of(shape), RAYS)
    return unit(down) * sign(random)


def anywhere(random: Random, shape: Cone) -> Array:
    """Random points on the side."""
    share = random.uniform(0.05, 0.95, (RAYS, 1))
    return np.array(shape.apex) + share * (rim(random, shape) - shape.apex)


def at_the_mirror_image(random: Random, shape: Cone) -> tuple[Array, Array]:
    """Rays at the other nappe, and past the apex on that side."""
    target = 2 * np.array(shape.apex) - anywhere(random, shape)
    through = unit(anywhere(random, shape) - target)  # from the mirror image to the cone
    directions = np.where(random.random((RAYS, 1)) < 0.5, through, random_directions(random, RAYS))
    return target - random.uniform(0, 9, (RAYS, 1)) * directions, directions


def past_the_apex(random: Random, shape: Cone) -> tuple[Array, Array]:
    """Rays from beside the side, 1e-9 to 1e-2 off it, past the apex at a distance of 1e-14 to 1e-3."""
    off, beside = log_uniform(random, 1e-9, 1e-2, RAYS, 1), log_uniform(random, 1e-14, 1e-3, RAYS, 1)
    origins = anywhere(random, shape) + off * random_directions(random, RAYS)
    return origins, unit(shape.apex + beside * random_directions(random, RAYS) - origins)


def lying(random: Random) -> Cone:
    """A cone that mostly lies along z."""
    shape = cone(random)
    return shape.replace(apex=(0, 0, shape.apex[2]), axis=(0, 0, -1)) if random.random() < 0.75 else shape


def down_the_axis(random: Random, shape: Cone) -> tuple[Array, Array]:
    """Rays exactly along the axis, up and down, from outside and inside."""
    way = axis_of(shape)
    return np.array(shape.apex) + shape.height * random.uniform(-3, 4, (RAYS, 1)) * way, way * sign(random)


def paraboloid(random: Random, height: float = 1.0) -> Paraboloid:
    """A paraboloid of about size 1, its height multiplied by a factor."""
    return Paraboloid(*pose_of(random), random.uniform(0.5, 2), height * random.uniform(0.5, 2), GREY)


def hyperboloid(random: Random, waist: float = 0.5) -> Hyperboloid:
    """A hyperboloid of about size 1 whose waist is this share of its diameter."""
    diameter = random.uniform(0.5, 2)
    return Hyperboloid(*pose_of(random), waist * diameter, diameter, random.uniform(0.5, 2), GREY)


def slope_of(shape: Hyperboloid) -> float:
    """Slope of the asymptotic cone: radius by height."""
    return float(np.sqrt(shape.diameter**2 - shape.waist**2)) / shape.height


def waist_of(random: Random, shape: Hyperboloid) -> Array:
    return edge(np.array(shape.centre), shape, shape.waist / 2, random)


def asymptote(random: Random, shape: Hyperboloid) -> Array:
    way = axis_of(shape)
    return unit(way + slope_of(shape) * random_perpendiculars(random, way, RAYS)) * sign(random)


def beside_rulings(off: tuple[float, float], random: Random, shape: Hyperboloid) -> tuple[Array, Array]:
    """Rays along the rulings, the straight lines in the surface, at a distance in `off` beside them."""
    directions = asymptote(random, shape)
    aside = unit(np.cross(directions, axis_of(shape)))  # such a line leaves the waist at a right angle to its way out
    apart = shape.waist / 2 + log_uniform(random, *off, RAYS, 1) * sign(random)
    return np.array(shape.centre) + apart * aside - 5 * directions, directions


NEEDLE, FLAT = (np.degrees(1e-4), np.degrees(1e-4)), (89.94, 89.94)
SLIM = partial(hyperboloid, waist=1e-6)

REGIMES: dict[type[Shape], list[Regime]] = {
    Cylinder: [
        Regime("exactly along the axis", partial(along, 11, cylinder, axis)),
        Regime("exactly along the axis, a scene at 1e8", partial(along, 12, cylinder, axis, None, 1e8)),
        Regime("nearly along the axis", partial(along, 13, cylinder, axis, (1e-12, 1e-3))),
        Regime("nearly along the axis, a scene at 1e8", partial(along, 14, cylinder, axis, (1e-12, 1e-3), 1e8)),
        Regime("at the rim", partial(at, 15, cylinder, rim, count=2 * COUNT)),
        # 1e-8 off the axis, an axis that is exact to 2^-53 leaves 1e-8 of the angle, and so of t.
        Regime("inside a tube of height 1e9", partial(shots, 17, partial(cylinder, height=1e9), inside_tube), 3e-8),
        Regime("across a tube from its wall", partial(shots, 18, partial(cylinder, height=100.0), from_the_wall)),
        Regime("an axis off unit length by 6e-8", partial(short_axis, 21)),
    ],
    Cone: [
        Regime("at the apex", partial(at, 11, cone, tip, (1e-14, 1e-4))),
        Regime("at the rim", partial(at, 12, cone, rim)),
        Regime("along a generator", partial(along, 13, cone, generator)),
        Regime("along a generator, a scene at 1e8", partial(along, 14, cone, generator, None, 1e8)),
        Regime("nearly along a generator", partial(along, 15, cone, generator, (1e-12, 1e-3))),
        Regime("a half-angle of 1e-4", partial(at, 16, partial(cone, angle=NEEDLE), anywhere, (1e-6, 1e-5))),
        Regime("a half-angle of 89.94 degrees", partial(at, 17, partial(cone, angle=FLAT), anywhere, (1e-3, 1e-1))),
        Regime("along the axis", partial(shots, 19, lying, down_the_axis)),
        Regime("past the apex, from beside the side", partial(shots, 20, cone, past_the_apex)),
        Regime("at the mirror image", partial(shots, 18, cone, at_the_mirror_image)),
    ],
    Paraboloid: [
        Regime("along the axis", partial(along, 11, paraboloid, up_or_down)),
        Regime("along the axis, a scene at 1e8", partial(along, 12, paraboloid, up_or_down, None, 1e8)),
        Regime("nearly along the axis", partial(along, 13, paraboloid, up_or_down, (1e-12, 1e-3))),
        Regime("at the rim", partial(at, 14, paraboloid, rim)),
        Regime("at the vertex", partial(at, 15, paraboloid, tip)),
        Regime("a height of 1e-6", partial(at, 16, partial(paraboloid, height=1e-6), rim, (1e-3, 0.3))),
        Regime("a height of 1e6", partial(at, 17, partial(paraboloid, height=1e6), tip)),
    ],
    Hyperboloid: [
        Regime("along an asymptote", partial(along, 11, hyperboloid, asymptote)),
        Regime("along an asymptote, a scene at 1e8", partial(along, 12, hyperboloid, asymptote, None, 1e8)),
        Regime("nearly along an asymptote", partial(along, 13, hyperboloid, asymptote, (1e-12, 1e-3))),
        Regime("along a ruling", partial(shots, 14, hyperboloid, partial(beside_rulings, (1e-3, 1e-1)))),
        Regime("closely along a ruling", partial(shots, 15, hyperboloid, partial(beside_rulings, (1e-14, 1e-6)))),
        Regime("at the rim", partial(at, 16, hyperboloid, rim)),
        Regime("at the waist", partial(at, 17, hyperboloid, waist_of)),
        Regime("a waist of 1e-6 of the diameter", partial(at, 18, SLIM, waist_of, (1e-3, 1e-1))),
        Regime("closely at a waist of 1e-6 of that", partial(at, 20, SLIM, waist_of, (1e-9, 1e-6))),
        Regime("a waist as wide as the ends", partial(at, 19, partial(hyperboloid, waist=1.0), waist_of, (1e-3, 0.1))),
    ],
}


@special.register
def _(cylinder: Cylinder) -> list[Place]:
    """Planes of the caps, rims, generators and the planes that touch the side."""
    u, v, axis = frame(cylinder.axis)
    centre, radius = np.array(cylinder.centre), cylinder.diameter / 2
    found = []
    for end in (-cylinder.height / 2, cylinder.height / 2):
        cap = centre + end * axis
        found += [flat("cap plane", cylinder, cap, axis), ring("rim", cap, axis, radius)]
    for out in (u, -v, 0.6 * u + 0.8 * v):
        on = centre + radius * out
        found += [line("generator", cylinder, on, axis), flat("tangent plane", cylinder, on, out)]
    return found


def blunt(cone: Cone) -> Place:
    """The neighbourhood of the apex, up to 2^18 roundings away; the directions lead to the apex or along generators."""
    apex = np.array(cone.apex)
    largest = max(float(np.abs(apex).max()), cone.diameter + cone.height)

    def on(random: Random, n: int) -> Array:
        return apex + largest * U * 2.0 ** random.uniform(-2, 18, (n, 1)) * random_directions(random, n)

    def ways(random: Random, at: Array) -> Array:
        along = lines.ways(random, at)
        there = np.where(random.random((len(at), 1)) < 0.5, apex - at, along)
        return np.where(there.any(axis=-1, keepdims=True), there, along)

    lines = fan("generators", cone, apex, cone.axis, cone.diameter / 2 / cone.height)
    return Place("beside the apex", on, ways)


@special.register
def _(cone: Cone) -> list[Place]:
    """Plane of the base, rim, neighbourhood of the apex, and generators with those of the mirror image."""
    _, _, axis = frame(cone.axis)
    base = np.array(cone.apex) + cone.height * axis
    return [
        flat("base plane", cone, base, axis),
        spot("centre of the base", base),
        ring("rim", base, axis, cone.diameter / 2),
        blunt(cone),
        fan("generators", cone, cone.apex, axis, cone.diameter / 2 / cone.height),
    ]


@special.register
def _(paraboloid: Paraboloid) -> list[Place]:
    """Plane of the cap, rim, focus, and the circle around it at which the side is at 45 degrees."""
    _, _, axis = frame(paraboloid.axis)
    vertex, radius = np.array(paraboloid.vertex), paraboloid.diameter / 2
    cap, focal = vertex + paraboloid.height * axis, radius * (radius / paraboloid.height) / 4
    return [
        flat("cap plane", paraboloid, cap, axis),
        spot("centre of the cap", cap),
        ring("rim", cap, axis, radius),
        spot("focus", vertex + focal * axis),
        ring("circle around the focus", vertex + focal * axis, axis, 2 * focal),
    ]


@special.register
def _(hyperboloid: Hyperboloid) -> list[Place]:
    """Planes of the caps, rims, waist and the planes that touch it, asymptotes and rulings."""
    u, v, axis = frame(hyperboloid.axis)
    centre, steep = np.array(hyperboloid.centre), slope_of(hyperboloid)
    found = [ring("waist", centre, axis, hyperboloid.waist / 2), fan("asymptotes", hyperboloid, centre, axis, steep)]
    for end in (-hyperboloid.height / 2, hyperboloid.height / 2):
        cap = centre + end * axis
        found += [flat("cap plane", hyperboloid, cap, axis), ring("rim", cap, axis, hyperboloid.diameter / 2)]
    for out, aside in ((u, v), (-v, u), (0.6 * u + 0.8 * v, 0.8 * u - 0.6 * v)):
        on = centre + hyperboloid.waist / 2 * out
        found += [flat("tangent plane", hyperboloid, on, out)]
        found += [line("ruling", hyperboloid, on, axis + sign * steep * aside) for sign in (-1, 1)]
    return found
