"""Wrong ways to intersect that look right: the property must find each, in every kind that it can harm."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

from minirt.lanes import Vec, dot, where
from minirt.shapes import KINDS, Shape, compensated, quadrics, square, torus
from tests.shapes.execution_modes import Intersect, kind_of, on_arrays, vec
from tests.shapes.regimes import Array

QUADRICS = ("cylinder", "cone", "paraboloid", "hyperboloid", "ellipsoid")
FLAT = ("square", "disc")


def from_1e_4_on(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """Ignore hits nearer than a fixed distance: a remedy against shadow acne that knows no scale."""
    t = on_arrays(shapes, origins, directions)
    return np.where(t > 1e-4, t, np.inf)


def moved_on_by_1e_4(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """Start rays a fixed distance further on: another remedy that knows no scale."""
    return on_arrays(shapes, origins + 1e-4 * directions, directions) + 1e-4


def in_single_precision(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formulas in float32."""
    t = np.full(origins.shape[:2], np.inf)
    for i, shape in enumerate(shapes):
        rays = (vec(part[i].astype(np.float32)) for part in (origins, directions))
        with np.errstate(all="ignore"):
            hit, at = kind_of(shape).intersect(single(shape.pack()), *rays)
        t[i] = np.where(hit, at, np.inf)
    return t


def single(packed: Any) -> Any:
    """A packed shape whose numbers are float32."""
    with np.errstate(over="ignore"):
        parts = (Vec(*map(np.float32, (p.x, p.y, p.z))) if isinstance(p, Vec) else np.float32(p) for p in packed)
        return type(packed)(*parts)


def a_rounding_farther(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formulas, with t too large by 100 roundings."""
    return on_arrays(shapes, origins, directions) * (1 + 100 * 2.0**-52)


def missed_in_planes(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formulas, but rays with a component of exactly 0 miss."""
    return np.where((directions == 0).any(axis=-1), np.inf, on_arrays(shapes, origins, directions))


def as_of_a_shadow_ray(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formula of rays that start clear of all surfaces."""
    return on_arrays(shapes, origins, directions, partial(kind_of(shapes[0]).intersect, limit=np.inf))


def patched(target: Any, name: str, value: Any) -> Intersect:
    """The real formulas with another function or constant in them."""

    def intersect(shapes: list[Shape], origins: Array, directions: Array) -> Array:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(target, name, value)
            return on_arrays(shapes, origins, directions)

    return intersect


real_ends = quadrics.exact_ends


def ends_beside_the_start(a: Any, b: Any, c: Any, on: Any, error: Any) -> Any:
    """A ray that starts on a quadric, to rounding, may hit it there."""
    return real_ends(a, b, c, on & False, error)


def ends_of_a_start_on_the_surface(a: Any, b: Any, c: Any, on: Any, error: Any) -> Any:
    """The height of a start on a quadric, to rounding, counts as 0 for its other end, too."""
    return real_ends(a, b, (where(on, 0.0, c[0]), where(on, 0.0, c[1])), on, error)


def meets_plane_again(
    point: Vec, normal: Vec, origin: Vec, direction: Vec, limit: Any, share: float = 2.0**-20
) -> tuple[Any, Any, Vec]:
    """A ray that starts on a plane, to rounding, may hit it beyond a share of 1."""
    f = origin - point
    height, slope = dot(normal, f), dot(normal, direction)
    t = -height / slope
    least = np.where(np.abs(height) <= compensated.position_error(origin, f), share, 0.0)
    return (np.abs(slope) > 4 * 2.0**-53) & (t > least), t, f + t * direction


def hits_its_start(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formula of a torus, which trusts the rounded place where a ray starts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compensated, "POSITION", 0.0)
        patch.setattr(torus, "PAD", 0.0)
        return on_arrays(shapes, origins, directions)


EVERY: dict[str, tuple[Intersect, tuple[str, ...] | None]] = {  # with the kinds that it harms, None for all
    "from 1e-4 on": (from_1e_4_on, None),
    "moved on by 1e-4": (moved_on_by_1e_4, None),
    "in single precision": (in_single_precision, None),
    "a hundred roundings farther": (a_rounding_farther, None),
    "missed in planes": (missed_in_planes, None),
    "of a shadow ray": (as_of_a_shadow_ray, (*QUADRICS, "plane", "triangle", "box", *FLAT)),
    "ends beside the start": (patched(quadrics, "exact_ends", ends_beside_the_start), QUADRICS[:4]),
    "a start of no height": (patched(quadrics, "exact_ends", ends_of_a_start_on_the_surface), QUADRICS[:4]),
    "a share of the size is left out": (patched(square, "meets_plane", meets_plane_again), ("square",)),
    "a start that is trusted": (hits_its_start, ("torus", "plane", "triangle", "box", *QUADRICS[:4])),
}
PAIRS = [
    (name, kind) for name, (_, kinds) in EVERY.items() for kind in KINDS if kinds is None or kind.element.title in kinds
]
