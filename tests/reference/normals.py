"""Unit normals of shapes for the reference renderer, outward where there is an outside."""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.reference.vectors import Array, dot, length, own_x_and_z, profile, right_and_up, turned, unit


@singledispatch
def normals(shape: Shape, points: Array) -> Array:
    """The unit normals of a shape at points on its surface."""
    raise TypeError(f"the reference renderer knows no {shape.title}")


@singledispatch
def shading(shape: Shape, points: Array, normal: Array) -> Array:
    """The unit normals by which points are lit without bump and normal maps; `normal` are those of the shape."""
    return normal


@singledispatch
def smooth_points(shape: Shape, points: Array, facing: Array) -> Array:
    """The points of the smooth surface of a shape above points of its facets, seen from the side of `facing`."""
    return points


@normals.register(Plane)
@normals.register(Square)
@normals.register(Disc)
def _(flat: Plane | Square | Disc, points: Array) -> Array:
    return np.broadcast_to(np.array(flat.normal), points.shape)


@normals.register(Triangle)
def _(triangle: Triangle, points: Array) -> Array:
    a, b, c = (np.array(corner) for corner in (triangle.a, triangle.b, triangle.c))
    return np.broadcast_to(unit(np.cross(b - a, c - a)), points.shape)


@normals.register(Sphere)
def _(sphere: Sphere, points: Array) -> Array:
    return unit(points - np.array(sphere.centre))


@normals.register(Ellipsoid)
def _(ellipsoid: Ellipsoid, points: Array) -> Array:
    axes = scaled_axes(ellipsoid)
    return unit((points - np.array(ellipsoid.centre)) @ axes.T @ axes)


def scaled_axes(ellipsoid: Ellipsoid) -> Array:
    """The own x, y and z axes of an ellipsoid, each divided by its semi-axis, as the rows of a matrix (3, 3)."""
    y = np.array(ellipsoid.axis)
    _, z = own_x_and_z(y, ellipsoid.roll)
    return np.stack([np.cross(y, z), y, z]) / (np.array(ellipsoid.sizes)[:, None] / 2)


@normals.register(Box)
def _(box: Box, points: Array) -> Array:
    x, z = own_x_and_z(np.array(box.axis), box.roll)
    axes = np.stack([x, np.cross(z, x), z])
    p = (points - np.array(box.centre)) @ axes.T
    face = np.argmax(np.abs(p) - np.array(box.sizes) / 2, axis=-1)
    return np.asarray(np.sign(np.take_along_axis(p, face[..., None], -1)) * axes[face])


@normals.register(Cone)
@normals.register(Cylinder)
@normals.register(Paraboloid)
@normals.register(Hyperboloid)
def _(shape: Cone | Cylinder | Paraboloid | Hyperboloid, points: Array) -> Array:
    form = profile(shape)
    p = points - form.origin
    height = dot(p, form.axis)
    across = p - height[..., None] * form.axis
    # Half of the gradient of radius^2 - profile; a point is on a cap where the side is farther away.
    gradient = across - (form.one / 2 + form.two * height)[..., None] * form.axis
    with np.errstate(divide="ignore", invalid="ignore"):
        off_side = np.abs(dot(across, across) - form.at(height)) / (2 * length(gradient))
    ends = np.array([form.low, form.high])
    off_ends = np.abs(height[..., None] - ends)
    off_ends[..., form.at(ends) == 0] = np.inf
    up = np.where(off_ends.argmin(axis=-1) == 1, 1.0, -1.0)
    on_cap = off_ends.min(axis=-1) < off_side
    return np.where(on_cap[..., None], up[..., None] * form.axis, unit(gradient))


@normals.register(Torus)
def _(torus: Torus, points: Array) -> Array:
    axis = np.array(torus.axis)
    p = points - np.array(torus.centre)
    ring = unit(p - dot(p, axis)[..., None] * axis) * torus.diameter / 2
    return unit(p - ring)


def right_and_up_on(flat: Plane | Square | Disc) -> tuple[Array, Array]:
    """Right and up of a picture on a flat shape."""
    normal = np.array(flat.normal)
    right, up = right_and_up(-normal)
    return turned(right, normal, flat.roll), turned(up, normal, flat.roll)
