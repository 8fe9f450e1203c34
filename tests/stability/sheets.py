"""Rays that are hard for a square and a disc."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from minirt.shapes.disc import Disc
from minirt.shapes.square import Square
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
from tests.stability.common import COUNT, at
from tests.stability.places import Place, frame, line, ring, spot
from tests.stability.regime import Regime

Sheet = Square | Disc


def square(random: Random) -> Square:
    return Square(
        tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1)), random.uniform(0.5, 2), GREY
    )


def disc(random: Random) -> Disc:
    return Disc(
        tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1)), random.uniform(0.5, 2), GREY
    )


def edge(random: Random, square: Square) -> Array:
    corners, share, start = np.array(square.corners()), random.random((RAYS, 1)), random.integers(4, size=RAYS)
    around = corners[[0, 1, 3, 2]]
    return around[start] * share + around[(start + 1) % 4] * (1 - share)


def rim(random: Random, disc: Disc) -> Array:
    return np.array(disc.centre) + disc.diameter / 2 * random_perpendiculars(random, np.array(disc.normal), RAYS)


def grazing(seed: int, make: Callable[[Random], Sheet], slope: tuple[float, float]) -> Rays:
    """Rays at slopes in `slope` to the sheet, at points around its centre, from both sides."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        sheet = make(random)
        normal = np.array(sheet.normal)
        rise = log_uniform(random, *slope, RAYS, 1) * random.choice([-1.0, 1.0], (RAYS, 1))
        directions[i] = unit(random_perpendiculars(random, normal, RAYS) + rise * normal)
        spot = np.array(sheet.centre) + 0.2 * random.random((RAYS, 1)) * random_perpendiculars(random, normal, RAYS)
        origins[i] = spot - random.uniform(1, 9, (RAYS, 1)) * directions[i]
        shapes.append(sheet)
    return Rays(shapes, origins, directions)


def of(make: Callable[[Random], Sheet], border: Callable[[Random, Sheet], Array]) -> list[Regime]:
    return [
        Regime("at the edge", partial(at, 11, make, border)),
        Regime("at a slope of 1e-6 to 0.01", partial(grazing, 12, make, (1e-6, 1e-2))),
    ]


SQUARES = of(square, edge)
DISCS = of(disc, rim)


def of_square(square: Square) -> list[Place]:
    """Lines of the edges, and corners."""
    corners = np.array(square.corners())
    pairs = ((0, 1), (1, 3), (3, 2), (2, 0))
    found = [spot("corner", corner) for corner in corners]
    return found + [line("edge", square, corners[i], unit(corners[j] - corners[i])) for i, j in pairs]


def of_disc(disc: Disc) -> list[Place]:
    """The rim, and four lines that touch it."""
    u, v, normal = frame(disc.normal)
    centre, radius = np.array(disc.centre), disc.diameter / 2
    touching = [(u, v), (-u, v), (v, u), (0.6 * u + 0.8 * v, 0.8 * u - 0.6 * v)]
    return [
        ring("rim", centre, normal, radius),
        *(line("tangent", disc, centre + radius * out, along) for out, along in touching),
    ]
