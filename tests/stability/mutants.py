"""Wrong ways to intersect that look right: the checks of the real ones must reject them."""

from __future__ import annotations

from functools import partial
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from minirt.lanes import Vec
from minirt.shapes import KINDS, Shape, Sphere, compensated, torus
from minirt.shapes.quadrics import exact_ends
from tests.shapes.execution_modes import Intersect, kind_of, on_arrays, vec
from tests.shapes.regimes import Array
from tests.stability.common import QUADRICS


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
    parts = (Vec(*map(np.float32, (p.x, p.y, p.z))) if isinstance(p, Vec) else np.float32(p) for p in packed)
    return type(packed)(*parts)


def as_of_a_shadow_ray(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formula of rays that start clear of all surfaces."""
    return on_arrays(shapes, origins, directions, partial(kind_of(shapes[0]).intersect, limit=np.inf))


def hits_its_start(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formula of a torus, which trusts the rounded place where a ray starts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compensated, "POSITION", 0.0)
        patch.setattr(torus, "PAD", 0.0)
        return on_arrays(shapes, origins, directions)


STARTS = ("on the surface", "on the surface, a scene at 1e4", "just above a huge one")
# For each mutant regimes that it must fail; it passes those that are easy for it.
ANY: dict[str, tuple[Intersect, tuple[str, ...]]] = {
    "from 1e-4 on": (from_1e_4_on, ("the least size",)),
    "moved on by 1e-4": (moved_on_by_1e_4, ("the least size", "a scene at 1e8")),
    "in single precision": (in_single_precision, ("usual", "a scene at 1e6", "a million sizes away")),
}
# Curved kinds, whose formula for shadow rays knows little of where a ray starts.
CARELESS = [kind for kind in KINDS if kind.element in QUADRICS and kind.element is not Sphere]


def with_ends_beside_the_start(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formulas, but a ray that starts on a quadric, to rounding, may hit it there."""

    def careless(a: Any, b: Any, c: Any, on: Any, error: Any) -> Any:
        return exact_ends(a, b, c, on & False, error)

    with patch("minirt.shapes.quadrics.exact_ends", careless):
        return on_arrays(shapes, origins, directions)


def a_rounding_farther(shapes: list[Any], origins: Array, directions: Array) -> Array:
    """The real formulas, with t too large by 100 roundings."""
    return on_arrays(shapes, origins, directions) * (1 + 100 * 2.0**-52)


def missed_in_planes(shapes: list[Any], origins: Array, directions: Array) -> Array:
    """The real formulas, but rays with a component of exactly 0 miss."""
    return np.where((directions == 0).any(axis=-1), np.inf, on_arrays(shapes, origins, directions))


EVERY: dict[str, Intersect] = {"a hundred roundings farther": a_rounding_farther, "missed in planes": missed_in_planes}
VARIANTS: dict[str, tuple[str, Intersect]] = {
    **{f"{kind.element.title} {name}": (kind.element.title, way) for kind in KINDS for name, way in EVERY.items()},
    "cone with the formula of shadow rays": ("cone", as_of_a_shadow_ray),
    "cone with ends beside the start": ("cone", with_ends_beside_the_start),
    "torus hit at the start": ("torus", hits_its_start),
}
