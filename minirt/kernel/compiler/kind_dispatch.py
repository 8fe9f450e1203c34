"""Choice of formulas by the kind of a shape, at compile time: the type of a packed shape tells its kind.

A kernel so holds code for the kinds of shapes that its scene has, and for no others.
"""

from __future__ import annotations

from typing import Any

from numba.extending import overload

from minirt.kernel import scene_arrays, shadow_rays, trace
from minirt.kernel.compiler.options import INLINED
from minirt.shapes import Kind

# Parameters have no annotations: numba compares them with those of the implementation.


@overload(scene_arrays.intersect, jit_options=INLINED, strict=False)
def _intersect(shape, origin, direction):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).intersect


@overload(scene_arrays.occludes, jit_options=INLINED, strict=False)
def _occludes(shape, origin, direction):  # type: ignore[no-untyped-def]
    kind = scene_arrays.kind_of_packed(shape.instance_class)
    return kind.occludes or kind.intersect


@overload(scene_arrays.surface, jit_options=INLINED, strict=False)
def _surface(shape, point):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).surface


@overload(scene_arrays.shading, jit_options=INLINED, strict=False)
def _shading(shape, point, normal):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).shading


@overload(scene_arrays.smooth_point, jit_options=INLINED, strict=False)
def _smooth_point(shape, point, normal):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).smooth_point


@overload(scene_arrays.may_meet, jit_options=INLINED, strict=False)
def _may_meet(shape, apex, start, direction, active):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).may_meet


@overload(scene_arrays.mapping, jit_options=INLINED, strict=False)
def _mapping(shape, point, normal):  # type: ignore[no-untyped-def]
    return scene_arrays.kind_of_packed(shape.instance_class).mapping


@overload(trace.closest_of_kind, jit_options=INLINED, strict=False)
def _closest_of_kind(group, state, arguments):  # type: ignore[no-untyped-def]
    return trace.closest_batched if kind_of_group(group).batched else trace.closest_one_by_one


@overload(shadow_rays.unoccluded_by_kind, jit_options=INLINED, strict=False)
def _unoccluded_by_kind(group, visible, arguments):  # type: ignore[no-untyped-def]
    return shadow_rays.unoccluded_batched if kind_of_group(group).batched else shadow_rays.unoccluded_one_by_one


def kind_of_group(group: Any) -> Kind:
    """Return the kind of the shapes of a group, by its type."""
    return scene_arrays.kind_of(group.content[0].dtype.fields)
