"""Orientation of elements: rotations of shapes by their whole frame, and the axes about which keys turn them."""

from __future__ import annotations

from math import atan2, copysign, cos, degrees, radians, sin
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Direction, Point, Triple
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.shapes.shape import Oriented
from minirt.viewer.editing.projection import dot

LEVEL = 0.5  # vertical part of a camera's up; above it, which is up to a pitch of 60 degrees, left and right are level


def can_turn(element: Element) -> bool:
    """Whether some rotation of an element can be seen."""
    if isinstance(element, Oriented):
        return element.shows_axis
    fields = fields_of(type(element))
    points = sum(isinstance(field, Point) for field in fields)
    return points > 1 or any(isinstance(field, Direction) for field in fields)


def shows_roll(element: Element) -> bool:
    """Whether a turn of an element about its own axis is worth a word in the file."""
    return isinstance(element, Oriented) and (element.shows_roll or element.roll != 0.0)


def turn_axis(camera: Camera, axis: int) -> Triple:
    """The axis of a turn as seen by the camera: right, up or forward, by its number in `camera_frame`.

    In place of up it is the vertical, unless the camera looks steeply up or down or is rolled: what stands upright then
    turns on its foot, as on a turntable, and does not tip over.
    """
    direction = camera_frame(camera)[axis]
    return (0.0, copysign(1.0, direction[1]), 0.0) if axis == 1 and abs(direction[1]) > LEVEL else direction


def with_directions(element: Element, directions: dict[str, Any], about: Triple, angle: float) -> dict[str, Any]:
    """The changed fields of an element that was rotated: its `directions`, and the roll that keeps its frame whole.

    `directions` are rotated and rounded already. The rotated frame is compared with the frame without a roll about the
    new axis, however far that frame is from the one before.
    """
    if not (isinstance(element, Oriented) and shows_roll(element)):
        return directions
    first, _ = across(element)
    rotated = rodrigues(first, about, angle)
    u, v = across(element.replace(**directions, roll=0.0))
    return directions | {"roll": degrees(atan2(dot(rotated, v), dot(rotated, u)))}


def across(shape: Oriented) -> tuple[Triple, Triple]:
    """The two vectors of the frame of a shape that are perpendicular to its axis or normal."""
    u, v, _ = shape.frame()
    return (u.x, u.y, u.z), (v.x, v.y, v.z)


def rodrigues(vector: Triple, axis: Triple, degrees: float) -> Triple:
    """Rotate a vector about the unit vector `axis` by Rodrigues' formula (1840)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    (x, y, z), (a, b, d) = vector, axis
    cross = b * z - d * y, d * x - a * z, a * y - b * x
    along = (x * a + y * b + z * d) * (1 - c)
    return linear_combination(1.0, linear_combination(c, vector, s, cross), along, axis)
