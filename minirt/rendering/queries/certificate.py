"""Certificates of hits: how far a computed hit is from the exact surface, and how much the data's errors move it.

**Backward error** of a hit at distance t along a ray from o in the direction d: the least e such that the point
o + t d lies on a face of the shape after each face and edge was moved by at most e u M. Here u is 2^-53, and
M = t + |o - c| + size is what t is computed from: t itself, the way from the ray's origin to the first point c that
the shape is given by, and the sum of the shape's lengths and of the distances between its points. An algorithm is
backward stable if the error is a small constant, wherever the ray comes from.

**Condition number** of t: its relative change per relative change of the data. If o - c, the lengths and the distance
along d change by at most e of each, the point o + t d moves relative to the surface by at most e M, and t follows by
the implicit function theorem: from F(o + t d) = 0 comes dt = -dF / (grad F . d), a move by e M along the unit normal n
divided by n . d. So

    condition = M / (t |n . d|),    |error of t| / t <= backward error * u * condition    to first order,

which is the rule of thumb of Higham, Accuracy and Stability of Numerical Algorithms (2002), 1.6. Where a ray only
touches a surface the condition number is infinite: t then changes by the square root of a change of the data.

All this is computed with double-double numbers (`minirt.shapes.boundary`) from the numbers of the scene as they
are, with directions and axes of exactly unit length. Of a mesh the corners of the triangles count as the scene places
them, rounded. That nothing nearer was missed, a certificate does not say.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.lanes import Vec, dot, sqrt
from minirt.rendering.queries.exact_fields import ExactFields, exact_direction, exact_fields, exact_point, lengths_of
from minirt.rendering.queries.foot import foot
from minirt.shapes import ALL_KINDS, Kind, Shape

U = 2.0**-53
CHUNK = 1 << 14  # hits that are certified at once, so that their numbers stay in the processor's cache
Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Rays(NamedTuple):
    """Rays and their hits."""

    origins: Array  # (n, 3)
    directions: Array  # (n, 3) of any length
    distances: Array  # (n,) in scene units
    normals: Array  # (n, 3); where they are NaN, the nearest face counts as the one that was hit

    def some(self, indices: Integers) -> Rays:
        """Some of the rays, by their indices."""
        return Rays(*(part[indices] for part in self))


class Certificate(NamedTuple):
    """Errors and condition numbers of n hits; NaN where nothing was hit."""

    backward_error: Array  # (n,) distance of o + t d from the surface, in units of 2^-53 (t + |o - c| + size)
    condition: Array  # (n,) relative change of t per relative change of the data
    normal_error: Array  # (n,) distance of the normal from the exact one at the nearest point of the surface


def certify(shapes: tuple[Shape, ...], owners: Integers, parts: Integers, rays: Rays) -> Certificate:
    """Certify n hits: ray i hits part `parts[i]` of the shape with the index `owners[i]`, or nothing if that is -1."""
    found = Certificate(*np.full((3, len(owners)), np.nan))
    kinds = np.array([type(shape) for shape in shapes], object)
    for kind in ALL_KINDS:
        members = np.flatnonzero(kinds == kind.element)
        hits = np.flatnonzero(np.isin(owners, members))
        if not len(hits):
            continue
        fields = exact_fields(kind, [shapes[i] for i in members])
        rows = fields.first_row[np.searchsorted(members, owners[hits])] + parts[hits]
        for start in range(0, len(hits), CHUNK):
            some = hits[start : start + CHUNK]
            with np.errstate(all="ignore"):
                certificate = certify_kind(kind, fields, rows[start : start + CHUNK], rays.some(some))
            for whole, part in zip(found, certificate, strict=True):
                whole[some] = part
    return found


def certify_kind(kind: Kind, fields: ExactFields, rows: Integers, rays: Rays) -> Certificate:
    """Certify hits of shapes of one kind, each of the shape in a row of `fields`.

    The face that was hit is the one whose normal is closest to the hit's, or the nearest one where none fits.
    """
    first = fields.first_point(rows)
    magnitude = rays.distances + lengths_of(rays.origins - first) + fields.sizes[rows]
    # Scaled by a power of two all numbers are about 1, so that no product under- or overflows.
    power = -np.frexp(magnitude)[1]
    magnitude, distances = np.ldexp(magnitude, power), np.ldexp(rays.distances, power)
    d = exact_direction(rays.directions)
    point = exact_point(rays.origins, first, power) + distances * d
    shape = fields.shape(rows, first, power)
    normal = Vec(*rays.normals.T)
    nearest = foot(kind, shape, point, normal)
    slope = nearest.normal.x * d.x.high + nearest.normal.y * d.y.high + nearest.normal.z * d.z.high
    off = normal - nearest.normal
    return Certificate(
        np.fmax(nearest.distance, nearest.beyond) / (U * magnitude),
        magnitude / (distances * np.abs(slope)),
        sqrt(dot(off, off)),
    )
