"""Cuts the faces of a mesh into triangles: fans where a fan covers the polygon, ears elsewhere (Meisters,
Polygons Have Ears, 1975).

A polygon is seen along the coordinate axis that is nearest to the normal of its best-fitting plane. So its corners keep
their coordinates, and on which side of a line a corner lies is decided exactly.
"""

from __future__ import annotations

from collections import deque
from fractions import Fraction

import numpy as np

ROUNDING = 2.0**-50  # error of a cross product of differences, as a share of the sum of its products
MOST_LOOKS = 2**30  # at corners, for the faces of a file: several seconds
TWO_EARS = ((3, 0, 1), (3, 1, 2))  # as ear clipping cuts a concave quadrangle that no fan covers

Point = tuple[float, float]
Points = Point | tuple[np.ndarray, np.ndarray]


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
            effort.face = face
            ears = cut_polygon(x, y, effort)
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


class Effort:
    """Looks at corners that are left for the faces of a file, and the face that is cut."""

    def __init__(self) -> None:
        self.left, self.face = MOST_LOOKS, 0

    def spend(self, looks: int) -> None:
        """Count looks at corners; FaceError when none are left."""
        self.left -= looks
        if self.left < 0:
            raise FaceError(self.face)


def cut_polygon(x: np.ndarray, y: np.ndarray, effort: Effort) -> np.ndarray | None:
    """Cut a polygon that goes round counter-clockwise into triangles: indices of their corners, (n - 2, 3).

    None where a fan around the first corner covers the polygon, and where a polygon that crosses itself leaves no ear.
    FaceError.
    """
    return None if is_covered_by_fan(list(zip(x.tolist(), y.tolist(), strict=True))) else Polygon(x, y, effort).cut()


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
    """A polygon from which ears are cut: triangles of three corners in a row that contain no other corner.

    No ear is turned over, and so they cover each point as often as the polygon goes round it. Of the corners only those
    at which the polygon is not convex are looked at: a triangle that contains others contains one of them. They are
    sorted by x, so that most triangles meet few.
    """

    def __init__(self, x: np.ndarray, y: np.ndarray, effort: Effort) -> None:
        count, self.effort = len(x), effort
        self.points = list(zip(x.tolist(), y.tolist(), strict=True))
        self.before = [count - 1, *range(count - 1)]
        self.after = [*range(1, count), 0]
        self.is_left = [True] * count
        reflex = np.flatnonzero([self.turn(corner) <= 0 for corner in range(count)])
        self.reflex = reflex[np.argsort(x[reflex], kind="stable")]
        self.x, self.y = x[self.reflex], y[self.reflex]
        self.is_reflex = np.ones(len(reflex), bool)
        self.places = {corner: place for place, corner in enumerate(self.reflex.tolist())}

    def cut(self) -> np.ndarray | None:
        """Cut all ears: indices of the corners of triangles; None where no ear is left to cut."""
        triangles = []
        waiting, remaining = deque(range(len(self.points))), len(self.points)
        refused = 0  # times that no corner in the queue could be cut
        while remaining > 3:
            if not waiting:
                waiting.extend(corner for corner, is_left in enumerate(self.is_left) if is_left)
                refused += 1
                if refused > 3:
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
                if each in self.places and self.turn(each) > 0:
                    self.forget(each)
                waiting.append(each)  # cutting an ear makes or unmakes ears beside it only
            remaining, refused = remaining - 1, 0
        last = self.is_left.index(True)
        triangles.append((self.before[last], last, self.after[last]))
        return np.array(triangles) if self.turn(last) >= 0 else None

    def turn(self, corner: int) -> int:
        """The sign of the turn at a corner: 1 to the left, where the polygon is convex."""
        return orientation(self.points[self.before[corner]], self.points[corner], self.points[self.after[corner]])

    def forget(self, corner: int) -> None:
        """Look at a corner no more: it is cut off, or the polygon has become convex there."""
        place = self.places.pop(corner, None)
        if place is not None:
            self.is_reflex[place] = False

    def is_ear(self, corner: int) -> bool:
        """Whether the triangle of a corner and its neighbours can be cut off."""
        if self.turn(corner) <= 0:
            return False
        a, b, c = (self.points[each] for each in (self.before[corner], corner, self.after[corner]))
        (left, right), (low, high) = ((min(parts), max(parts)) for parts in zip(a, b, c, strict=True))
        start, end = np.searchsorted(self.x, left), np.searchsorted(self.x, right, side="right")
        self.effort.spend(int(end - start))
        y = self.y[start:end]
        near = start + np.flatnonzero(self.is_reflex[start:end] & (y >= low) & (y <= high))
        for one, other in ((a, b), (b, c), (c, a)):
            near = near[~is_right(one, other, self.x[near], self.y[near])]
        for point in map(self.points.__getitem__, self.reflex[near].tolist()):
            if point in (a, b, c):
                continue
            if min(orientation(a, b, point), orientation(b, c, point), orientation(c, a, point)) >= 0:
                return False
        return True


def is_right(a: Points, b: Points, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether points lie to the right of the line from a to b for certain; a and b may be one for each point."""
    one, other = (b[0] - a[0]) * (y - a[1]), (b[1] - a[1]) * (x - a[0])
    certain: np.ndarray = other - one > ROUNDING * (np.abs(one) + np.abs(other))
    return certain


def orientation(a: Point, b: Point, c: Point) -> int:
    """The sign of the area of a triangle, exactly: 1 if it goes round counter-clockwise, 0 if it is a line."""
    one, other = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    area = one - other
    if abs(area) <= ROUNDING * (abs(one) + abs(other)):
        (u, v), (x, y), (z, w) = (map(Fraction, point) for point in (a, b, c))
        exact = (x - u) * (w - v) - (y - v) * (z - u)
        return (exact > 0) - (exact < 0)
    return 1 if area > 0 else -1
