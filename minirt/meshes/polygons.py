"""Cuts the faces of a mesh into triangles: fans where a fan covers the polygon, ears elsewhere (Meisters,
Polygons Have Ears, 1975).

A polygon is seen along the coordinate axis that is nearest to the normal of its best-fitting plane. So its corners keep
their coordinates, and on which side of a line a corner lies is decided exactly.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import deque
from collections.abc import Callable
from fractions import Fraction
from math import inf

import numpy as np

from minirt.lanes import Vec, cross
from minirt.meshes.obj_lines import ObjError

ROUNDING = 2.0**-50  # error of a cross product of differences, as a share of the sum of its products
BLOCK = 2**13  # faces that are looked at together, so that they stay in the cache of a core
MOST_LOOKS = 2**25  # at corners, for the faces of a file: half a minute at worst

Point = tuple[float, float]
Ears = list[tuple[int, int, int]]


def triangulate(
    points: np.ndarray, corners: np.ndarray, sizes: np.ndarray, line_of: Callable[[int], int]
) -> np.ndarray:
    """Cut faces of `sizes` corners into triangles: indices of the triangles' corners among all corners, (m, 3).

    `points` is (n, 3), and `corners` (c,) are the indices of the points of all corners. The triangles of a face go
    round as the face does. They are a fan around its first corner where that covers the polygon and nothing else, as it
    does every convex one. Other polygons are cut into ears. A polygon that crosses itself may leave no ear to cut; it
    becomes a fan. ObjError, with the line of the face that `line_of` returns, if the faces take too long together.
    """
    triangles, looks = fan_triangulation(sizes), MOST_LOOKS
    many, first = np.flatnonzero(sizes > 3), np.cumsum(sizes) - sizes
    for start in range(0, len(many), BLOCK):
        some = many[start : start + BLOCK]
        *plane, are_fans = planes_of(points, corners, first[some], sizes[some])
        for face, axis, is_turned in np.stack([some, *plane], axis=1)[~are_fans].tolist():
            u, v = (axis + 1) % 3, (axis + 2) % 3  # the axes beside that along which the polygon is seen
            if is_turned:
                u, v = v, u
            flat = [(point[u], point[v]) for point in points[corners[first[face] :][: sizes[face]]].tolist()]
            if is_covered_by_fan(flat):
                continue
            polygon = Polygon(flat, looks)
            ears, looks = polygon.cut(), polygon.looks
            if looks < 0:
                message = f"a face of {sizes[face]:,} corners takes too long to cut into triangles"
                raise ObjError(message, line_of(face))
            if ears:
                place = first[face] - 2 * face  # each face before it has two triangles less than corners
                triangles[place : place + len(ears)] = first[face] + np.array(ears)
    return triangles


def fan_triangulation(sizes: np.ndarray) -> np.ndarray:
    """Triangulate faces of `sizes` corners as fans: indices of the triangles' corners among all corners, (m, 3)."""
    triangles = sizes - 2
    first = np.repeat(np.cumsum(sizes) - sizes, triangles)
    step = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def planes_of(
    points: np.ndarray, corners: np.ndarray, first: np.ndarray, sizes: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the axis along which polygons are seen, whether it points away from them, and whether a fan covers them.

    All three are (m,). `first` (m,) are the places of the polygons' first corners in `corners`, `sizes` (m,) how many
    corners they have. A fan covers polygons that are convex for certain: seen from the first corner each corner lies to
    the left of the corner before. Polygons without an area count as covered, too.
    """
    starts = np.cumsum(sizes) - sizes  # of the polygons in the arrays below
    spokes = points[corners[np.repeat(first - starts, sizes) + np.arange(sizes.sum())]].T.copy()
    spokes -= np.repeat(spokes[:, starts], sizes, axis=1)
    following = np.roll(spokes, -1, axis=1)
    following[:, starts + sizes - 1] = 0.0
    across = cross(Vec(*spokes), Vec(*following))
    normals = np.stack([np.add.reduceat(part, starts) for part in (across.x, across.y, across.z)])
    axes = np.abs(normals).argmax(axis=0)
    turned = normals[axes, np.arange(len(axes))] < 0
    x, y = seen(spokes, np.repeat(axes, sizes), np.repeat(turned, sizes))
    u, v = seen(following, np.repeat(axes, sizes), np.repeat(turned, sizes))
    first_x, first_y = np.repeat(x[starts + 1], sizes), np.repeat(y[starts + 1], sizes)
    left = is_left(x, y, u, v)
    x[starts + 1] = y[starts + 1] = 0.0  # the first edge, of which no sum of products is certain to be 0
    left &= is_left(first_x, first_y, x, y)
    return axes, turned, np.logical_and.reduceat(left, starts) | ~normals.any(axis=0)


def seen(points: np.ndarray, axes: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinates of points (3, n) beside those on `axes`, in the order of a counter-clockwise polygon."""
    x, y = np.choose((axes + 1) % 3, points), np.choose((axes + 2) % 3, points)
    return np.where(turned, y, x), np.where(turned, x, y)


def is_left(x: np.ndarray, y: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Whether the direction (u, v) lies to the left of (x, y), or along it, for certain."""
    one, other = x * v, y * u
    certain: np.ndarray = one - other >= ROUNDING * (np.abs(one) + np.abs(other))
    return certain


def is_covered_by_fan(points: list[Point]) -> bool:
    """Whether the fan around the first corner covers a polygon: no triangle is turned over, none overlap."""
    centre, first = points[:2]
    beyond = False  # whether a corner lay to the right of the first edge
    for point, following in zip(points[2:], [*points[3:], centre], strict=True):
        side = orientation(centre, first, point)
        if (beyond and side >= 0) or orientation(centre, point, following) < 0:
            return False
        beyond |= side < 0
    return orientation(centre, first, points[2]) >= 0


class Polygon:
    """A polygon that goes round counter-clockwise, from which ears are cut: triangles of three corners in a row that
    contain no other corner.

    No ear is turned over, and so they cover each point as often as the polygon goes round it. Of the corners only those
    at which the polygon is not convex are looked at: a triangle that contains others contains one of them. They are
    sorted by x, so that most triangles meet few.
    """

    def __init__(self, points: list[Point], looks: int) -> None:
        count = len(points)
        self.points = points
        self.looks = looks  # at corners that are left; the polygon takes too long to cut where it is negative
        self.before = [count - 1, *range(count - 1)]
        self.after = [*range(1, count), 0]
        self.is_left = [True] * count
        self.reflex = sorted((*points[corner], corner) for corner in range(count) if self.turn(corner) <= 0)

    def cut(self) -> Ears | None:
        """Cut all ears, and return the indices of the corners of the triangles; None where no ear is left to cut.

        It is done once: the polygon is used up, and `looks` has become less.
        """
        triangles: Ears = []
        waiting, remaining = deque(range(len(self.points))), len(self.points)
        refused = 0  # times that no corner in the queue could be cut
        while remaining > 3:
            if not waiting:
                waiting.extend(corner for corner, is_left in enumerate(self.is_left) if is_left)
                refused += 1
                if refused > 3 or self.looks < 0:
                    return None
            corner = waiting.popleft()
            # Corners on a straight line make no triangle. They wait until there is nothing else to cut.
            if not self.is_left[corner] or not (self.is_ear(corner) or (refused > 1 and self.turn(corner) == 0)):
                continue
            before, after = self.before[corner], self.after[corner]
            triangles.append((before, corner, after))
            self.is_left[corner] = False
            self.after[before], self.before[after] = after, before
            self.forget(corner)
            for each in (before, after):
                if self.turn(each) > 0:
                    self.forget(each)
                waiting.append(each)  # cutting an ear makes or unmakes ears beside it only
            remaining, refused = remaining - 1, 0
        last = self.is_left.index(True)
        triangles.append((self.before[last], last, self.after[last]))
        return triangles if self.turn(last) >= 0 else None

    def turn(self, corner: int) -> int:
        """The sign of the turn at a corner: 1 to the left, where the polygon is convex."""
        return orientation(self.points[self.before[corner]], self.points[corner], self.points[self.after[corner]])

    def forget(self, corner: int) -> None:
        """Look at a corner no more: it is cut off, or the polygon has become convex there."""
        entry = *self.points[corner], corner
        place = bisect_left(self.reflex, entry)
        if self.reflex[place : place + 1] == [entry]:
            del self.reflex[place]

    def is_ear(self, corner: int) -> bool:
        """Whether the triangle of a corner and its neighbours can be cut off; not once there are no looks left."""
        if self.looks < 0 or self.turn(corner) <= 0:
            return False
        ends = a, b, c = [self.points[each] for each in (self.before[corner], corner, self.after[corner])]
        (left, right), (low, high) = ((min(parts), max(parts)) for parts in zip(a, b, c, strict=True))
        near = self.reflex[bisect_left(self.reflex, (left,)) : bisect_left(self.reflex, (right, inf))]
        self.looks -= len(near)
        return not any(
            orientation(a, b, point) >= 0 and orientation(b, c, point) >= 0 and orientation(c, a, point) >= 0
            for point in ((x, y) for x, y, _ in near if low <= y <= high)
            if point not in ends
        )


def orientation(a: Point, b: Point, c: Point) -> int:
    """The sign of the area of a triangle, exactly: 1 if it goes round counter-clockwise, 0 if it is a line."""
    one, other = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    area = one - other
    if abs(area) <= ROUNDING * (abs(one) + abs(other)):
        (u, v), (x, y), (z, w) = (map(Fraction, point) for point in (a, b, c))
        exact = (x - u) * (w - v) - (y - v) * (z - u)
        return (exact > 0) - (exact < 0)
    return 1 if area > 0 else -1
