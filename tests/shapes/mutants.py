"""Wrong formulas that look right: the tests of the real ones must fail on them."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes import Vec, dot, fabs, sqrt
from minirt.report.measurements.textbook import meets_cylinder, meets_sphere
from minirt.shapes.plane import PackedPlane
from minirt.shapes.sphere import PackedSphere
from tests.shapes.execution_modes import on_arrays

naive_sphere = meets_sphere  # loses a small sphere far away
naive_cylinder = meets_cylinder  # has cracks at the rim, and fails along the axis


def first(r0: Any, r1: Any) -> Any:
    """The least root above 0, or the greater one if there is none."""
    near, far = np.minimum(r0, r1), np.maximum(r0, r1)
    return np.where(near > 0, near, far)


def accepts_nan(sphere: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """A sphere's formula whose test for a hit is inverted, so that NaN is a hit."""
    f = origin - sphere.centre
    g = f - dot(f, direction) * direction
    chord = sphere.radius * sphere.radius - dot(g, g)
    return ~(chord < 0), first(-dot(f, direction) - sqrt(chord), -dot(f, direction) + sqrt(chord))


def naive_quadratic(a: Any, _: Any, b: Any, c: Any, _product: Any) -> Any:
    """`negative_interval` by the schoolbook formula, which cancels."""
    D = b * b - a * c
    return D >= 0, (-b - sqrt(D)) / a, (-b + sqrt(D)) / a


def hits_behind(plane: PackedPlane, origin: Vec, direction: Vec) -> Any:
    """A plane that is hit behind the eye, too."""
    slope = dot(plane.normal, direction)
    return slope != 0, fabs(dot(plane.normal, plane.point - origin) / slope)


def with_formula(formula: Any) -> Any:
    """`on_arrays` with another formula than the shape's own."""
    return lambda shapes, origins, directions: on_arrays(shapes, origins, directions, formula)
