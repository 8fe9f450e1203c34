"""How large a shape is, by its fields."""

from __future__ import annotations

from itertools import pairwise
from math import dist

from minirt.element import fields_of
from minirt.fields import Length, Lengths
from minirt.rendering.parts import own_points
from minirt.shapes import Shape


def sizes_of(shape: Shape) -> list[float]:
    """The lengths that a shape is given by, and the distances between the points that it is."""
    fields = fields_of(type(shape))
    found: list[float] = [getattr(shape, each.name) for each in fields if isinstance(each, Length)]
    found += [size for each in fields if isinstance(each, Lengths) for size in getattr(shape, each.name)]
    points = own_points(shape)
    return found + [dist(one, other) for one, other in pairwise([*points, points[0]]) if len(points) > 1]
