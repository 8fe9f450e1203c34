"""Charts of shapes, written from their manual pages: for each part of a shape the point and normal at given u and v.

They use sines, cosines and rotations, where the formulas of the program use none of these.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch

import numpy as np

from minirt.shapes import Shape
from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.shapes.regimes import Array, unit
from tests.skipping import skip_incomplete

Chart = Callable[[Array, Array], tuple[Array, Array]]  # u and v to points and outward normals
AROUND = {"sphere", "cylinder", "cone", "paraboloid", "hyperboloid", "torus", "ellipsoid"}  # u = 1 is where u = 0 is
X, Y, Z = np.eye(3)


def own_frame(axis: Array) -> tuple[Array, Array, Array]:
    """The axes of a shape with this axis: the scene's, after the smallest rotation that takes y to it (Rodrigues).

    For an axis that points down, y is taken to its opposite, and then half a turn about z is added.
    """
    axis = np.asarray(axis)
    target = axis if axis[1] >= 0 else -axis
    sine = np.cross(Y, target)
    k = np.array([[0, -sine[2], sine[1]], [sine[2], 0, -sine[0]], [-sine[1], sine[0], 0]])
    turn = np.eye(3) + k + k @ k / (1 + target[1])
    x, y, z = turn.T
    return (x, y, z) if axis[1] >= 0 else (-x, -y, z)


def upright(normal: Array) -> tuple[Array, Array]:
    """Right and up as seen by a viewer who faces a flat shape."""
    normal = np.asarray(normal)
    if abs(normal[1]) == 1:
        return X, -normal[1] * Z
    right = unit(np.cross(-normal, Y))
    return right, np.cross(right, -normal)


def outer(weights: Array, vector: Array) -> Array:
    """The vector times each of the weights, (..., 3)."""
    return np.asarray(weights)[..., None] * vector


def flat_chart(middle: Array, right: Array, up: Array, normal: Array, width: float, height: float) -> Chart:
    """Chart of a picture on a rectangle."""

    def chart(u: Array, v: Array) -> tuple[Array, Array]:
        point = middle + outer((u - 0.5) * width, right) + outer((v - 0.5) * height, up)
        return point, np.broadcast_to(normal, point.shape)

    return chart


def revolved_chart(
    base: Array, frame: tuple[Array, Array, Array], profile: Callable[[Array], tuple[Array, ...]]
) -> Chart:
    """Chart of a solid of revolution about the y axis of a frame.

    `profile` gives for each v the radius, the height, and the components of the normal outwards and upwards.
    """
    x, y, z = frame

    def chart(u: Array, v: Array) -> tuple[Array, Array]:
        # The middle of the picture is at -z; seen from there, right is towards -x.
        angle = 2 * np.pi * (u - 0.5)
        out = outer(-np.sin(angle), x) + outer(-np.cos(angle), z)
        radius, height, outwards, upwards = profile(v)
        return base + radius[..., None] * out + outer(height, y), unit(outwards[..., None] * out + outer(upwards, y))

    return chart


def cap_charts(frame: tuple[Array, Array, Array], middle: Array, width: float, *sides: int) -> list[Chart]:
    """Charts of caps above (1) or below (-1), with pictures as on a floor or a ceiling."""
    x, y, z = frame
    return [flat_chart(middle, x, -side * z, side * y, width, width) for side in sides]


@singledispatch
def charts(shape: Shape) -> list[Chart]:
    """The charts of a shape: one for each part that has a picture of its own."""
    skip_incomplete(
        f"no chart of the {shape.title}: with one in {__file__} its pictures are compared with its manual page"
    )


@charts.register
def _(plane: Plane) -> list[Chart]:
    right, up = upright(plane.normal)
    corner = np.array(plane.point)
    return [flat_chart(corner + 0.5 * (right + up), right, up, np.array(plane.normal), 1, 1)]


@charts.register
def _(square: Square) -> list[Chart]:
    return [
        flat_chart(np.array(square.centre), *upright(square.normal), np.array(square.normal), square.side, square.side)
    ]


@charts.register
def _(disc: Disc) -> list[Chart]:
    edge = disc.diameter
    return [flat_chart(np.array(disc.centre), *upright(disc.normal), np.array(disc.normal), edge, edge)]


@charts.register
def _(box: Box) -> list[Chart]:
    (x, y, z), (w, h, d) = own_frame(box.axis), box.sizes
    # right, up and normal; width, height and depth
    faces = [(x, y, z, w, h, d), (-x, y, -z, w, h, d), (-z, y, x, d, h, w), (z, y, -x, d, h, w)]
    faces += [(x, -z, y, w, d, h), (x, z, -y, w, d, h)]
    return [flat_chart(np.array(box.centre) + f / 2 * o, r, u, o, a, b) for r, u, o, a, b, f in faces]


@charts.register
def _(triangle: Triangle) -> list[Chart]:
    a, b, c = map(np.array, (triangle.a, triangle.b, triangle.c))
    normal = unit(np.cross(b - a, c - a))

    def chart(u: Array, v: Array) -> tuple[Array, Array]:
        point = a + outer(u, b - a) + outer(v, c - a)
        return point, np.broadcast_to(normal, point.shape)

    return [chart]


@charts.register
def _(sphere: Sphere) -> list[Chart]:
    r = sphere.diameter / 2

    def profile(v: Array) -> tuple[Array, ...]:
        latitude = np.pi * (v - 0.5)
        return r * np.cos(latitude), r * np.sin(latitude), np.cos(latitude), np.sin(latitude)

    return [revolved_chart(np.array(sphere.centre), (X, Y, Z), profile)]


@charts.register
def _(ellipsoid: Ellipsoid) -> list[Chart]:
    frame, semi = np.stack(own_frame(ellipsoid.axis)), np.array(ellipsoid.sizes) / 2
    (ball,) = charts(Sphere((0, 0, 0), 2, ellipsoid.colour))

    def chart(u: Array, v: Array) -> tuple[Array, Array]:
        q, _ = ball(u, v)
        return np.array(ellipsoid.centre) + (q * semi) @ frame, unit((q / semi) @ frame)

    return [chart]


@charts.register
def _(torus: Torus) -> list[Chart]:
    ring, tube = torus.diameter / 2, torus.tube / 2

    def profile(v: Array) -> tuple[Array, ...]:
        angle = 2 * np.pi * (v - 0.5)
        return ring + tube * np.cos(angle), tube * np.sin(angle), np.cos(angle), np.sin(angle)

    return [revolved_chart(np.array(torus.centre), own_frame(torus.axis), profile)]


@charts.register
def _(cylinder: Cylinder) -> list[Chart]:
    frame, middle, h = own_frame(cylinder.axis), np.array(cylinder.centre), cylinder.height

    def profile(v: Array) -> tuple[Array, ...]:
        one = np.ones_like(v)
        return cylinder.diameter / 2 * one, h * (v - 0.5), one, 0 * one

    ends = [cap_charts(frame, middle + side * h / 2 * frame[1], cylinder.diameter, side)[0] for side in (1, -1)]
    return [revolved_chart(middle, frame, profile), *ends]


@charts.register
def _(hyperboloid: Hyperboloid) -> list[Chart]:
    frame, middle, h = own_frame(hyperboloid.axis), np.array(hyperboloid.centre), hyperboloid.height
    waist, end = hyperboloid.waist / 2, hyperboloid.diameter / 2

    def profile(v: Array) -> tuple[Array, ...]:
        share = 2 * v - 1  # of half the height
        radius = np.sqrt(waist**2 + (end - waist) * (end + waist) * share**2)
        return radius, share * h / 2, radius * h, -2 * (end - waist) * (end + waist) * share

    ends = [cap_charts(frame, middle + side * h / 2 * frame[1], 2 * end, side)[0] for side in (1, -1)]
    return [revolved_chart(middle, frame, profile), *ends]


@charts.register
def _(paraboloid: Paraboloid) -> list[Chart]:
    frame, vertex, h = own_frame(paraboloid.axis), np.array(paraboloid.vertex), paraboloid.height
    radius = paraboloid.diameter / 2

    def profile(v: Array) -> tuple[Array, ...]:
        return radius * v, h * v * v, 2 * h * v, -radius * np.ones_like(v)

    return [revolved_chart(vertex, frame, profile), *cap_charts(frame, vertex + h * frame[1], 2 * radius, 1)]


@charts.register
def _(cone: Cone) -> list[Chart]:
    x, y, z = own_frame(cone.axis)
    frame = -x, -y, z  # in which the apex is above the base
    base, h, radius = np.array(cone.apex) + cone.height * y, cone.height, cone.diameter / 2

    def profile(v: Array) -> tuple[Array, ...]:
        one = np.ones_like(v)
        return radius * (1 - v), h * v, h * one, radius * one

    return [revolved_chart(base, frame, profile), *cap_charts(frame, base, 2 * radius, -1)]
