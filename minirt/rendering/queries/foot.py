"""The nearest point of a shape's face to a point beside it, in double-double arithmetic."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.lanes import Vec, dot, sqrt, where
from minirt.shapes import Kind
from minirt.shapes.boundary import Boundary, DoubleDouble

STEPS = 4  # towards the foot; each adds digits, unless the face is curved as strongly as the point is far from it
SETTLED = 1e-4  # relative change of the way to the foot after which no further step is taken
FITTING = 0.5  # cosine of face and normal; at an apex, where the normal may be any of a cone, no face may fit
AXES = (Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
Array = NDArray[np.float64]


class Foot(NamedTuple):
    """The nearest point of a face."""

    distance: Array  # of the point from it
    normal: Vec  # of the face there
    beyond: Array  # the distance by which the point lies beyond the end of the face


def foot(kind: Kind, shape: Any, point: Vec, normal: Vec) -> Foot:
    """Find the nearest point of the face whose normal is closest to `normal`, of the nearest face where none fits.

    Each step linearises the face about the last foot: the next one lies on that tangent plane, straight below the
    point. Where that ends the foot is on the face, and the face's normal at the foot leads to the point.
    """
    boundary = kind.boundary(shape, seeded(point))
    amounts = [each.rounded() / sqrt(dot(each.slope, each.slope)) for each in (*boundary.faces, *boundary.limits)]
    flat = np.zeros_like(point.x.high)
    ends = [np.fmax.reduce([flat, *amounts[:i], *amounts[i + 1 :]]) for i in range(len(boundary.faces))]
    farther = [np.fmax(np.abs(amount), end) for amount, end in zip(amounts, ends, strict=False)]
    face = chosen_face(boundary, normal, np.argmin(farther, axis=0))
    beyond = np.choose(face, ends)
    way = Vec(flat, flat, flat)  # from the point to its foot
    for step in range(STEPS):
        if step:
            boundary = kind.boundary(shape, seeded(point + Vec(*map(DoubleDouble, (way.x, way.y, way.z)))))
        height, slope = height_and_slope(boundary, face)
        before, way = way, ((dot(slope, way) - height) / dot(slope, slope)) * slope
        change = way - before
        if not (dot(change, change) > SETTLED * SETTLED * dot(way, way)).any():
            break
    return Foot(sqrt(dot(way, way)), slope * (1.0 / sqrt(dot(slope, slope))), beyond)


def seeded(point: Vec) -> Vec:
    """The point, its coordinates as the variables that gradients are taken by."""
    parts = (point.x, point.y, point.z)
    return Vec(*(DoubleDouble(part.high, part.low, axis) for part, axis in zip(parts, AXES, strict=True)))


def chosen_face(boundary: Boundary, normal: Vec, nearest: NDArray[np.int64]) -> NDArray[np.int64]:
    """The index of the face whose normal is closest to `normal`, or of the nearest face where none fits."""
    slopes = [face.slope for face in boundary.faces]
    cosines = [dot(slope, normal) / sqrt(dot(slope, slope)) + 0.0 * normal.x for slope in slopes]
    chosen: NDArray[np.int64] = np.where(
        np.fmax.reduce(cosines) >= FITTING, np.argmax(np.nan_to_num(cosines, nan=-2.0), axis=0), nearest
    )
    return chosen


def height_and_slope(boundary: Boundary, face: NDArray[np.int64]) -> tuple[Array, Vec]:
    """The value and the gradient of the chosen faces."""
    height, slope = boundary.faces[0].rounded(), boundary.faces[0].slope
    for index, each in enumerate(boundary.faces[1:], 1):
        height = np.where(face == index, each.rounded(), height)
        slope = where(face == index, each.slope, slope)
    return height, slope
