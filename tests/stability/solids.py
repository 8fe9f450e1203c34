"""Rays that are hard for a sphere, an ellipsoid, a box and a torus, and the special places of these."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes import Box, Ellipsoid, Shape, Sphere, Torus
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
from tests.stability.common import COUNT, along, at, axis_of, pose_of, shots, sign
from tests.stability.places import Place, fan, flat, frame, line, ring, special, spot
from tests.stability.regime import Regime


def near_the_surface(seed: int) -> Rays:
    """Rays downwards from a billionth of the radius to a whole radius above the surface, and as far below it."""
    random = np.random.default_rng(seed)
    count = 4 * COUNT
    out = random_directions(random, count, RAYS)
    height = log_uniform(random, 1e-9, 1.0, count, RAYS, 1) * random.choice([-1.0, 1.0], (count, RAYS, 1))
    down = unit(random_perpendiculars(random, out, count, RAYS) - random.uniform(0.1, 10, (count, RAYS, 1)) * out)
    directions = np.where(height > 0, down, random_directions(random, count, RAYS))
    centre = random_directions(random)
    return Rays([Sphere(tuple(centre), 2.0, GREY)] * count, centre + (1 + height) * out, directions)


def to_the_horizon(
    above: tuple[float, float], dips: tuple[float, ...], random: Random, shape: Sphere
) -> tuple[Array, Array]:
    """Rays from above a sphere around the origin, at given fractions of the dip of its horizon."""
    up, radius = random_directions(random, RAYS), shape.diameter / 2
    height = log_uniform(random, *above, RAYS, 1)
    dip = np.sqrt(2 * height / radius) * random.choice(dips, (RAYS, 1))
    return (radius + height) * up, unit(random_perpendiculars(random, up, RAYS) - dip * up)


def planet(_random: Random) -> Sphere:
    return Sphere((0, 0, 0), 1e9, GREY)


def of_any_size(random: Random) -> Sphere:
    return Sphere(tuple(random_directions(random)), 10.0 ** random.uniform(-15, 15), GREY)


def from_the_centre(random: Random, shape: Sphere) -> tuple[Array, Array]:
    return np.tile(shape.centre, (RAYS, 1)), random_directions(random, RAYS)


def ellipsoid(random: Random, flatness: float = 1.0) -> Ellipsoid:
    """A random ellipsoid of about size 1, its own y axis scaled by `flatness`."""
    return Ellipsoid(*pose_of(random), tuple(random.uniform(0.5, 2, 3) * [1.0, flatness, 1.0]), GREY)


def semi_axes(shape: Ellipsoid) -> tuple[Array, Array]:
    """The semi-axes in ascending order, (3,), and their directions, (3, 3)."""
    lengths, directions = zip(*shape.axes(), strict=True)
    return np.array(lengths), np.array(directions)


def tips(random: Random, shape: Ellipsoid) -> Array:
    """Ends of its axes, where it is curved most and least."""
    lengths, directions = semi_axes(shape)
    chosen = random.integers(3, size=RAYS)
    return np.array(shape.centre) + sign(random) * lengths[chosen, None] * directions[chosen]


def box(random: Random) -> Box:
    """A box of about size 1."""
    return Box(*pose_of(random), tuple(random.uniform(0.5, 2, 3)), GREY)


def own_axes(shape: Box | Ellipsoid) -> Array:
    """The directions of the axes of a box or an ellipsoid, (3, 3)."""
    if isinstance(shape, Ellipsoid):
        return semi_axes(shape)[1]
    return np.array([(axis.x, axis.y, axis.z) for axis in shape.axes()])


def axes(random: Random, shape: Box | Ellipsoid) -> Array:
    """Directions of its axes, there and back."""
    return own_axes(shape)[random.integers(3, size=RAYS)] * sign(random)


def corner(random: Random, shape: Box) -> Array:
    return np.array(shape.corners())[random.integers(8, size=RAYS)]


def edge(random: Random, shape: Box) -> Array:
    corners, share, start = np.array(shape.corners()), random.random((RAYS, 1)), random.integers(8, size=RAYS)
    other = start ^ (1 << random.integers(3, size=RAYS))  # corners are in binary order of the signs of their axes
    return corners[start] * share + corners[other] * (1 - share)


def upright(random: Random) -> Box:
    return box(random).replace(centre=(0, 0, 0), axis=(0, 1, 0))


def in_a_face(random: Random, shape: Box) -> tuple[Array, Array]:
    """Rays exactly in the plane of a face of an upright box, parallel to an edge or not."""
    half = np.array(shape.sizes) / 2
    origin = half * random.uniform(-4, 4, (RAYS, 3))
    target = half * random.uniform(-1.5, 1.5, (RAYS, 3))
    along = random.random((RAYS, 3)) < 0.2  # of these coordinates nothing changes along the ray
    target = np.where(along, origin, target)
    rays, axis = np.arange(RAYS), random.integers(3, size=RAYS)
    origin[rays, axis] = target[rays, axis] = half[axis] * random.choice([-1.0, 1.0], RAYS)
    directions = target - origin
    directions[~directions.any(axis=-1)] = 1, 1, 1
    return origin, unit(directions) * np.where(directions == 0, random.choice([-1.0, 1.0]), 1.0)


def torus(random: Random, tube: float = 0.4) -> Torus:
    """A torus of about size 1 whose tube is this share of its diameter."""
    diameter = random.uniform(0.5, 2)
    return Torus(*pose_of(random), diameter, tube * diameter, GREY)


def in_the_middle(random: Random, shape: Torus) -> Array:
    """Random points of the circle in the middle of the tube."""
    return np.array(shape.centre) + shape.diameter / 2 * random_perpendiculars(random, axis_of(shape), RAYS)


def inside(random: Random, shape: Torus) -> Array:
    """Random points in the tube."""
    return in_the_middle(random, shape) + shape.tube / 2 * random.random((RAYS, 1)) * random_directions(random, RAYS)


def top(random: Random, shape: Torus) -> Array:
    """Random points of the circle along which a plane touches it."""
    return in_the_middle(random, shape) + shape.tube / 2 * axis_of(shape)


def inner(random: Random, shape: Torus) -> Array:
    """Random points of the inner equator, where it is curved like a saddle."""
    middle = np.array(shape.centre)
    return middle + (1 - shape.tube / shape.diameter) * (in_the_middle(random, shape) - middle)


def centre(_random: Random, shape: Torus) -> Array:
    return np.tile(shape.centre, (RAYS, 1))


def axis(random: Random, shape: Torus) -> Array:
    return axis_of(shape) * sign(random)


def level(random: Random, shape: Torus) -> Array:
    return random_perpendiculars(random, axis_of(shape), RAYS)


def from_inside(random: Random, shape: Torus) -> tuple[Array, Array]:
    """Rays from within the tube, in all directions."""
    return inside(random, shape), random_directions(random, RAYS)


def over_the_top(random: Random, shape: Torus) -> tuple[Array, Array]:
    """Rays in the plane that touches it, or 1e-14 to 1e-4 off: up to four hits are close together."""
    start, end = top(random, shape), top(random, shape)
    directions = unit(end - start)
    off = log_uniform(random, 1e-14, 1e-4, RAYS, 1) * random.choice([-1.0, 0.0, 1.0], (RAYS, 1)) * axis_of(shape)
    return start + off - random.uniform(0, 9, (RAYS, 1)) * directions, directions


def touching_twice(random: Random, shape: Torus) -> tuple[Array, Array]:
    """Rays through the centre, or 1e-14 to 1e-4 off, in a plane that touches it on both sides (Villarceau)."""
    out, sine = random_perpendiculars(random, axis_of(shape), RAYS), shape.tube / shape.diameter
    directions = np.sqrt(1 - sine**2) * out + sine * axis_of(shape)
    aside = log_uniform(random, 1e-14, 1e-4, RAYS, 1) * random_directions(random, RAYS)
    return np.array(shape.centre) + aside - random.uniform(0, 9, (RAYS, 1)) * directions, directions


FAR, CLOSE = partial(to_the_horizon, (1e-3, 2.0), (0.5, 0.99, 1.01, 1.1, 3.0)), (1e-6, 1e-3)

REGIMES: dict[type[Shape], list[Regime]] = {
    Sphere: [
        Regime("from 1e-9 to 1 radius off the surface", partial(near_the_surface, 14), 3e-14),
        # There the angle below the horizon is 1e-8 of a direction that is exact to 2^-53.
        Regime("to the horizon of a diameter of 1e9", partial(shots, 15, planet, FAR), 1e-8),
        Regime(
            "at the very horizon of a diameter of 1e9",
            partial(shots, 16, planet, partial(to_the_horizon, CLOSE, (0.9999, 1.0001))),
            1e-6,
        ),
        Regime("from the centre", partial(shots, 13, of_any_size, from_the_centre), 4e-16),
    ],
    # At a tip of a flat or a long one a rounding across the short axis moves the hit far along the long one.
    Ellipsoid: [
        Regime("at the ends of its axes", partial(at, 11, ellipsoid, tips)),
        Regime("along an axis", partial(along, 12, ellipsoid, axes)),
        Regime("nearly along an axis", partial(along, 13, ellipsoid, axes, (1e-14, 1e-3))),
        Regime("along an axis, a scene at 1e8", partial(along, 14, ellipsoid, axes, None, 1e8)),
        Regime("at the ends of a flat one", partial(at, 15, partial(ellipsoid, flatness=1e-6), tips)),
        Regime("at the ends of a long one", partial(at, 16, partial(ellipsoid, flatness=1e6), tips)),
    ],
    Box: [
        Regime("along an axis", partial(along, 11, box, axes)),
        Regime("nearly along an axis", partial(along, 12, box, axes, (1e-14, 1e-3))),
        Regime("along an axis, a scene at 1e8", partial(along, 13, box, axes, None, 1e8)),
        Regime("in the plane of a face", partial(shots, 16, upright, in_a_face)),
        Regime("at an edge", partial(at, 14, box, edge)),
        Regime("at a corner", partial(at, 15, box, corner)),
    ],
    # Where the tube is touched a hit is the square root of a rounding away from where the ray is nearest to it.
    Torus: [
        Regime("at the tube", partial(at, 11, torus, inside)),
        Regime("from inside", partial(shots, 12, torus, from_inside)),
        Regime("from inside a thin tube", partial(shots, 13, partial(torus, tube=1e-6), from_inside)),
        Regime("at a tube of 1e-3 of the diameter", partial(at, 14, partial(torus, tube=1e-3), inside)),
        Regime("at a tube of 1e-9 of the diameter", partial(at, 15, partial(torus, tube=1e-9), inside)),
        Regime("at the centre of one without a hole", partial(at, 16, partial(torus, tube=1.0), centre)),
        Regime("along the axis", partial(along, 17, torus, axis)),
        Regime("nearly along the axis", partial(along, 18, torus, axis, (1e-12, 1e-3))),
        Regime("across the axis", partial(along, 19, torus, level)),
        Regime("at the top", partial(at, 20, torus, top)),
        Regime("over the top", partial(shots, 21, torus, over_the_top)),
        Regime("at the inner equator", partial(at, 22, torus, inner)),
        Regime("touching it twice", partial(shots, 23, torus, touching_twice)),
    ],
}


@special.register
def _(sphere: Sphere) -> list[Place]:
    """Its poles along the axes of the scene, with the planes that touch them."""
    found = []
    for axis in np.concatenate([np.eye(3), -np.eye(3)]):
        pole = np.array(sphere.centre) + sphere.diameter / 2 * axis
        found += [spot("pole", pole), flat("tangent plane", sphere, pole, axis)]
    return found


@special.register
def _(ellipsoid: Ellipsoid) -> list[Place]:
    """The ends of its axes, with the planes that touch them."""
    found = []
    for length, axis in zip(*semi_axes(ellipsoid), strict=True):
        for side in (-1, 1):
            tip = np.array(ellipsoid.centre) + side * length * axis
            found += [spot("tip", tip), flat("tangent plane", ellipsoid, tip, axis)]
    return found


@special.register
def _(box: Box) -> list[Place]:
    """Planes of the faces, lines of the edges, and corners."""
    own, corners, centre = own_axes(box), np.array(box.corners()), np.array(box.centre)
    found = [spot("corner", point) for point in corners]
    for axis, length in zip(own, box.sizes, strict=True):
        found += [flat("face", box, centre + side * length / 2 * axis, axis) for side in (-1, 1)]
    for i, axis in enumerate(own):  # corners are in binary order of the signs of their axes
        found += [line("edge", box, corner, axis) for k, corner in enumerate(corners) if not k >> (2 - i) & 1]
    return found


@special.register
def _(torus: Torus) -> list[Place]:
    """Top and bottom with the planes that touch it there, both equators and the planes that touch the outer one, the
    circle in the middle of the tube, and the directions that touch it twice (Villarceau)."""
    u, v, axis = frame(torus.axis)
    middle, radius, tube = np.array(torus.centre), torus.diameter / 2, torus.tube / 2
    found = [ring("ring", middle, axis, radius), ring("outer equator", middle, axis, radius + tube)]
    if radius > tube:
        found += [ring("inner equator", middle, axis, radius - tube)]
        found += [fan("touching twice", torus, middle, axis, np.sqrt(radius**2 - tube**2) / tube)]
    for up in (-tube, tube):
        pole = middle + up * axis
        found += [ring("top", pole, axis, radius), flat("plane of the top", torus, pole, axis)]
    for out in (u, -v, 0.6 * u + 0.8 * v):
        found += [flat("tangent plane", torus, middle + (radius + tube) * out, out)]
        found += [flat("inner tangent plane", torus, middle + (radius - tube) * out, out)]
    return found
