"""Wrong ways to intersect that look right: the checks of the real ones must reject them."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

from minirt.lanes import Vec, copysign, dot, fabs, maximum, minimum, sqrt, where
from minirt.shapes import KINDS, Shape, start, torus
from minirt.shapes.box import Box, PackedBox, slab_interval
from minirt.shapes.cone import PackedCone, close_start, intersect, occludes
from minirt.shapes.cylinder import PackedCylinder
from minirt.shapes.disc import PackedDisc
from minirt.shapes.frames import to_basis
from minirt.shapes.plane import PackedPlane
from minirt.shapes.shape import Flat
from minirt.shapes.sphere import PackedSphere
from minirt.shapes.square import PackedSquare
from minirt.shapes.triangle import Triangle
from tests.shapes.execution_modes import Intersect, kind_of, on_arrays, vec
from tests.shapes.regimes import Array


def with_formula(formula: Any) -> Intersect:
    """`on_arrays` with another formula than the shape's own."""
    return lambda shapes, origins, directions: on_arrays(shapes, origins, directions, formula)


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
# Curved kinds, whose formula for shadow rays knows little of where a ray starts.
CARELESS = [kind for kind in KINDS if kind.occludes and not issubclass(kind.element, Flat | Box | Triangle)]


def quadratic(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any]:
    """Whether a t^2 + 2 b t + c = 0 has roots, and both, without cancellation."""
    D = b * b - a * c
    q = -(b + copysign(sqrt(D), b))
    return D >= 0.0, minimum(q / a, c / q), maximum(q / a, c / q)


def cone_without_its_axis(cone: PackedCone, origin: Vec, direction: Vec) -> Any:
    """A cone that is missed where the discriminant rounds below 0, as along its axis."""
    p = to_basis(cone.u, cone.v, cone.w, origin - cone.apex)
    d = to_basis(cone.u, cone.v, cone.w, direction)
    rise = cone.slope * d.z
    a = d.x * d.x + d.y * d.y - rise * rise
    steep = a < 0.0
    tip, base = -p.z / d.z, (cone.height - p.z) / d.z
    first, last = minimum(tip, base), maximum(tip, base)
    start = minimum(maximum(-(p.x * d.x + p.y * d.y - cone.slope * p.z * rise) / a, first), last)
    p = p + start * d
    reach = cone.slope * p.z
    hit, low, high = quadratic(a, p.x * d.x + p.y * d.y - reach * rise, p.x * p.x + p.y * p.y - reach * reach)
    rising = d.z > 0.0
    near = where(steep, where(rising, maximum(start + high, first), first), maximum(start + low, first))
    far = where(steep, where(rising, last, minimum(start + low, last)), minimum(start + high, last))
    t = where(near > 0.0, near, far)
    return hit & (near <= far) & (t > 0.0), t


def cone_with_a_blurred_start(cone: PackedCone, origin: Vec, direction: Vec) -> Any:
    """A cone whose rays that start at both ends have an end beside their start, or all of a generator for an end."""

    def blurred(cone: PackedCone, origin: Vec, p: Vec, d: Vec, *others: Any) -> tuple[Any, ...]:
        *ends, half_b, c, product = close_start(cone, origin, p, d, *others)
        steep = d.x * d.x + d.y * d.y < (cone.slope * d.z) ** 2
        blur = where(steep, 2.0**-52 * dot(p, p), 0.0)
        return *ends, half_b, where((half_b == 0.0) & (product == 0.0), blur, c), product

    with patch("minirt.shapes.cone.close_start", blurred):
        return intersect(cone, origin, direction)


def cylinder_hit_at_the_start(cylinder: PackedCylinder, origin: Vec, direction: Vec) -> Any:
    """A cylinder that is hit again by rays which leave its surface."""
    p = to_basis(cylinder.u, cylinder.v, cylinder.w, origin - cylinder.centre)
    d = to_basis(cylinder.u, cylinder.v, cylinder.w, direction)
    first, last = slab_interval(p.z, d.z, cylinder.half)
    c = p.x * p.x + p.y * p.y - cylinder.radius * cylinder.radius
    hit, low, high = quadratic(d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y, c)
    near, far = maximum(low, first), minimum(high, last)
    t = where(near > 0.0, near, far)
    return hit & (near <= far) & (t > 0.0), t


def box_without_the_guard(box: PackedBox, origin: Vec, direction: Vec) -> Any:
    """A box in which NaN of a ray in the plane of one face hides another pair of faces."""
    p = to_basis(box.u, box.v, box.w, origin - box.centre)
    d = to_basis(box.u, box.v, box.w, direction)
    enters, leaves = zip(
        *(slab_interval(*each) for each in zip(*map(parts, (p, d, box.half)), strict=True)), strict=True
    )
    enter, leave = maximum(maximum(enters[0], enters[1]), enters[2]), minimum(minimum(leaves[0], leaves[1]), leaves[2])
    t = where(enter > 0.0, enter, leave)
    return (enter <= leave) & (t > 0.0), t


def box_hit_at_the_start(box: PackedBox, origin: Vec, direction: Vec) -> Any:
    """A box that is hit again by rays which leave a face of it."""
    p = to_basis(box.u, box.v, box.w, origin - box.centre)
    d = to_basis(box.u, box.v, box.w, direction)
    slabs = [slab_interval(*each) for each in zip(*map(parts, (p, d, box.half)), strict=True)]
    enter, leave = (np.fmax.reduce([s[0] for s in slabs]), np.fmin.reduce([s[1] for s in slabs]))
    t = where(enter > 0.0, enter, leave)
    return (enter <= leave) & (t > 0.0), t


def parts(v: Vec) -> tuple[Any, Any, Any]:
    return v.x, v.y, v.z


def disc_hit_at_0(disc: PackedDisc, origin: Vec, direction: Vec) -> Any:
    """A disc whose `>` became `>=`, so that a ray which starts exactly on it hits it there."""
    f = origin - disc.centre
    slope = dot(disc.normal, direction)
    t = -dot(disc.normal, f) / slope
    p = f + t * direction
    return (slope != 0.0) & (t >= 0.0) & (dot(p, p) <= disc.radius * disc.radius), t


def square_hit_at_the_start(square: PackedSquare, origin: Vec, direction: Vec) -> Any:
    """A square that is hit again by rays which start on it."""
    f = origin - square.centre
    slope = dot(square.normal, direction)
    t = -dot(square.normal, f) / slope
    p = f + t * direction
    across = maximum(fabs(dot(p, square.right)), fabs(dot(p, square.up)))
    return (fabs(slope) > 0.0) & (t > 0.0) & (across <= square.half), t


def plane_hit_at_0(plane: PackedPlane, origin: Vec, direction: Vec) -> Any:
    """A plane whose `>` became `>=`, so that a ray which starts exactly on it hits it there."""
    slope = dot(plane.normal, direction)
    t = dot(plane.normal, plane.point - origin) / slope
    return (slope != 0.0) & (t >= 0.0), t


def sphere_by_the_textbook(sphere: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """A sphere that is hit again by rays which leave its surface."""
    f = origin - sphere.centre
    hit, low, high = quadratic(1.0, dot(f, direction), dot(f, f) - sphere.radius * sphere.radius)
    t = where(low > 0.0, low, high)
    return hit & (t > 0.0), t


def a_rounding_farther(shapes: list[Any], origins: Array, directions: Array) -> Array:
    """The real formulas, with t too large by 100 roundings."""
    return on_arrays(shapes, origins, directions) * (1 + 100 * 2.0**-52)


def missed_in_planes(shapes: list[Any], origins: Array, directions: Array) -> Array:
    """The real formulas, but rays with a component of exactly 0 miss."""
    return np.where((directions == 0).any(axis=-1), np.inf, on_arrays(shapes, origins, directions))


VARIANTS: dict[str, tuple[str, Intersect]] = {
    "cone missed along its axis": ("cone", with_formula(cone_without_its_axis)),
    "cone with the formula of shadow rays": ("cone", with_formula(occludes)),
    "cone with a blurred start": ("cone", with_formula(cone_with_a_blurred_start)),
    "cylinder hit at the start": ("cylinder", with_formula(cylinder_hit_at_the_start)),
    "box without the guard against NaN": ("box", with_formula(box_without_the_guard)),
    "box hit at the start": ("box", with_formula(box_hit_at_the_start)),
    "disc hit at 0": ("disc", with_formula(disc_hit_at_0)),
    "square hit at the start": ("square", with_formula(square_hit_at_the_start)),
    "plane hit at 0": ("plane", with_formula(plane_hit_at_0)),
    "sphere hit at the start": ("sphere", with_formula(sphere_by_the_textbook)),
    "ellipsoid a hundred roundings farther": ("ellipsoid", a_rounding_farther),
    "torus hit at the start": ("torus", hits_its_start),
    "torus missed in planes": ("torus", missed_in_planes),
    "hyperboloid missed in planes": ("hyperboloid", missed_in_planes),
}
