"""The backward bound of all hits, the tolerance of t that follows from it, and certificates to compare with them."""

from __future__ import annotations

import numpy as np

from minirt.rendering.queries.certificates import Certificate, certify
from minirt.rendering.queries.certificates import Rays as HitRays
from minirt.shapes import Shape
from tests.shapes.execution_modes import surfaces
from tests.shapes.regimes import Array, Rays

BOUND = 4.0  # of the backward error of any hit, in units of 2^-53 (t + |o - c| + size)
U = 2.0**-53
STEEPEST = 1e-6  # relative tolerance; beyond it the surface turns away within the error, and no first order holds


def certified(rays: Rays, t: Array, normals: Array | None = None) -> Certificate:
    """Certify hits at t, (m, n), of m shapes by n rays; without normals, as hits of the nearest face."""
    hit = np.isfinite(t)
    owners = np.nonzero(hit)[0]
    normals = np.full((*t.shape, 3), np.nan) if normals is None else normals
    found = certify(
        tuple(rays.shapes),
        owners,
        np.zeros_like(owners),
        HitRays(rays.origins[hit], rays.directions[hit], t[hit], normals[hit]),
    )
    whole = Certificate(*np.full((3, *t.shape), np.nan))
    for all_of, these in zip(whole, found, strict=True):
        all_of[hit] = these
    return whole


def normals_of(rays: Rays, t: Array) -> Array:
    """The normals of hits at t, by the interpreted formulas."""
    points = rays.origins + np.where(np.isfinite(t), t, 0.0)[..., None] * rays.directions
    return surfaces(rays.shapes, points)[1]


def derived_tolerance(rays: Rays, t: Array) -> Array:
    """The relative tolerance of t that follows from the backward bound: the bound times the condition number."""
    condition = certified(rays, t).condition
    return np.minimum(BOUND * U * np.nan_to_num(condition, nan=0.0), STEEPEST)


def away_from_surface(rays: Rays, t: Array) -> list[str]:
    """Complaints about hits that are farther from the surface than the backward bound."""
    errors = certified(rays, t, normals_of(rays, t)).backward_error
    with np.errstate(invalid="ignore"):
        beyond = np.argwhere(np.isfinite(t) & ~(errors <= BOUND)).tolist()
    return [complaint(rays.shapes[i], rays.origins[i, j], rays.directions[i, j], errors[i, j]) for i, j in beyond]


def complaint(shape: Shape, origin: Array, direction: Array, error: float) -> str:
    """Say how far a hit is from the surface."""
    return f"backward error {error:.3g}: {shape} from {origin.tolist()}, {direction.tolist()}"
