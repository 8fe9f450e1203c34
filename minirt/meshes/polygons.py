"""Cuts the faces of a mesh into triangles: fans where a fan covers the polygon, ears elsewhere.

A polygon is seen along the coordinate axis that is nearest to the normal of its best-fitting plane. So its corners keep
their coordinates, and on which side of a line a corner lies is decided exactly.
"""

from __future__ import annotations

import numpy as np

from minirt.meshes.ears import Effort, TooComplexError, cut_polygon, is_right

__all__ = ["FaceError", "triangulate"]

ROUNDING = 2.0**-50  # error of a cross product of differences, as a share of the sum of its products
TWO_EARS = ((3, 0, 1), (3, 1, 2))  # as ear clipping cuts a concave quadrangle that no fan covers


class FaceError(Exception):
    """A face that takes too long to cut into triangles: its index."""

    def __init__(self, face: int) -> None:
        super().__init__(face)
        self.face = face


def triangulate(points: np.ndarray, corners: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Cut faces of `sizes` corners into triangles: indices of the triangles' corners among all corners, (m, 3).

    `corners` (c,) are the points of all corners. The triangles of a face go round as the face does. They are a fan
    around its first corner where that covers the polygon and nothing else, as it does every convex one. Other polygons
    are cut into ears. A polygon that crosses itself may leave no ear to cut; it becomes a fan. FaceError.
    """
    triangles, effort = fan_triangulation(sizes), Effort()
    many = np.flatnonzero(sizes > 3)
    if len(many):
        first = np.cumsum(sizes) - sizes
        many = many[~are_covered_by_fans(points, corners, first[many], sizes[many])]
        quads = many[sizes[many] == 4]
        are_fans, have_ears = certain_cuts(points, corners, first[quads])
        cut = quads[have_ears]
        for triangle, ear in enumerate(TWO_EARS):
            triangles[first[cut] - 2 * cut + triangle] = first[cut, None] + ear
        for face in np.setdiff1d(many, quads[are_fans | have_ears]).tolist():
            polygon = points[corners[first[face] : first[face] + sizes[face]]]
            spokes = polygon - polygon[0]
            normal = np.cross(spokes[:-1], spokes[1:]).sum(axis=0)
            axes, turned = seen_along(normal[None])
            x, y = seen(polygon, np.repeat(axes, len(polygon)), np.repeat(turned, len(polygon)))
            try:
                ears = cut_polygon(x, y, effort)
            except TooComplexError:
                raise FaceError(face) from None
            if ears is not None:
                start = first[face] - 2 * face
                triangles[start : start + len(ears)] = first[face] + ears
    return triangles


def fan_triangulation(sizes: np.ndarray) -> np.ndarray:
    """Triangulate faces of `sizes` corners as fans: indices of the triangles' corners among all corners, (m, 3)."""
    triangles = sizes - 2
    first = np.repeat(np.cumsum(sizes) - sizes, triangles)
    step = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def are_covered_by_fans(points: np.ndarray, corners: np.ndarray, first: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Whether a polygon is convex for certain, so that a fan covers it; True also for polygons without an area.

    Seen from the first corner, which is convex, each corner lies to the left of the corner before.
    """
    starts = np.cumsum(sizes) - sizes
    spokes = points[corners[np.repeat(first - starts, sizes) + np.arange(sizes.sum())]]
    spokes = spokes - np.repeat(spokes[starts], sizes, axis=0)
    following = np.roll(spokes, -1, axis=0)
    following[starts + sizes - 1] = 0.0
    normals = np.add.reduceat(np.cross(spokes, following), starts)
    axes, turned = seen_along(normals)
    x, y = seen(spokes, np.repeat(axes, sizes), np.repeat(turned, sizes))
    u, v = seen(following, np.repeat(axes, sizes), np.repeat(turned, sizes))
    first_x, first_y = np.repeat(x[starts + 1], sizes), np.repeat(y[starts + 1], sizes)
    left = is_left(x, y, u, v) & is_left(first_x, first_y, x, y)
    return np.logical_and.reduceat(left, starts) | ~normals.any(axis=1)


def certain_cuts(points: np.ndarray, corners: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether ear clipping leaves quadrangles a fan, and whether it cuts them into `TWO_EARS`, each for certain.

    This takes 1 us each, and ear clipping 200.
    """
    polygons = points[corners[first[:, None] + np.arange(4)]]
    spokes = polygons - polygons[:, :1]
    axes, turned = seen_along(np.cross(spokes[:, :-1], spokes[:, 1:]).sum(axis=1))
    x, y = (each.reshape(-1, 4).T for each in seen(polygons.reshape(-1, 3), np.repeat(axes, 4), np.repeat(turned, 4)))
    a, b, c, d = zip(x, y, strict=True)
    are_fans: np.ndarray = is_right(b, a, *c) & is_right(c, a, *d)
    is_turned_over = is_right(a, b, *c) | is_right(a, c, *d)
    have_ears: np.ndarray = is_turned_over & is_right(a, d, *b) & is_right(b, d, *c)
    return are_fans, have_ears


def seen_along(normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis along which polygons with these normals are seen, and whether it points away from them."""
    axes = np.abs(normals).argmax(axis=1)
    return axes, normals[np.arange(len(normals)), axes] < 0


def seen(points: np.ndarray, axes: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the two other coordinates of points, in the order in which a polygon goes round counter-clockwise."""
    rows = np.arange(len(points))
    x, y = points[rows, (axes + 1) % 3], points[rows, (axes + 2) % 3]
    return np.where(turned, y, x), np.where(turned, x, y)


def is_left(x: np.ndarray, y: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Whether the direction (u, v) lies to the left of (x, y), or along it, for certain."""
    one, other = x * v, y * u
    certain: np.ndarray = one - other >= ROUNDING * (np.abs(one) + np.abs(other))
    return certain
