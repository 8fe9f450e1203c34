"""Translate and rotate single elements."""

from __future__ import annotations

from math import atan2, cos, degrees, dist, fsum, radians, sin
from typing import Any, TypeVar

from minirt.element import Element
from minirt.fields import FARTHEST, Direction, Point, Triple, clamp, unit
from minirt.scene.elements import linear_combination
from minirt.shapes.shape import Oriented
from minirt.viewer.editing.projection import dot, field_names, subtract
from minirt.viewer.editing.values import NOISE, neat_direction, shows_roll

Moved = TypeVar("Moved", bound=Element)


def translate(element: Moved, axis: Triple, distance: float) -> tuple[Moved, bool]:
    """Move all points of an element along `axis`, clamped to the format's range. Returns whether it was clamped."""
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    if not points:
        return element, False
    offset = [distance * part for part in axis]
    limits = ((-FARTHEST - min(each), FARTHEST - max(each)) for each in zip(*points.values(), strict=True))
    x, y, z = (clamp(part, *limit) for part, limit in zip(offset, limits, strict=True))
    moved = {name: clamp_point(linear_combination(1.0, point, 1.0, (x, y, z))) for name, point in points.items()}
    return element.replace(**moved), [x, y, z] != offset


def clamp_point(point: Triple) -> Triple:
    """Clamp the coordinates of a point to the range of the format."""
    x, y, z = (clamp(coordinate, -FARTHEST, FARTHEST) for coordinate in point)
    return x, y, z


def shifted(element: Moved, axis: Triple, distance: float = 1.0) -> Moved:
    """Move an element as `translate` does."""
    return translate(element, axis, distance)[0]


def rotate(element: Element, axis: Triple, angle: float) -> Element:
    """Rotate the directions of an element about a unit vector, right-handed, and its points about their mean.

    angle: degrees. The roll of an element that shows one is set so that its whole frame is rotated.
    """
    changes: dict[str, Any] = {}
    for name in field_names(type(element), Direction):
        old = getattr(element, name)
        new = unit(rodrigues(old, axis, angle))  # a direction along the axis keeps all its digits
        changes[name] = old if dist(new, old) < NOISE else neat_direction(new, keep_heading=False)
    if isinstance(element, Oriented) and shows_roll(element):
        # Compared with the frame without a roll about the new axis, however far that is from the one before.
        u, v, _ = frame_of(element.replace(**changes, roll=0.0))
        old_u, _, _ = frame_of(element)
        new_u = rodrigues(old_u, axis, angle)
        changes["roll"] = degrees(atan2(dot(new_u, v), dot(new_u, u)))
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    centre = mean_point(element)
    if centre and len(points) > 1:
        for name, point in points.items():
            offset = rodrigues(subtract(point, centre), axis, angle)
            changes[name] = clamp_point(linear_combination(1.0, centre, 1.0, offset))
    return element.replace(**changes)


def rotate_about(element: Element, pivot: Triple, axis: Triple, angle: float) -> Element:
    """Rotate an element as `rotate` does, and its place about a pivot."""
    turned = rotate(element, axis, angle) if can_turn(element) else element
    if centre := mean_point(element):
        offset = subtract(centre, pivot)
        turned = shifted(turned, subtract(rodrigues(offset, axis, angle), offset))
    return turned


def can_turn(element: Element) -> bool:
    """Whether some rotation of an element can be seen."""
    kind = type(element)
    if isinstance(element, Oriented):
        return element.shows_axis
    return len(field_names(kind, Point)) > 1 or bool(field_names(kind, Direction))


def mean_point(element: Element) -> Triple | None:
    """Mean of the points of an element, about which it turns; None if it has none."""
    points = [getattr(element, name) for name in field_names(type(element), Point)]
    if not points:
        return None
    x, y, z = (fsum(part) / len(points) for part in zip(*points, strict=True))
    return x, y, z


def frame_of(element: Element) -> list[Triple]:
    """The vectors of the own frame of a shape that has one; the last is its axis or normal."""
    return [(each.x, each.y, each.z) for each in element.frame()] if isinstance(element, Oriented) else []


def rodrigues(vector: Triple, axis: Triple, degrees: float) -> Triple:
    """Rotate a vector about the unit vector `axis` by Rodrigues' formula (1840)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    (x, y, z), (a, b, d) = vector, axis
    cross = b * z - d * y, d * x - a * z, a * y - b * x
    along = (x * a + y * b + z * d) * (1 - c)
    return linear_combination(1.0, linear_combination(c, vector, s, cross), along, axis)
