"""Certificates of the hits in a picture: backward errors and condition numbers of each kind of shape."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.queries.rays import Hits, trace
from minirt.report.measurements.random_rays import Array, Random, random_directions
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, Kind

RAYS = 20_000  # from the eye, and as many from what they hit
LIMITS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the histogram of backward errors
CLEARANCE = 2.0**-40  # by which rays start above a surface, relative to the coordinates


class KindCertificates(NamedTuple):
    """Certificates of the hits of one kind of shape; backward errors in units of 2^-53 (t + |o - c| + size)."""

    kind: str
    rays: str
    hits: int
    backward_median: float
    backward_largest: float
    up_to_quarter: float  # share of the hits with a backward error up to 0.25
    up_to_half: float  # from there up to 0.5
    up_to_1: float
    up_to_2: float
    up_to_4: float
    above_4: float
    condition_median: float
    condition_99: float  # 99 of 100 hits have no larger one
    condition_largest: float
    normal_largest: float  # distance from the exact unit normal


def hit_certificates(scene: Scene, width: int, height: int, seed: int) -> Iterator[KindCertificates]:
    """Certify hits of rays from the eye through random points of the picture, and of rays from there in random
    directions, as shadow rays and reflections are."""
    random = np.random.default_rng(seed)
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    x, y = random.uniform(-1, 1, (2, RAYS, 1))
    seen = trace(scene, np.tile(eye, (RAYS, 1)), forward + x * right + y * up)
    yield from by_kind(scene, seen, "from the eye")
    yield from by_kind(scene, onward(scene, seen, random), "from what it sees")


def onward(scene: Scene, seen: Hits, random: Random) -> Hits:
    """Trace rays in random directions from points just above or below the surfaces that were hit."""
    hit = seen.owner >= 0
    points, normals = seen.point[hit], seen.normal[hit]
    directions = random_directions(random, len(points))
    clearance = CLEARANCE * (np.abs(points).max(axis=1, initial=0.0) + seen.distance[hit])
    way = np.sign((directions * normals).sum(axis=1)) * clearance
    return trace(scene, points + way[:, None] * normals, directions)


def by_kind(scene: Scene, hits: Hits, rays: str) -> Iterator[KindCertificates]:
    """Summarise the certificates of the hits of each kind of shape."""
    kinds = np.array([type(shape) for shape in scene.shapes], object)
    for kind in ALL_KINDS:
        of_kind = np.isin(hits.owner, np.flatnonzero(kinds == kind.element))
        if of_kind.any():
            yield summarised(kind, rays, *(part[of_kind] for part in hits.certificate))


def summarised(kind: Kind, rays: str, backward: Array, condition: Array, normal: Array) -> KindCertificates:
    """Summarise the certificates of some hits of one kind."""
    counts, _ = np.histogram(backward, (0.0, *LIMITS, np.inf))
    quarter, half, one, two, four, more = (counts / len(backward)).tolist()
    return KindCertificates(
        kind.element.title,
        rays,
        len(backward),
        float(np.median(backward)),
        float(backward.max()),
        quarter,
        half,
        one,
        two,
        four,
        more,
        float(np.median(condition)),
        float(np.quantile(condition, 0.99, method="inverted_cdf")),
        float(condition.max()),
        float(normal.max()),
    )
