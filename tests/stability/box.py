"""Rays that are hard for a box."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.box import Box
from tests.shapes.regimes import GREY, RAYS, Array, Random, Rays, random_directions, unit
from tests.stability.common import COUNT, along, at
from tests.stability.places import Place, flat, line, spot
from tests.stability.regime import Regime


def make(random: Random) -> Box:
    """A box of about size 1."""
    point, axis = tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1))
    return Box(point, axis, tuple(random.uniform(0.5, 2, 3)), GREY)


def corner(random: Random, box: Box) -> Array:
    return np.array(box.corners())[random.integers(8, size=RAYS)]


def edge(random: Random, box: Box) -> Array:
    corners, share, start = np.array(box.corners()), random.random((RAYS, 1)), random.integers(8, size=RAYS)
    other = start ^ (1 << random.integers(3, size=RAYS))  # corners are in binary order of the signs of their axes
    return corners[start] * share + corners[other] * (1 - share)


def axes(random: Random, box: Box) -> Array:
    own = np.array([(axis.x, axis.y, axis.z) for axis in box.axes()])
    return own[random.integers(3, size=RAYS)] * random.choice([-1.0, 1.0], (RAYS, 1))


def in_a_face(seed: int) -> Rays:
    """Rays exactly in the plane of a face of upright boxes, parallel to an edge or not."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        box = make(random).replace(centre=(0, 0, 0), axis=(0, 1, 0))
        half = np.array(box.sizes) / 2
        origin = half * random.uniform(-4, 4, (RAYS, 3))
        target = half * random.uniform(-1.5, 1.5, (RAYS, 3))
        along = random.random((RAYS, 3)) < 0.2  # of these coordinates nothing changes along the ray
        target = np.where(along, origin, target)
        rays, axis = np.arange(RAYS), random.integers(3, size=RAYS)
        in_plane = half[axis] * random.choice([-1.0, 1.0], RAYS)
        origin[rays, axis] = target[rays, axis] = in_plane
        origins[i], directions[i] = origin, target - origin
        shapes.append(box)
    directions[~directions.any(axis=-1)] = 1, 1, 1
    return Rays(shapes, origins, unit(directions) * np.where(directions == 0, random.choice([-1.0, 1.0]), 1.0))


REGIMES = [
    Regime("along an axis", partial(along, 11, make, axes)),
    Regime("nearly along an axis", partial(along, 12, make, axes, (1e-14, 1e-3))),
    Regime("along an axis, a scene at 1e8", partial(along, 13, make, axes, None, 1e8)),
    Regime("in the plane of a face", partial(in_a_face, 16)),
    Regime("at an edge", partial(at, 14, make, edge)),
    Regime("at a corner", partial(at, 15, make, corner)),
]


def places(box: Box) -> list[Place]:
    """Planes of the faces, lines of the edges, and corners."""
    own = np.array([(axis.x, axis.y, axis.z) for axis in box.axes()])
    corners, centre = np.array(box.corners()), np.array(box.centre)
    found = [spot("corner", point) for point in corners]
    for axis, length in zip(own, box.sizes, strict=True):
        found += [flat("face", box, centre + sign * length / 2 * axis, axis) for sign in (-1, 1)]
    for i, axis in enumerate(own):  # corners are in binary order of the signs of their axes
        found += [line("edge", box, corner, axis) for k, corner in enumerate(corners) if not k >> (2 - i) & 1]
    return found
