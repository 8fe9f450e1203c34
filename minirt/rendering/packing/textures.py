"""Packs solid textures: marble, wood and clouds, each with the frame of its shape."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Set

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel.shading.patterns import CLOUDS, COLUMNS, MARBLE, WOOD, Patterns
from minirt.lanes import Vec, cross, unit
from minirt.rendering.packing.lights import Colours
from minirt.shapes import Shape
from minirt.shapes.frames import basis
from minirt.shapes.shape import UPRIGHT, Flat, Oriented
from minirt.shapes.triangle import Triangle

PATTERN_FEATURES = {"patterns", "raised_patterns"}
KINDS = {"marble": MARBLE, "wood": WOOD, "clouds": CLOUDS}  # in the order in which a shape gets them
BEHIND = 3.5  # sizes from a flat surface to the middle of its rings

Frame = tuple[Vec, Vec, Vec, Vec]  # origin and three axes, the last one along the grain of wood


def pack_patterns(
    shapes: Iterable[tuple[int, Shape]], owner: np.ndarray, used: Set[Hashable], colours: Colours
) -> Patterns:
    """Pack the patterns of shapes, given with their indices; `owner` (n,) has the shape of each primitive."""
    rows: list[list[float]] = []
    heights: list[float] = []
    ranges = np.zeros((owner.max(initial=-1) + 1, 2), np.int64)
    for index, shape in shapes:
        first = len(rows)
        for name, kind in KINDS.items():
            pattern = getattr(shape, name)
            if pattern:
                numbers = [kind, *colours.shares(pattern.colour), pattern.octaves, 1 / pattern.size]
                rows.append([*numbers, *(part for v in frame(shape, pattern.size) for part in (v.x, v.y, v.z))])
                heights.append(pattern.height * pattern.size)
        ranges[index] = first, len(rows)
    packed = np.array(rows, np.float64).reshape(-1, COLUMNS)
    return Patterns(ranges[owner], packed, np.array(heights) if "raised_patterns" in used else None)


def frame(shape: Shape, size: float) -> Frame:
    """Return the frame in which a pattern of this size lies: it moves and turns with the shape.

    The grain of wood runs along the axis of a shape, and on flat shapes to the right.
    """
    origin = Vec(*next(getattr(shape, field.name) for field in fields_of(type(shape)) if isinstance(field, Point)))
    x, y, z = own_axes(shape)
    if isinstance(shape, Flat | Triangle):
        return origin - BEHIND * size * z, y, z, x
    return origin, x, y, z


def own_axes(shape: Shape) -> tuple[Vec, Vec, Vec]:
    """Return the right-handed axes of a shape, the last one its axis or normal: y where it has neither."""
    if isinstance(shape, Triangle):
        along, normal = Vec(*np.subtract(shape.b, shape.a)), Vec(*shape.normal())
        return unit(along), unit(cross(normal, along)), normal
    return shape.frame() if isinstance(shape, Oriented) else basis(UPRIGHT)
