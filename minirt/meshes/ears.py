"""Ear clipping: cuts a concave polygon into triangles (Meisters, Polygons Have Ears, 1975)."""

from __future__ import annotations

from collections import deque
from fractions import Fraction

import numpy as np

ROUNDING = 2.0**-50  # error of a cross product of differences, as a share of the sum of its products

MOST_LOOKS = 2**30  # at corners, for the faces of a file: several seconds

Point = tuple[float, float]
Points = Point | tuple[np.ndarray, np.ndarray]


class TooComplexError(Exception):
    """A polygon that takes too long to cut."""


class Effort:
    """Looks at corners that are left for the faces of a file."""

    def __init__(self) -> None:
        self.left = MOST_LOOKS

    def spend(self, looks: int) -> None:
        """Count looks at corners; TooComplexError when none are left."""
        self.left -= looks
        if self.left < 0:
            raise TooComplexError


def cut_polygon(x: np.ndarray, y: np.ndarray, effort: Effort) -> np.ndarray | None:
    """Cut a polygon that goes round counter-clockwise into triangles: indices of their corners, (n - 2, 3).

    None where a fan around the first corner covers the polygon, and where a polygon that crosses itself leaves no ear.
    TooComplexError.
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
