"""Where `minirt.trace` says that rays hit, and how the surface lies there."""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.element import fields_of
from minirt.fields import Length
from minirt.kernel.trace import ROUNDING
from minirt.rendering.tables import extent
from minirt.scene import Camera, Scene
from minirt.shapes import KINDS, Kind, Shape
from tests.oracle.body import body, normals
from tests.stability.common import common
from tests.stability.regime import Array, U, posed, size

EYE = Camera((0, 0, 0), (0, 0, 1), 60)
REGIMES = [(kind, regime) for kind in KINDS for regime in common(kind)]


def least(shape: Shape) -> float:
    """The least length of a shape, to which a normal's turn over its surface is in proportion."""
    return min((getattr(shape, e.name) for e in fields_of(type(shape)) if isinstance(e, Length)), default=np.inf)


def off(shape: Shape, point: Array, normal: Array) -> tuple[float, float]:
    """How far a hit is from the wall that its normal fits best, and the error of the normal."""
    found = normals(body(shape), list(point))
    errors = [float(np.linalg.norm(np.array(out, float) - normal)) for _, out in found]
    best = int(np.argmin(errors))
    return float(found[best][0]), errors[best]


@pytest.mark.parametrize(
    ("kind", "regime"), REGIMES, ids=lambda each: each.element.title if isinstance(each, Kind) else each.name
)
def test_hits_are_on_the_surface_and_normals_point_outwards(kind: Kind, regime: object) -> None:
    rays = posed(regime).rays
    for shape, origins, directions in zip(rays.shapes, rays.origins, rays.directions, strict=True):
        hits = minirt.trace(Scene((EYE, shape)), origins, directions)
        for i in np.flatnonzero(hits.owner == 0)[::3]:
            point = hits.point[i]
            coordinates = np.abs(point).max() + extent(shape)
            distance, error = off(shape, point, hits.normal[i])
            # Rays leave from ROUNDING roundings above the point, which must be above the surface.
            assert distance <= ROUNDING / 2 * U * coordinates
            assert error <= 16 * U * (1 + coordinates / least(shape))
            moved = np.linalg.norm(point - origins[i] - hits.distance[i] * directions[i])
            assert moved <= 64 * U * (hits.distance[i] + np.abs(origins[i]).max() + size(shape) + coordinates)
