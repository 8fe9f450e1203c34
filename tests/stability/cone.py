"""Rays that are hard for a cone."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.cone import Cone
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
from tests.stability.common import COUNT, along, at, axis_of, edge
from tests.stability.places import Place, fan, flat, frame, ring, spot
from tests.stability.regime import Regime, U


def make(random: Random, angle: tuple[float, float] = (20.0, 60.0)) -> Cone:
    """A cone of about size 1 with this half-angle in degrees."""
    slope = np.tan(np.radians(random.uniform(*angle)))
    height = random.uniform(0.5, 2) / max(1.0, slope)
    return Cone(
        tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1)), 2 * slope * height, height, GREY
    )


def apex(_random: Random, cone: Cone) -> Array:
    return np.tile(cone.apex, (RAYS, 1))


def rim(random: Random, cone: Cone) -> Array:
    return edge(np.array(cone.apex) + cone.height * axis_of(cone), cone, cone.diameter / 2, random)


def generator(random: Random, cone: Cone) -> Array:
    down = cone.height * axis_of(cone) + cone.diameter / 2 * random_perpendiculars(random, axis_of(cone), RAYS)
    return unit(down) * random.choice([-1.0, 1.0], (RAYS, 1))


def anywhere(random: Random, cone: Cone) -> Array:
    """Random points on the side."""
    share = random.uniform(0.05, 0.95, (RAYS, 1))
    return np.array(cone.apex) + share * (rim(random, cone) - cone.apex)


def at_the_mirror_image(seed: int) -> Rays:
    """Rays at the other nappe, and past the apex on that side."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        cone = make(random)
        target = 2 * np.array(cone.apex) - anywhere(random, cone)
        through = unit(anywhere(random, cone) - target)  # from the mirror image to the cone
        directions[i] = np.where(random.random((RAYS, 1)) < 0.5, through, random_directions(random, RAYS))
        origins[i] = target - random.uniform(0, 9, (RAYS, 1)) * directions[i]
        shapes.append(cone)
    return Rays(shapes, origins, directions)


def past_the_apex(seed: int) -> Rays:
    """Rays from beside the side, 1e-9 to 1e-2 off it, past the apex at a distance of 1e-14 to 1e-3."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        cone = make(random)
        off, beside = log_uniform(random, 1e-9, 1e-2, RAYS, 1), log_uniform(random, 1e-14, 1e-3, RAYS, 1)
        origins[i] = anywhere(random, cone) + off * random_directions(random, RAYS)
        directions[i] = unit(cone.apex + beside * random_directions(random, RAYS) - origins[i])
        shapes.append(cone)
    return Rays(shapes, origins, directions)


def down_the_axis(seed: int) -> Rays:
    """Rays exactly along the axis, up and down, from outside and inside; most cones lie along z."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        cone = make(random)
        lying = cone.replace(apex=(0, 0, cone.apex[2]), axis=(0, 0, -1))
        cone = lying if i % 4 else cone
        shapes.append(cone)
        way = np.array(cone.axis)
        origins[i] = np.array(cone.apex) + cone.height * random.uniform(-3, 4, (RAYS, 1)) * way
        directions[i] = way * random.choice([-1.0, 1.0], (RAYS, 1))
    return Rays(shapes, origins, directions)


NEEDLE, FLAT = (np.degrees(1e-4), np.degrees(1e-4)), (89.94, 89.94)

REGIMES = [
    Regime("at the apex", partial(at, 11, make, apex, (1e-14, 1e-4))),
    Regime("at the rim", partial(at, 12, make, rim)),
    Regime("along a generator", partial(along, 13, make, generator)),
    Regime("along a generator, a scene at 1e8", partial(along, 14, make, generator, None, 1e8)),
    Regime("nearly along a generator", partial(along, 15, make, generator, (1e-12, 1e-3))),
    Regime("a half-angle of 1e-4", partial(at, 16, partial(make, angle=NEEDLE), anywhere, (1e-6, 1e-5))),
    Regime("a half-angle of 89.94 degrees", partial(at, 17, partial(make, angle=FLAT), anywhere, (1e-3, 1e-1))),
    Regime("along the axis", partial(down_the_axis, 19)),
    Regime("past the apex, from beside the side", partial(past_the_apex, 20), blur=np.inf),
    Regime("at the mirror image", partial(at_the_mirror_image, 18)),
]


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


def places(cone: Cone) -> list[Place]:
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
