"""Wrong ways to intersect that look right: the checks of the real ones must reject them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.lanes import Vec
from minirt.shapes import KINDS, Shape, start, torus
from minirt.shapes.box import Box
from minirt.shapes.shape import Flat
from minirt.shapes.triangle import Triangle
from tests.oracle import textbook
from tests.shapes import mutants
from tests.shapes.execution_modes import Array, Intersect, kind_of, on_arrays, vec


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
    return on_arrays(shapes, origins, directions, kind_of(shapes[0]).occludes)


def hits_its_start(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """The real formula of a torus, which trusts the rounded place where a ray starts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(start, "POSITION", 0.0)
        patch.setattr(torus, "PAD", 0.0)
        return on_arrays(shapes, origins, directions)


STARTS = ("on the surface", "on the surface, a scene at 1e4", "just above a huge one")
# For each mutant regimes that it must fail; it passes those that are easy for it.
ANY: dict[str, tuple[Intersect, tuple[str, ...]]] = {
    "from 1e-4 on": (from_1e_4_on, ("a size of 1e-12",)),
    "moved on by 1e-4": (moved_on_by_1e_4, ("a size of 1e-12", "a scene at 1e8")),
    "in single precision": (in_single_precision, ("usual", "a scene at 1e6", "a million sizes away")),
}
OWN: dict[str, tuple[Intersect, tuple[str, ...]]] = {
    "sphere": (
        mutants.with_formula(mutants.naive_sphere),
        ("a million sizes away", "a size of 1e-6, seen from 1e6", "from 0.001 above a diameter of 1e9"),
    ),
    "cylinder": (
        mutants.with_formula(mutants.naive_cylinder),
        ("a million sizes away", "a size of 1e-6, seen from 1e6", "at the rim", "on the surface"),
    ),
    "cone": (
        mutants.with_formula(textbook.meets_cone),
        (
            *("a million sizes away", "at the apex", "along a generator", "a half-angle of 89.94 degrees"),
            *("along the axis", "on the surface"),
        ),
    ),
    "paraboloid": (
        mutants.with_formula(textbook.meets_paraboloid),
        ("a million sizes away", "along the axis", "at the vertex", "on the surface"),
    ),
    "hyperboloid": (
        mutants.with_formula(textbook.meets_hyperboloid),
        ("a million sizes away", "along an asymptote", "on the surface"),
    ),
    "torus": (hits_its_start, ("on the surface", "on the surface, a scene at 1e4")),
    "triangle": (mutants.with_formula(mutants.mean_of_corners), ("a sliver", "a sliver next to none")),
    "plane": (mutants.with_formula(mutants.hits_behind), ("usual", "at a slope of 1e-6 to 0.01")),
}
# Curved kinds, whose formula for shadow rays knows little of where a ray starts.
CARELESS = [kind for kind in KINDS if kind.occludes and not issubclass(kind.element, Flat | Box | Triangle)]
