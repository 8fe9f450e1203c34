"""The medium around the eye: how much the tinted glass that encloses it absorbs."""

from __future__ import annotations

import numpy as np

from minirt.kernel.scene_arrays import kind_of_packed
from minirt.lanes import Vec, dot
from minirt.rendering.packing.colours import Colours
from minirt.rendering.packing.features import ATTRIBUTES, PLAIN
from minirt.rendering.packing.secondary_rays import absorption
from minirt.shapes import Shape

TOWARDS = Vec(*np.array([0.5773, 0.2113, 0.7887]) / np.linalg.norm([0.5773, 0.2113, 0.7887]))  # any direction will do


def medium_at(point: np.ndarray, shapes: tuple[Shape, ...], colours: Colours) -> np.ndarray:
    """Return the absorption of red, green and blue at a point, in halvings for each scene unit."""
    total = np.zeros(3)
    for shape in shapes:
        if ATTRIBUTES(shape) != PLAIN and shape.tint and shape.glass and shape.glass.share and encloses(shape, point):
            total += absorption(shape, colours)
    return total


def encloses(shape: Shape, point: np.ndarray) -> bool:
    """Whether a point is inside of a shape: the first surface that a ray from there hits faces away from it."""
    if not shape.solid:
        return False
    plane = shape.flat()
    if plane:
        return bool(np.dot(np.subtract(point, plane[0]), plane[1]) < 0.0)
    low, high = shape.bounds() or ((-np.inf,) * 3, (np.inf,) * 3)
    if not (np.greater(point, low) & np.less(point, high)).all():
        return False
    packed, origin = shape.pack(), Vec(*point)
    kind = kind_of_packed(type(packed))
    with np.errstate(all="ignore"):
        hit, t = kind.intersect(packed, origin, TOWARDS)
        nearest = np.where(hit, t, np.inf).min()
        _, normal = kind.surface(packed, origin + nearest * TOWARDS)
        leaving = np.atleast_1d(dot(normal, TOWARDS))[np.argmin(np.atleast_1d(np.where(hit, t, np.inf)))]
    return bool(nearest < np.inf and leaving > 0.0)
