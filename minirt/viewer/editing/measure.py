"""Sizes and centres of elements and scenes, which scale the steps of movements."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, hypot
from statistics import median
from typing import TypeVar

from minirt.element import Element, fields_of
from minirt.fields import FARTHEST, LEAST_LENGTH, Point, Triple, clamp
from minirt.scene import Camera, Scene
from minirt.shapes import Shape

Extent = tuple[Triple, float]  # centre and radius
Item = TypeVar("Item")

UP: Triple = (0.0, 1.0, 0.0)
FLAT = 0.02  # slope of a view that is too level to show where it meets the ground
UNKNOWN_SIZE = 10.0  # scene units: the size of a scene that says nothing of it
SAMPLE_SIZE = 4096  # items; their median is within some per cent of that of a million


def extent(element: Element) -> Extent | None:
    """Centre and radius of an element: half the longest side of its bounding box, or 0 at its point, or None."""
    box = element.bounds() if isinstance(element, Shape) else None
    if box is not None:
        (a, b, c), (x, y, z) = box
        return ((a + x) / 2, (b + y) / 2, (c + z) / 2), max(x - a, y - b, z - c) / 2
    points = [getattr(element, each.name) for each in fields_of(type(element)) if isinstance(each, Point)]
    return (points[0], 0.0) if points else None


def sample(items: Sequence[Item]) -> Sequence[Item]:
    """Select at most SAMPLE_SIZE items, evenly spaced in the file."""
    return items[:: max(1, -(-len(items) // SAMPLE_SIZE))]


def extents(scene: Scene) -> list[Extent]:
    """Extents of the bounded shapes of a scene or, if there are none, of all elements with a position."""
    bounded: list[Element] = [each for each in sample(scene.shapes) if each.bounds() is not None]
    elements = bounded or [each for each in sample(scene.elements) if not isinstance(each, Camera)]
    return list(filter(None, map(extent, elements)))


def scene_size(scene: Scene) -> float:
    """Size of a scene: the median distance of its elements from the camera.

    The median ignores single distant or huge elements (a sky, a sun). Without elements it is the distance to what the
    camera looks at.
    """
    distances = [max(dist(scene.camera.position, centre), radius) for centre, radius in extents(scene)]
    known = any(distances)
    usual = median(distance for distance in distances if distance > 0) if known else looked_at_distance(scene.camera)
    return clamp(usual, LEAST_LENGTH, FARTHEST)


def looked_at_distance(camera: Camera) -> float:
    """Distance from the camera to where it looks: to the ground y = 0, or to the point of its view nearest the origin.

    A camera in the origin, or one that looks away from it, tells less: the distance to the origin, or UNKNOWN_SIZE.
    """
    x, y, z = camera.position
    a, b, c = camera.direction
    if y * b < 0 and abs(b) > FLAT:
        return -y / b
    ahead, away = -(x * a + y * b + z * c), hypot(x, y, z)
    return ahead if ahead > away / 2 else away or UNKNOWN_SIZE


def scene_centre(scene: Scene) -> Triple:
    """Centre of a scene: the median of each coordinate, which ignores single distant elements."""
    centres = [centre for centre, _ in extents(scene)]
    if not centres:
        return 0.0, 0.0, 0.0
    x, y, z = (median(each) for each in zip(*centres, strict=True))
    return x, y, z
