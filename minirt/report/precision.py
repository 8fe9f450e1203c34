"""Certificates of the hits in a picture, kind by kind."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.queries.rays import Hits, trace
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, Kind

Array = NDArray[np.float64]

RAYS = 20_000  # from the eye, and as many from what they hit
LIMITS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the histogram of backward errors
CLEARANCE = 2.0**-40  # by which rays start above a surface, relative to the coordinates


class KindCertificates(NamedTuple):
    """Certificates of the hits of one kind of shape; backward errors in units of 2^-53 (t + |o - c| + size)."""

    kind: Annotated[str, "shape"]
    rays: Annotated[str, "rays"]
    hits: Annotated[int, "hits", "d"]
    backward_median: Annotated[float, "backward error, median", ".2f"]
    backward_largest: Annotated[float, "largest", ".2f"]
    up_to_quarter: float  # share of the hits with a backward error up to 0.25
    up_to_half: float  # from there up to 0.5
    up_to_1: float
    up_to_2: float
    up_to_4: float
    above_4: float
    condition_median: float
    condition_99: Annotated[float, "condition, 99 %", ".2g"]  # 99 of 100 hits have no larger one
    condition_largest: Annotated[float, "largest", ".2g"]
    normal_largest: Annotated[float, "normal off by", ".1g"]  # distance from the exact unit normal


def hit_certificates(scene: Scene, width: int, height: int, seed: int) -> Iterator[KindCertificates]:
    """Certify hits of rays from the eye through random points of the picture, and of rays from there in random
    directions, as shadow rays and reflections are."""
    random = np.random.default_rng(seed)
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    x, y = random.uniform(-1, 1, (2, RAYS, 1))
    seen = trace(scene, np.tile(eye, (RAYS, 1)), forward + x * right + y * up)
    kinds = np.array([type(shape) for shape in scene.shapes], object)
    for rays, hits in (("from the eye", seen), ("from what it sees", onward(scene, seen, random))):
        for kind in ALL_KINDS:
            of_kind = np.isin(hits.owner, np.flatnonzero(kinds == kind.element))
            if of_kind.any():
                yield summarised(kind, rays, *(part[of_kind] for part in hits.certificate))


def onward(scene: Scene, seen: Hits, random: np.random.Generator) -> Hits:
    """Trace rays in random directions from points just above or below the surfaces that were hit."""
    hit = seen.owner >= 0
    points, normals = seen.point[hit], seen.normal[hit]
    directions = random.normal(size=points.shape)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)  # uniform over the sphere
    clearance = CLEARANCE * (np.abs(points).max(axis=1, initial=0.0) + seen.distance[hit])
    way = np.sign((directions * normals).sum(axis=1)) * clearance
    return trace(scene, points + way[:, None] * normals, directions)


def summarised(kind: Kind, rays: str, backward: Array, condition: Array, normal: Array) -> KindCertificates:
    """Summarise the certificates of some hits of one kind."""
    counts, _ = np.histogram(backward, (0.0, *LIMITS, np.inf))
    far = np.quantile(condition, 0.99, method="inverted_cdf")
    figures = [np.median(backward), backward.max(), *(counts / len(backward))]
    figures += [np.median(condition), far, condition.max(), normal.max()]
    return KindCertificates(kind.element.title, rays, len(backward), *map(float, figures))
