"""Nearest points of exact surfaces: on a face, on the edge of two faces or at the corner of three."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.lanes import Vec, cross, dot, sqrt, where
from minirt.shapes import Kind
from minirt.shapes.boundary import DoubleDouble

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

STEPS = 4  # towards the foot; each adds digits, unless the face is curved as strongly as the point is far from it
NEARLY = 1.0 - 2.0**-20  # of the way: at an apex itself a side has no normal
SETTLED = 1e-4  # relative change of the way to the foot after which no further step is taken
AXES = (Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))


def foot(kind: Kind, shape: Any, point: Vec, normal: Vec, rounding: Array) -> tuple[Array, Vec, Array]:
    """Find the nearest points of surfaces to n points: on a face, on the edge of two or at the corner of three.

    `shape` has the exact fields of n shapes, which `ExactFields.shape` returns, and `point` exact points in their
    frame. Return the distance of each nearest point, (n,); the unit normal of the nearest face there; and the distance,
    (n,), of `normal` from that normal, or from the normal of another face within `rounding`, (n,).
    Each step linearises all faces and limits about the last foot. Where the steps settle the foot is on the surface;
    they may not settle beside an apex, where a side is curved as strongly as the point is far from it.
    """
    boundary = kind.boundary(shape, seeded(point))
    count, zero = len(boundary.faces), np.zeros_like(point.x.high)
    is_sheet = not kind.element.solid or kind.element.infinite
    way = Vec(zero, zero, zero)  # from the point to its foot
    for step in range(STEPS):
        if step:
            near = NEARLY * way
            boundary = kind.boundary(shape, seeded(point + Vec(*map(DoubleDouble, (near.x, near.y, near.z)))))
        heights, normals = linearised((*boundary.faces, *boundary.limits), NEARLY * way)
        if not step:
            # How far the point is from each face: from its plane, or beyond the planes that end the face.
            beyond = [np.fmax.reduce([zero, *heights[:i], *heights[i + 1 :]]) for i in range(count)]
            away = [np.fmax(np.abs(height), end) for height, end in zip(heights, beyond, strict=False)]
            face = np.argmin(away, axis=0)
            inside = np.fmax.reduce(heights) < 0.0
        before, way = way, way_to_surface(heights, normals, face, inside, is_sheet)
        change = way - before
        if not (dot(change, change) > SETTLED * SETTLED * dot(way, way)).any():
            break
    off = [normal - each for each in normals[:count]]
    limit = np.fmax(rounding, np.fmin.reduce(away))
    turned = [np.where(each <= limit, sqrt(dot(v, v)), np.inf) for each, v in zip(away, off, strict=True)]
    return sqrt(dot(way, way)), chosen(face, normals), np.minimum.reduce(turned)


def linearised(functions: tuple[DoubleDouble, ...], way: Vec) -> tuple[list[Array], list[Vec]]:
    """Heights of a point above the tangent planes of faces at its foot, and their unit normals."""
    steepness = [sqrt(dot(each.slope, each.slope)) for each in functions]
    normals = [each.slope / steep for each, steep in zip(functions, steepness, strict=True)]
    values = (each.rounded() / steep for each, steep in zip(functions, steepness, strict=True))
    return [value - dot(normal, way) for value, normal in zip(values, normals, strict=True)], normals


def chosen(face: Integers, normals: list[Vec]) -> Vec:
    """The normal of the chosen face of each point."""
    return Vec(*(np.choose(face, [getattr(each, axis) for each in normals]) for axis in "xyz"))


def way_to_surface(heights: list[Array], normals: list[Vec], face: Integers, inside: Any, is_sheet: bool) -> Vec:
    """The shortest way from a point to where planes bound a convex solid, or to a sheet on the first of them.

    The point lies at these `heights` above the planes, along their unit normals; it may be `inside` of the solid.
    From inside the way leads to the nearest `face`. From outside it is the longest of the shortest ways to one plane,
    to the edge of two and to the corner of three of them, of those that lead straight against a sum of their normals
    with factors that are not negative (Karush 1939; Kuhn and Tucker 1951).
    """
    best = -np.choose(face, heights) * chosen(face, normals)
    reach = np.where(inside | is_sheet, dot(best, best), -1.0)
    for size in (1, 2, 3):
        for some in combinations(range(len(heights)), size):
            if is_sheet and 0 not in some:
                continue
            way, factors = least_way([heights[i] for i in some], [normals[i] for i in some])
            free = [factor for i, factor in zip(some, factors, strict=True) if i or not is_sheet]
            longer = (is_sheet | ~inside) & (dot(way, way) > reach)
            for factor in free:
                longer &= factor >= 0.0
            best, reach = where(longer, way, best), np.where(longer, dot(way, way), reach)
    return best


def least_way(heights: list[Array], normals: list[Vec]) -> tuple[Vec, list[Array]]:
    """The shortest way from a point to where one to three planes meet, and the factors of their normals in its
    opposite. The point lies at these `heights` above the planes, along their unit normals."""
    h, n = heights, normals
    if len(h) == 1:
        return -h[0] * n[0], [h[0]]
    across = cross(n[0], n[1])  # exact to roundings even where the planes are nearly parallel
    if len(h) == 2:
        square = dot(across, across)
        way = (h[1] * cross(across, n[0]) - h[0] * cross(across, n[1])) / -square
        factors = [-dot(cross(way, n[1]), across) / square, -dot(cross(n[0], way), across) / square]
        return way, factors
    volume = dot(across, n[2])
    sides = cross(n[1], n[2]), cross(n[2], n[0]), across
    way = (h[0] * sides[0] + h[1] * sides[1] + h[2] * sides[2]) / -volume
    return way, [-dot(way, side) / volume for side in sides]


def seeded(point: Vec) -> Vec:
    """The point, its coordinates as the variables that gradients are taken by."""
    parts = (point.x, point.y, point.z)
    return Vec(*(DoubleDouble(part.high, part.low, axis) for part, axis in zip(parts, AXES, strict=True)))
