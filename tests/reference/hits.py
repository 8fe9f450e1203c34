"""Intersections of rays and shapes, for the reference renderer."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache, singledispatch

import numpy as np
from numpy.typing import NDArray

from minirt.shapes import Mesh, Shape
from tests.oracle import Crossed, points, size
from tests.reference.uv_mapping import normals, shading, smooth_points
from tests.reference.vectors import Array, dot, length, own_x_and_z

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
    """All distances at which lines along unit directions cross the surface of a shape, NaN for none: the oracle's."""
    origins, directions, like = origins.reshape(-1, 3), directions.reshape(-1, 3), directions.shape[:-1]
    around = np.array([*points(shape)[0], size(shape)])
    near = np.arange(len(origins)) if shape.infinite else np.flatnonzero(passes(origins, directions, around))
    found = Crossed(shape, origins[near], directions[near]).crossings() if len(near) else np.empty((1, 0))
    whole = np.full((len(found), len(origins)), np.nan)
    whole[:, near] = found
    return [each.reshape(like) for each in whole]


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
