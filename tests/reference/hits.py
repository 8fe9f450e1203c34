"""Intersections of rays and shapes, for the reference renderer."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache, singledispatch

import numpy as np
from numpy.typing import NDArray

from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.mesh import Mesh
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.reference.uv_mapping import normals, right_and_up_on, scaled_axes, shading, smooth_points
from tests.reference.vectors import Array, dot, length, own_x_and_z, profile

SAME_SURFACE = 1e-10  # relative difference of distances below which two surfaces count as coincident


def first_hits(shapes: Iterable[Shape], origins: Array, directions: Array) -> tuple[Array, NDArray[np.int64]]:
    """The distance of each ray's first hit and the index of the shape that is hit, or infinity and -1.

    Of coincident surfaces the earlier one is hit.
    """
    nearest = np.full(directions.shape[:-1], np.inf)
    owners = np.full(nearest.shape, -1)
    for index, shape in enumerate(shapes):
        distance = first_in_front(shape, origins, directions)
        closer = distance < nearest * (1 - SAME_SURFACE)
        nearest[closer] = distance[closer]
        owners[closer] = index
    return nearest, owners


def first_in_front(shape: Shape, origins: Array, directions: Array) -> Array:
    """The least distance > 0 at which a shape is hit, or infinity."""
    with np.errstate(invalid="ignore"):
        return np.min([np.where(t > 0, t, np.inf) for t in crossings(shape, origins, directions)], axis=0)


@singledispatch
def crossings(shape: Shape, origins: Array, directions: Array) -> list[Array]:
    """All distances at which lines along unit directions cross the surface of a shape, NaN for none."""
    raise TypeError(f"the reference renderer knows no {shape.title}")


@crossings.register(Plane)
def _(plane: Plane, origins: Array, directions: Array) -> list[Array]:
    return [to_plane(np.array(plane.point), np.array(plane.normal), origins, directions)]


@crossings.register(Sphere)
def _(sphere: Sphere, origins: Array, directions: Array) -> list[Array]:
    to_centre = np.array(sphere.centre) - origins
    off_centre = length(np.cross(to_centre, directions))
    return chord(*around(dot(to_centre, directions), half_chord(sphere.diameter / 2, off_centre)))


@crossings.register(Ellipsoid)
def _(ellipsoid: Ellipsoid, origins: Array, directions: Array) -> list[Array]:
    # In its own frame, scaled by its semi-axes, it is the unit sphere.
    axes = scaled_axes(ellipsoid)
    to_centre, along = (np.array(ellipsoid.centre) - origins) @ axes.T, directions @ axes.T
    speed = length(along)
    along = along / speed[..., None]
    off_centre = length(np.cross(to_centre, along))
    return [t / speed for t in chord(*around(dot(to_centre, along), half_chord(1.0, off_centre)))]


@crossings.register(Cylinder)
def _(cylinder: Cylinder, origins: Array, directions: Array) -> list[Array]:
    axis, radius = np.array(cylinder.axis), cylinder.diameter / 2
    to_centre = np.array(cylinder.centre) - origins
    # Along the axis: the slab between the caps.
    along, slope = dot(to_centre, axis), dot(directions, axis)
    slab_enter, slab_leave = slab(along, slope, cylinder.height / 2)
    # Across the axis: a circle in the plane, at the speed |across|.
    across, centre_across = directions - slope[..., None] * axis, to_centre - along[..., None] * axis
    speed = length(across)
    with np.errstate(divide="ignore", invalid="ignore"):
        off_axis = np.abs(dot(np.cross(centre_across, across), axis)) / speed
        tube_middle, tube_half = dot(centre_across, across) / speed**2, half_chord(radius, off_axis) / speed
    parallel = speed == 0
    within = np.where(length(centre_across) <= radius, np.inf, np.nan)
    tube_enter, tube_leave = around(np.where(parallel, 0.0, tube_middle), np.where(parallel, within, tube_half))
    return chord(np.maximum(slab_enter, tube_enter), np.minimum(slab_leave, tube_leave))


@crossings.register(Box)
def _(box: Box, origins: Array, directions: Array) -> list[Array]:
    x, z = own_x_and_z(np.array(box.axis), box.roll)
    y = np.cross(z, x)
    to_centre = np.array(box.centre) - origins
    slabs = [
        slab(dot(to_centre, axis), dot(directions, axis), size / 2)
        for axis, size in zip((x, y, z), box.sizes, strict=True)
    ]
    return chord(np.max([enter for enter, _ in slabs], axis=0), np.min([leave for _, leave in slabs], axis=0))


@crossings.register(Cone)
@crossings.register(Paraboloid)
@crossings.register(Hyperboloid)
def _(shape: Cone | Paraboloid | Hyperboloid, origins: Array, directions: Array) -> list[Array]:
    # Along the ray the height and the squared distance from the axis are polynomials.
    form = profile(shape)
    start = dot(form.origin - origins, directions)[..., None]  # where the ray is nearest to the origin of the profile
    p = origins + start * directions - form.origin
    height, slope = dot(p, form.axis), dot(directions, form.axis)
    a = 1 - slope**2 - form.two * slope**2
    b = dot(p, directions) - height * slope - form.one * slope / 2 - form.two * height * slope
    c = dot(p, p) - height**2 - form.at(height)
    found = []
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        for t in (np.where(a == 0, -c / (2 * b), q / a), c / q):
            at = height + t * slope
            found.append(np.where((form.low <= at) & (at <= form.high), t, np.nan))
        for end in (form.low, form.high):
            t = (end - height) / slope
            on_cap = p + t[..., None] * directions - end * form.axis
            found.append(np.where(dot(on_cap, on_cap) <= form.at(end), t, np.nan))
    return [start[..., 0] + t for t in found]


@crossings.register(Torus)
def _(torus: Torus, origins: Array, directions: Array) -> list[Array]:
    # (p.p + R^2 - r^2)^2 = 4 R^2 (p.p - h^2) along the ray, about the point nearest to the centre; where the ray
    # passes the ball around the torus its four roots are eigenvalues of the companion matrix.
    axis, big, small = np.array(torus.axis), torus.diameter / 2, torus.tube / 2
    start = dot(np.array(torus.centre) - origins, directions)[..., None]
    p = origins + start * directions - np.array(torus.centre)
    near = length(p) < big + small
    p, way = p[near], directions[near]
    height, slope = dot(p, axis), dot(way, axis)
    inner = dot(p, p) + big**2 - small**2
    coefficients = [
        inner**2 - 4 * big**2 * (dot(p, p) - height**2),
        8 * big**2 * height * slope,
        2 * inner - 4 * big**2 * (1 - slope**2),
        np.zeros(len(p)),
    ]
    companion = np.zeros((len(p), 4, 4))
    companion[:, 1:, :3] = np.eye(3)
    companion[:, :, 3] = -np.stack(coefficients, axis=-1)
    roots = np.linalg.eigvals(companion)
    found = np.full((4, *near.shape), np.nan)
    for root, t in zip(roots.T, found, strict=True):
        t[near] = np.where(np.abs(root.imag) < 1e-6 * (big + small), root.real, np.nan) + start[near, 0]
    return list(found)


@crossings.register(Square)
@crossings.register(Disc)
def _(sheet: Square | Disc, origins: Array, directions: Array) -> list[Array]:
    centre, normal = np.array(sheet.centre), np.array(sheet.normal)
    t = to_plane(centre, normal, origins, directions)
    with np.errstate(invalid="ignore"):
        p = origins + t[..., None] * directions - centre
        if isinstance(sheet, Disc):
            inside = length(p) <= sheet.diameter / 2
        else:
            inside = np.max([np.abs(dot(p, edge)) for edge in right_and_up_on(sheet)], axis=0) <= sheet.side / 2
    return [np.where(inside, t, np.nan)]


@crossings.register(Triangle)
def _(triangle: Triangle, origins: Array, directions: Array) -> list[Array]:
    corners = [np.array(corner) for corner in (triangle.a, triangle.b, triangle.c)]
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    t = to_plane(corners[0], normal, origins, directions)
    with np.errstate(invalid="ignore"):
        p = origins + t[..., None] * directions
        inside = np.all(
            [dot(np.cross(b - a, p - a), normal) >= 0 for a, b in zip(corners, corners[1:] + corners[:1], strict=True)],
            axis=0,
        )
    return [np.where(inside, t, np.nan)]


def to_plane(point: Array, normal: Array, origins: Array, directions: Array) -> Array:
    """The distance to a plane, NaN for a parallel ray."""
    above, rise = dot(origins - point, normal), dot(directions, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(rise == 0, np.nan, -above / rise)


def slab(along: Array, slope: Array, half: float) -> tuple[Array, Array]:
    """The t at which lines enter and leave the slab between two planes whose middle is `along` away."""
    with np.errstate(divide="ignore", invalid="ignore"):
        middle, across = along / slope, half / np.abs(slope)
    level = slope == 0
    within = np.where(np.abs(along) <= half, np.inf, np.nan)
    return around(np.where(level, 0.0, middle), np.where(level, within, across))


def chord(enter: Array, leave: Array) -> list[Array]:
    """The crossings of a line that is in a convex solid from `enter` to `leave`; NaN for an empty interval."""
    with np.errstate(invalid="ignore"):
        there = enter <= leave
    return [np.where(there, enter, np.nan), np.where(there, leave, np.nan)]


def half_chord(radius: float, off_centre: Array) -> Array:
    """Half the length of the chord of a circle at a distance from its centre; NaN beyond the circle."""
    with np.errstate(invalid="ignore"):
        return np.sqrt((radius - off_centre) * (radius + off_centre))


def around(middle: Array, half: Array) -> tuple[Array, Array]:
    """The interval with this middle and half length."""
    return middle - half, middle + half


EDGE = 1e-12  # tolerance of barycentric coordinates, so that neighbours have no gap


@lru_cache(4)
def corners_and_balls(mesh: Mesh) -> tuple[Array, Array]:
    """Corners of the triangles, (m, 3, 3), and a bounding ball of each, (m, 4)."""
    corners = np.array(mesh.position) + mesh.scale * mesh.triangles.points[mesh.triangles.corners] @ own_axes(mesh)
    middles = corners.mean(axis=1)
    radii = length(corners - middles[:, None]).max(axis=1)
    return corners, np.concatenate([middles, 1.001 * radii[:, None]], axis=1)


def own_axes(mesh: Mesh) -> Array:
    """The own x, y and z axes of a mesh, as the rows of a matrix."""
    y = np.array(mesh.axis)
    x, z = own_x_and_z(y, mesh.roll)
    return np.stack([x, y, z])


@crossings.register
def _(mesh: Mesh, origins: Array, directions: Array) -> list[Array]:
    shape = directions.shape[:-1]
    origins, directions = np.broadcast_to(origins, directions.shape).reshape(-1, 3), directions.reshape(-1, 3)
    nearest = np.full(len(directions), np.inf)
    corners, balls = corners_and_balls(mesh)
    lines = np.flatnonzero(passes(origins, directions, ball_of(balls)))
    starts, towards = origins[lines], directions[lines]
    for (a, b, c), ball in zip(corners, balls, strict=True):
        near = np.flatnonzero(passes(starts, towards, ball))
        t, u, v = intersect_triangle(starts[near], towards[near], a, b, c)
        hit = (np.minimum(np.minimum(u, v), 1 - u - v) >= -EDGE) & (t > 0)
        nearest[lines[near[hit]]] = np.minimum(nearest[lines[near[hit]]], t[hit])
    return [np.where(np.isfinite(nearest), nearest, np.nan).reshape(shape)]


def ball_of(balls: Array) -> Array:
    """A bounding ball of balls."""
    middle = balls[:, :3].mean(axis=0)
    return np.array([*middle, (length(balls[:, :3] - middle) + balls[:, 3]).max()])


def passes(origins: Array, directions: Array, ball: Array) -> np.ndarray:
    """Whether lines pass through a ball."""
    to = ball[:3] - origins
    return np.asarray(dot(to, to) - dot(to, directions) ** 2 <= ball[3] ** 2 * (1 + 1e-9))


def intersect_triangle(origins: Array, directions: Array, a: Array, b: Array, c: Array) -> tuple[Array, Array, Array]:
    """Intersect lines with the plane of a triangle: distances, and barycentric coordinates of b and c."""
    p, from_a = np.cross(directions, c - a), origins - a
    determinant, q = p @ (b - a), np.cross(from_a, b - a)
    with np.errstate(all="ignore"):
        return q @ (c - a) / determinant, dot(from_a, p) / determinant, dot(directions, q) / determinant


def triangle_of(mesh: Mesh, points: Array) -> np.ndarray:
    """The index of the triangle that each point of the surface lies on."""
    corners, balls = corners_and_balls(mesh)
    best, owner = np.full(len(points), np.inf), np.zeros(len(points), np.int64)
    for i, ((a, b, c), ball) in enumerate(zip(corners, balls, strict=True)):
        near = np.flatnonzero(length(points - ball[:3]) <= ball[3])
        out = np.cross(b - a, c - a)
        t, u, v = intersect_triangle(points[near], np.broadcast_to(out / length(out), (len(near), 3)), a, b, c)
        outside = np.maximum(0, -np.minimum(np.minimum(u, v), 1 - u - v)) * ball[3]
        off = np.abs(t) + outside
        closer = off < best[near]
        best[near[closer]], owner[near[closer]] = off[closer], i
    return owner


@normals.register
def _(mesh: Mesh, points: Array) -> Array:
    a, b, c = corners_and_balls(mesh)[0][triangle_of(mesh, points)].transpose(1, 0, 2)
    out = np.cross(b - a, c - a)
    return out / length(out)[:, None]


@shading.register
def _(mesh: Mesh, points: Array, normal: Array) -> Array:
    corner_normals = mesh.triangles.normals
    if corner_normals is None:
        return normal
    owner = triangle_of(mesh, points)
    normals_there = corner_normals[owner] @ own_axes(mesh)
    blended = np.einsum("ij,ijk->ik", shares_of_corners(mesh, owner, points), normals_there)
    return blended / length(blended)[:, None]


def shares_of_corners(mesh: Mesh, owner: np.ndarray, points: Array) -> Array:
    """The barycentric coordinates of points on triangles, (n, 3)."""
    a, b, c = corners_and_balls(mesh)[0][owner].transpose(1, 0, 2)
    out = np.cross(b - a, c - a)
    of_b, of_c = dot(np.cross(points - a, c - a), out), dot(np.cross(b - a, points - a), out)
    of_b, of_c = of_b / dot(out, out), of_c / dot(out, out)
    return np.stack([1 - of_b - of_c, of_b, of_c], axis=1)


@smooth_points.register
def _(mesh: Mesh, points: Array, facing: Array) -> Array:
    corner_normals = mesh.triangles.normals
    if corner_normals is None:
        return points
    owner = triangle_of(mesh, points)
    corners = corners_and_balls(mesh)[0][owner]
    outward = corner_normals[owner] @ own_axes(mesh)
    a, b, c = corners.transpose(1, 0, 2)
    out = np.cross(b - a, c - a)
    out *= np.sign(dot(out, outward.sum(axis=1)))[:, None]
    outward = outward * np.sign(dot(out, facing))[:, None, None]
    # The mean of the projections onto the tangent planes of the corners; a point above one of them stays.
    above = np.einsum("ijk,ijk->ij", points[:, None] - corners, outward)
    projected = points[:, None] - np.minimum(above, 0)[..., None] * outward
    return np.asarray(np.einsum("ij,ijk->ik", shares_of_corners(mesh, owner, points), projected))
