"""Rays that are hard for a plane, a square, a disc and a triangle, and the special places of these."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from minirt.shapes import Disc, Plane, Shape, Square, Triangle
from tests.shapes.regimes import GREY, RAYS, Array, Random, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability.common import COUNT, at, pose_of, shots, sign
from tests.stability.places import Place, flat, frame, line, ring, special, spot
from tests.stability.regime import Regime


def plane(random: Random, offset: float = 0.0) -> Plane:
    return Plane(tuple(offset * random_directions(random)), pose_of(random)[1], GREY)


def square(random: Random) -> Square:
    return Square(*pose_of(random), random.uniform(0.5, 2), GREY)


def disc(random: Random) -> Disc:
    return Disc(*pose_of(random), random.uniform(0.5, 2), GREY)


def triangle(random: Random, height: float = 1.0) -> Triangle:
    """A triangle of about size 1, its last corner at this distance from the opposite edge."""
    a, along = random.normal(size=3), random_directions(random)
    c = a + random.uniform(0, 1) * along + height * random_perpendiculars(random, along)
    return Triangle(tuple(a), tuple(a + along), tuple(c), GREY)


def corners_in_turn(shape: Square | Triangle) -> Array:
    if isinstance(shape, Square):
        return np.array(shape.corners())[[0, 1, 3, 2]]
    return np.array([shape.a, shape.b, shape.c])


def edge(random: Random, shape: Square | Triangle) -> Array:
    corners = corners_in_turn(shape)
    share, start = random.random((RAYS, 1)), random.integers(len(corners), size=RAYS)
    return corners[start] * share + corners[(start + 1) % len(corners)] * (1 - share)


def rim(random: Random, disc: Disc) -> Array:
    return np.array(disc.centre) + disc.diameter / 2 * random_perpendiculars(random, np.array(disc.normal), RAYS)


def corner(random: Random, triangle: Triangle) -> Array:
    return corners_in_turn(triangle)[random.integers(3, size=RAYS)]


def inside(random: Random, shape: Any) -> Array:
    """Random points of a triangle, of the middle of a square or a disc, or near the point of a plane."""
    if isinstance(shape, Triangle):
        return random.dirichlet(np.ones(3), RAYS) @ corners_in_turn(shape)
    middle = shape.point if isinstance(shape, Plane) else shape.centre
    return middle + 0.2 * random.random((RAYS, 1)) * random_perpendiculars(random, np.array(shape.normal), RAYS)


def grazing(slope: tuple[float, float], random: Random, shape: Any) -> tuple[Array, Array]:
    """Rays at slopes in `slope` to a sheet, from both sides."""
    normal = np.array(shape.normal() if isinstance(shape, Triangle) else shape.normal)
    rise = log_uniform(random, *slope, RAYS, 1) * sign(random)
    directions = unit(random_perpendiculars(random, normal, RAYS) + rise * normal)
    return inside(random, shape) - random.uniform(1, 9, (RAYS, 1)) * directions, directions


def over_a_plane(slope: tuple[float, float], random: Random, shape: Plane) -> tuple[Array, Array]:
    """Rays at slopes in `slope`, from 1 to 20 above a plane; half of the rays lead away."""
    _, directions = grazing(slope, random, shape)
    return np.array(shape.point) + random.uniform(1, 20, (RAYS, 1)) * np.array(shape.normal), directions


LOW, SLIVER = (1e-6, 1e-2), partial(triangle, height=1e-6)

REGIMES: dict[type[Shape], list[Regime]] = {
    Plane: [
        Regime("at a slope of 0.01 to 1", partial(shots, 11, plane, partial(over_a_plane, (0.01, 1.0)))),
        Regime(
            "at a slope of 0.01 to 1, a scene at 1e8",
            partial(shots, 12, partial(plane, offset=1e8), partial(over_a_plane, (0.01, 1.0))),
        ),
        Regime("at a slope of 1e-6 to 0.01", partial(shots, 13, plane, partial(over_a_plane, LOW))),
        Regime("at a slope of 1e-12 to 1e-6", partial(shots, 14, plane, partial(over_a_plane, (1e-12, 1e-6)))),
    ],
    **{
        kind: [
            Regime("at the edge", partial(at, 11, make, border)),
            Regime("at a slope of 1e-6 to 0.01", partial(shots, 12, make, partial(grazing, LOW))),
        ]
        for kind, make, border in ((Square, square, edge), (Disc, disc, rim))
    },
    Triangle: [
        Regime("at an edge", partial(at, 11, triangle, edge)),
        Regime("at a corner", partial(at, 12, triangle, corner, count=3 * COUNT)),
        Regime("a sliver", partial(at, 13, SLIVER, inside)),
        Regime("a sliver next to none", partial(at, 14, partial(triangle, height=1e-12), inside)),
        Regime("at a slope of 1e-6 to 0.01", partial(shots, 15, triangle, partial(grazing, LOW))),
        Regime("a sliver at a slope of 1e-6 to 0.01", partial(shots, 16, SLIVER, partial(grazing, LOW))),
        Regime(
            "a sliver of 1e-10 at a slope of 0.001 to 0.01",
            partial(shots, 17, partial(triangle, height=1e-10), partial(grazing, (1e-3, 1e-2))),
        ),
    ],
}


@special.register
def _(_plane: Plane) -> list[Place]:
    """None besides those of its fields."""
    return []


@special.register
def _(square: Square) -> list[Place]:
    """Lines of the edges, and corners."""
    corners = corners_in_turn(square)
    ways = unit(np.roll(corners, -1, axis=0) - corners)
    return [
        *(spot("corner", corner) for corner in corners),
        *(line("edge", square, *each) for each in zip(corners, ways, strict=True)),
    ]


@special.register
def _(disc: Disc) -> list[Place]:
    """The rim, and four lines that touch it."""
    u, v, normal = frame(disc.normal)
    centre, radius = np.array(disc.centre), disc.diameter / 2
    touching = [(u, v), (-u, v), (v, u), (0.6 * u + 0.8 * v, 0.8 * u - 0.6 * v)]
    return [
        ring("rim", centre, normal, radius),
        *(line("tangent", disc, centre + radius * out, along) for out, along in touching),
    ]


@special.register
def _(triangle: Triangle) -> list[Place]:
    """Its plane, the lines of its edges, and its middle."""
    corners, edges = corners_in_turn(triangle), np.array(triangle.edges())
    found = [flat("plane", triangle, corners[0], triangle.normal()), spot("middle", corners.mean(axis=0))]
    return found + [line("edge", triangle, *each) for each in zip(corners, unit(edges), strict=True)]
