"""Boundaries of shapes: their faces, as functions of a point that are 0 there.

A file of a shape declares `boundary(shape, point)`, which `minirt.rendering.queries.certificates` calls to check hits:

    def boundary(sphere: Any, point: Vec) -> Boundary:
        return Boundary((length(point - sphere.centre) - sphere.diameter / 2,))

`shape` has the fields of the scene line, or of the packed form of a mesh's triangle, and directions have exactly unit
length. Numbers are `minirt.shapes.double_double.DoubleDouble`: use + - * /, abs, their method `root` and what is here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from minirt.lanes import Vec, cross, dot

if TYPE_CHECKING:  # for annotations alone: who checks no hits does not load it
    from minirt.shapes.double_double import DoubleDouble

Roll = tuple[Any, Any]  # cosine and sine of a shape's turn about its own axis; their squares add up to exactly 1


class Boundary:
    """Faces of a shape, and where they end: numbers that belong to a point, < 0 inside.

    A face is where one of `faces` is 0, and neither another face nor one of the `limits`, which are edges of a sheet or
    ends without a face, is above 0. The numbers are distances or, close to the face, nearly proportional to them.
    Normals point to where they grow.
    """

    __slots__ = ("faces", "limits")

    def __init__(self, faces: tuple[DoubleDouble, ...], limits: tuple[DoubleDouble, ...] = ()) -> None:
        self.faces, self.limits = faces, limits


def length(v: Vec) -> DoubleDouble:
    """Return the length of a vector."""
    root: DoubleDouble = dot(v, v).root()
    return root


def unit(v: Vec) -> Vec:
    """Return the vector of length 1 in the direction of v, however short v is."""
    power = -np.frexp(np.maximum(np.maximum(abs(v.x.high), abs(v.y.high)), abs(v.z.high)))[1]
    scaled = Vec(v.x.scaled(power), v.y.scaled(power), v.z.scaled(power))
    return scaled / length(scaled)


def hypotenuse(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    """Return sqrt(a^2 + b^2)."""
    return (a * a + b * b).root()


def along_and_off_axis(axis: Vec, p: Vec) -> tuple[DoubleDouble, DoubleDouble]:
    """Return the coordinate of p along a unit vector, and its distance from the line through the origin along it."""
    height = dot(axis, p)
    return height, length(p - height * axis)


def own_coordinates(axis: Vec, roll: Roll, p: Vec) -> tuple[DoubleDouble, DoubleDouble, DoubleDouble]:
    """Return p in the frame of a shape whose own y axis is `axis`: as `minirt.shapes.basis.basis`, exactly."""
    x, y, z = axis.x, axis.y, axis.z
    sign = np.copysign(1.0, y.high)
    a = -1.0 / (sign + y)
    b = z * x * a
    own_x, own_z = Vec(sign + x * x * a, -x, b), Vec(sign * b, -sign * z, 1.0 + sign * (z * z * a))
    c, s = roll
    x, z = dot(own_x, p), dot(own_z, p)
    return c * x - s * z, dot(axis, p), c * z + s * x


def upright_frame(normal: Vec, roll: Roll) -> tuple[Vec, Vec]:
    """Return right and up of a flat surface, as `minirt.shapes.basis.facing_frame`, exactly."""
    level = (normal.x.high == 0.0) & (normal.z.high == 0.0)
    right = unit(Vec(normal.z + np.where(level, 1.0, 0.0), 0.0 * normal.y, -normal.x))
    up = cross(normal, right)
    c, s = roll
    return c * right + s * up, c * up - s * right


def facing(way: Vec, height: DoubleDouble) -> DoubleDouble:
    """Return a height above a plane, or its opposite: the one that grows along `way`."""
    return height * np.where(dot(height.slope, Vec(way.x.high, way.y.high, way.z.high)) < 0.0, -1.0, 1.0)


def triangle_boundary(a: Vec, b: Vec, c: Vec, point: Vec) -> Boundary:
    """The boundary of the triangle between three corners: its plane and its edges."""
    normal = unit(cross(b - a, c - a))
    edges = tuple(dot(unit(cross(end - start, normal)), point - start) for start, end in ((a, b), (b, c), (c, a)))
    return Boundary((dot(normal, point - a),), edges)
