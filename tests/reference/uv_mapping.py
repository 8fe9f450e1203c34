"""Texture coordinates and tangents of shapes for the reference renderer: u to the right, v upwards."""

from __future__ import annotations

from functools import singledispatch
from typing import NamedTuple

import numpy as np

from minirt.materials import Placement
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
from tests import oracle
from tests.reference.vectors import Array, dot, first_point, length, own_x_and_z, right_and_up, turned, unit


class SurfacePoint(NamedTuple):
    """Texture coordinates of points, and their tangents."""

    u: Array
    v: Array
    along_u: Array  # dP/du: the point's movement per unit of u
    along_v: Array


@singledispatch
def surface_point(shape: Shape, points: Array) -> SurfacePoint:
    """Texture coordinates and tangents at points of the surface of a shape."""
    raise TypeError(f"the reference renderer knows no {shape.title}")


def placed(at: SurfacePoint, uv: Placement | None) -> SurfacePoint:
    """Coordinates on a picture that is scaled, turned and shifted, by the inverse of that map."""
    if uv is None:
        return at
    angle = np.radians(uv.turn)
    right, up = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    edges = np.stack([right / uv.scale_u, up / uv.scale_v], axis=-1)  # of the picture, in the surface's u and v
    u, v = np.linalg.solve(edges, np.stack([at.u - uv.shift_u, at.v - uv.shift_v]).reshape(2, -1))
    tangents = (edge[0] * at.along_u + edge[1] * at.along_v for edge in edges.T)
    return SurfacePoint(u.reshape(at.u.shape), v.reshape(at.u.shape), *tangents)


def flat_point(points: Array, corner: Array, right: Array, up: Array) -> SurfacePoint:
    """Coordinates on a rectangular picture with this lower left corner and these edges, perpendicular to each other."""
    p = points - corner
    edges = [np.broadcast_to(edge, points.shape) for edge in (right, up)]
    return SurfacePoint(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up), *edges)


@surface_point.register
def _(plane: Plane, points: Array) -> SurfacePoint:
    return flat_point(points, np.array(plane.point), *right_and_up_on(plane))


@surface_point.register(Square)
@surface_point.register(Disc)
def _(sheet: Square | Disc, points: Array) -> SurfacePoint:
    size = sheet.diameter if isinstance(sheet, Disc) else sheet.side
    right, up = right_and_up_on(sheet)
    return flat_point(points, np.array(sheet.centre) - size * (right + up) / 2, size * right, size * up)


@surface_point.register
def _(triangle: Triangle, points: Array) -> SurfacePoint:
    a, b, c = (np.array(corner) for corner in (triangle.a, triangle.b, triangle.c))
    (u, v), *_ = np.linalg.lstsq(np.stack([b - a, c - a], axis=-1), (points - a).reshape(-1, 3).T, rcond=None)
    shape = points.shape[:-1]
    return SurfacePoint(
        u.reshape(shape), v.reshape(shape), np.broadcast_to(b - a, points.shape), np.broadcast_to(c - a, points.shape)
    )


@surface_point.register
def _(box: Box, points: Array) -> SurfacePoint:
    y = np.array(box.axis)
    _, z = own_x_and_z(y, box.roll)
    x = np.cross(y, z)
    wide, tall, deep = box.sizes
    normal = normals(box, points)
    # For each face its normal, right and up as seen by a viewer who faces it, width and height.
    faces = [(x, -z, y, deep, tall), (-x, z, y, deep, tall), (z, x, y, wide, tall), (-z, -x, y, wide, tall)]
    faces += [(y, x, -z, wide, deep), (-y, x, z, wide, deep)]
    found = SurfacePoint(*(np.zeros(points.shape[:-1] + rest) for rest in ((), (), (3,), (3,))))
    for out, to_right, upwards, across, high in faces:
        on_face = dot(normal, out) > 0.5
        right, up = across * to_right, high * upwards
        own = flat_point(points, np.array(box.centre) - (right + up) / 2, right, up)
        for part, value in zip(found, own, strict=True):
            part[on_face] = value[on_face]
    return found


def longitude(p: Array, up: Array, middle: Array) -> Array:
    """The angle about the axis `up` from 0 to 1, counter-clockwise as seen from its tip, 1/2 in the direction
    `middle`."""
    return np.asarray(0.5 + np.arctan2(dot(np.cross(middle, p), up), dot(middle, p)) / (2 * np.pi))


@surface_point.register
def _(sphere: Sphere, points: Array) -> SurfacePoint:
    up = np.array(sphere.axis)
    _, south = own_x_and_z(up, sphere.roll)
    p = points - np.array(sphere.centre)
    normal = unit(p)
    height = dot(normal, up)
    latitude = np.arcsin(np.clip(height, -1, 1))
    north = up - height[..., None] * normal
    far = length(north)[..., None]
    along_v = np.where(far > 0, np.pi * sphere.diameter / 2 * north / np.where(far > 0, far, 1), 0)
    around = 2 * np.pi * np.cross(up, p)
    return SurfacePoint(longitude(p, up, -south), 0.5 + latitude / np.pi, around, along_v)


@surface_point.register
def _(ellipsoid: Ellipsoid, points: Array) -> SurfacePoint:
    # The picture of the unit sphere, stretched: tangents stretch with the points.
    scaled = scaled_axes(ellipsoid)
    ball = surface_point(Sphere((0, 0, 0), 2, ellipsoid.colour), (points - np.array(ellipsoid.centre)) @ scaled.T)
    stretch = np.linalg.inv(scaled).T
    return ball._replace(along_u=ball.along_u @ stretch, along_v=ball.along_v @ stretch)


@surface_point.register
def _(torus: Torus, points: Array) -> SurfacePoint:
    axis = np.array(torus.axis)
    _, z = own_x_and_z(axis, torus.roll)
    p = points - np.array(torus.centre)
    outwards = unit(p - dot(p, axis)[..., None] * axis)
    normal = normals(torus, points)
    out, up = dot(normal, outwards), dot(normal, axis)
    along_v = np.pi * torus.tube * (out[..., None] * axis - up[..., None] * outwards)
    return SurfacePoint(
        longitude(p, axis, -z), 0.5 + np.arctan2(up, out) / (2 * np.pi), 2 * np.pi * np.cross(axis, p), along_v
    )


@surface_point.register(Cone)
@surface_point.register(Cylinder)
@surface_point.register(Paraboloid)
@surface_point.register(Hyperboloid)
def _(shape: Cone | Cylinder | Paraboloid | Hyperboloid, points: Array) -> SurfacePoint:
    _, z = own_x_and_z(np.array(shape.axis), shape.roll)
    up = np.array(shape.axis) * (-1 if isinstance(shape, Cone) else 1)  # a cone has its apex above
    out, p = normals(shape, points), points - first_point(shape)
    height, around = dot(p, up), np.cross(up, p)
    outwards = unit(p - height[..., None] * up)
    upwards = unit(np.cross(out, around))  # along the side
    with np.errstate(divide="ignore", invalid="ignore"):  # on caps, which follow
        if isinstance(shape, Paraboloid):
            v, per_v = 2 * length(around) / shape.diameter, shape.diameter / 2 / dot(upwards, outwards)
        else:
            v = height / shape.height + (1.0 if isinstance(shape, Cone) else 0.5)
            per_v = shape.height / dot(upwards, up)
        side = SurfacePoint(longitude(p, up, -z), v, 2 * np.pi * around, per_v[..., None] * upwards)
    # On a cap, right is along x of the upright shape and up along -z on the upper one, along z on the lower one.
    right = shape.diameter * np.cross(up, z)
    for sign in (-1, 1):
        on_cap, forward = sign * dot(out, up) > 1 - 1e-9, -sign * shape.diameter * z
        cap = flat_point(points, first_point(shape) - (right + forward) / 2, right, forward)
        for part, value in zip(side, cap, strict=True):
            part[on_cap] = value[on_cap]
    return side


@singledispatch
def normals(shape: Shape, points: Array) -> Array:
    """The unit normals of a shape at points on its surface: of the face that is nearest, to first order."""
    return oracle.normals(shape, points.reshape(-1, 3)).reshape(points.shape) if points.size else points


@singledispatch
def shading(shape: Shape, points: Array, normal: Array) -> Array:
    """The unit normals by which points are lit without bump and normal maps; `normal` are those of the shape."""
    return normal


@singledispatch
def smooth_points(shape: Shape, points: Array, facing: Array) -> Array:
    """The points of the smooth surface of a shape above points of its facets, seen from the side of `facing`."""
    return points


def scaled_axes(ellipsoid: Ellipsoid) -> Array:
    """The own x, y and z axes of an ellipsoid, each divided by its semi-axis, as the rows of a matrix (3, 3)."""
    y = np.array(ellipsoid.axis)
    _, z = own_x_and_z(y, ellipsoid.roll)
    return np.stack([np.cross(y, z), y, z]) / (np.array(ellipsoid.sizes)[:, None] / 2)


def right_and_up_on(flat: Plane | Square | Disc) -> tuple[Array, Array]:
    """Right and up of a picture on a flat shape."""
    normal = np.array(flat.normal)
    right, up = right_and_up(-normal)
    return turned(right, normal, flat.roll), turned(up, normal, flat.roll)
