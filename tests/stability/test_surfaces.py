"""Hit points and normals of `minirt.trace` and of the formulas, against the oracle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import minirt
from minirt.element import fields_of
from minirt.fields import Length, Lengths
from minirt.kernel.trace import ROUNDING
from minirt.rendering.packing.shape_arrays import extent
from minirt.scene import Camera, Scene
from minirt.shapes import KINDS, Kind, Shape
from tests.oracle.body import body, normals
from tests.shapes.execution_modes import on_arrays, surfaces
from tests.stability.common import common
from tests.stability.regime import Array, Regime, U, posed, size

Way = Callable[[Shape, Array, Array], tuple[Array, Array, Array]]
EYE = Camera((0, 0, 0), (0, 0, 1), 60)
REGIMES = [(kind, regime) for kind in KINDS for regime in common(kind)]


def least(shape: Shape) -> float:
    """The least length of a shape: a normal turns over the surface in inverse proportion to it."""
    lengths = [np.min(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, (Length, Lengths))]
    return min(lengths, default=np.inf)


def off(shape: Shape, point: Array, normal: Array) -> tuple[float, float]:
    """Distance of a hit from the wall that its normal fits best, and the error of the normal."""
    found = normals(body(shape), list(point))
    errors = [float(np.linalg.norm(np.array(out, float) - normal)) for _, out in found]
    best = int(np.argmin(errors))
    return float(found[best][0]), errors[best]


def interpreted(shape: Shape, origins: Array, directions: Array) -> tuple[Array, Array, Array]:
    """Distances, points and normals of rays, by the interpreted formulas."""
    t = on_arrays([shape], origins[None], directions[None])[0]
    on, out = surfaces([shape], (origins + np.where(np.isfinite(t), t, 0.0)[:, None] * directions)[None])
    return t, on[0], out[0]


def traced(shape: Shape, origins: Array, directions: Array) -> tuple[Array, Array, Array]:
    """Distances, points and normals of rays, by `minirt.trace`."""
    hits = minirt.trace(Scene((EYE, shape)), origins, directions)
    return hits.distance, hits.point, hits.normal


@pytest.mark.parametrize("way", [interpreted, traced])
@pytest.mark.parametrize(
    ("kind", "regime"), REGIMES, ids=lambda each: each.element.title if isinstance(each, Kind) else each.name
)
def test_hits_are_on_the_surface_and_normals_point_outwards(kind: Kind, regime: Regime, way: Way) -> None:
    rays = posed(regime).rays
    for shape, origins, directions in zip(rays.shapes, rays.origins, rays.directions, strict=True):
        distances, points, found = way(shape, origins, directions)
        for i in np.flatnonzero(np.isfinite(distances))[::3]:
            coordinates = np.abs(points[i]).max() + extent(shape)
            distance, error = off(shape, points[i], found[i])
            # Rays leave from ROUNDING roundings above the point, which must be above the surface.
            assert distance <= ROUNDING / 2 * U * coordinates
            assert error <= 16 * U * (1 + coordinates / least(shape))
            moved = np.linalg.norm(points[i] - origins[i] - distances[i] * directions[i])
            assert moved <= 64 * U * (distances[i] + np.abs(origins[i]).max() + size(shape) + coordinates)
