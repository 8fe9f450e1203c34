"""How large things are: what a step of a movement is a share of."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from statistics import median
from typing import TypeVar

from minirt.element import Element, fields_of
from minirt.fields import FARTHEST, LEAST_LENGTH, Point, Triple, clamp
from minirt.scene import Camera, Scene
from minirt.shapes import Shape

Ball = tuple[Triple, float]  # centre and radius
Thing = TypeVar("Thing")

SAMPLE = 4096  # things; their median is within some percent of that of a million


def ball(element: Element) -> Ball | None:
    """A ball about an element: as wide as the box of a shape that has one, or a radius of 0 at its point."""
    box = element.bounds() if isinstance(element, Shape) else None
    if box is not None:
        (a, b, c), (x, y, z) = box
        return ((a + x) / 2, (b + y) / 2, (c + z) / 2), max(x - a, y - b, z - c) / 2
    points = [getattr(element, each.name) for each in fields_of(type(element)) if isinstance(each, Point)]
    return (points[0], 0.0) if points else None


def sample(things: Sequence[Thing]) -> Sequence[Thing]:
    """All of few things, and of many at most SAMPLE at equal distances in the file."""
    return things[:: max(1, -(-len(things) // SAMPLE))]


def balls(scene: Scene) -> list[Ball]:
    """What is where in a scene: its shapes with an end or, where there are none, everything that has a place."""
    bounded: list[Element] = [each for each in sample(scene.shapes) if each.bounds() is not None]
    things = bounded or [each for each in sample(scene.elements) if not isinstance(each, Camera)]
    return list(filter(None, map(ball, things)))


def size_of(scene: Scene) -> float:
    """The distance from the camera that is usual for the things in a scene.

    The median, since one far or huge thing (a sky, a sun) says nothing of the others.
    """
    reaches = [max(dist(scene.camera.position, centre), radius) for centre, radius in balls(scene)]
    usual = median(reach for reach in reaches if reach > 0) if any(reaches) else 1.0
    return clamp(usual, LEAST_LENGTH, FARTHEST)


def middle_of(scene: Scene) -> Triple:
    """The usual place of the things in a scene: of each coordinate the median, for the same reason."""
    centres = [centre for centre, _ in balls(scene)]
    if not centres:
        return 0.0, 0.0, 0.0
    x, y, z = (median(each) for each in zip(*centres, strict=True))
    return x, y, z
