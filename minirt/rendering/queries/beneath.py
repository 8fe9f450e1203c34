"""Clearance beneath a shape: how far it can fall until it touches another shape.

Vertical rays sample the shape's footprint, by the interpreted formulas of the kernel. Their middle one is exact, so
that shapes whose middles lie above each other touch; elsewhere the error is of the second order in the spacing.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from minirt.lanes import Vec
from minirt.shapes import ALL_KINDS, Shape
from minirt.shapes.mesh import Mesh
from minirt.shapes.shape import Bounds

COUNT = 33  # rays along a side of the footprint: odd, so that one is in the middle
START = 1 / 1024  # of the shape's height: how far above its top the rays begin, so that they meet a surface there
COARSE = 9  # rays along a side where a mesh takes part, which is met by one ray at a time


def clearance(shape: Shape, others: Iterable[Shape]) -> tuple[float, Shape | None]:
    """Height of a bounded shape above that of `others` which it meets first, and this one; negative if it sinks in.

    Infinite if there is none beneath its top.
    """
    box = shape.bounds()
    assert box
    near = [other for other in others if is_near(box, other.bounds())]
    count = COARSE if any(isinstance(each, Mesh) for each in (shape, *near)) else COUNT
    (west, bottom, south), (east, top, north) = box
    share = (np.arange(count) + 0.5) / count
    x, z = (each.ravel() for each in np.meshgrid(west + (east - west) * share, south + (north - south) * share))
    height = top - bottom or east - west
    start = top + START * height
    underside = bottom - height + distances(shape, x, bottom - height, z, 1.0)
    gap, support = np.inf, None
    for other in near:
        with np.errstate(invalid="ignore"):  # where rays miss both
            gaps = underside - (start - distances(other, x, start, z, -1.0))
        least = float(np.where(np.isfinite(gaps), gaps, np.inf).min())
        gap, support = (least, other) if least < gap else (gap, support)
    return gap, support


def is_near(box: Bounds, other: Bounds | None) -> bool:
    """Whether a box may lie beneath another: their footprints overlap and it does not begin above."""
    if other is None:
        return True
    (west, _, south), (east, top, north) = box
    return other[0][0] <= east and other[1][0] >= west and other[0][2] <= north and other[1][2] >= south and (
        other[0][1] < top
    )  # fmt: skip


def distances(shape: Shape, x: np.ndarray, y: float, z: np.ndarray, up: float) -> np.ndarray:
    """Distances along vertical rays, up or down, from x, y, z to a shape; infinite where they miss it."""
    kind = next(kind for kind in ALL_KINDS if kind.element is type(shape))
    packed = shape.pack()
    with np.errstate(all="ignore"):
        if isinstance(shape, Mesh):
            rays = (kind.intersect(packed, Vec(a, y, b), Vec(0.0, up, 0.0)) for a, b in zip(x, z, strict=True))
            return np.array([np.where(hit, t, np.inf).min(initial=np.inf) for hit, t in rays])
        nothing = np.zeros_like(x)
        hit, t = kind.intersect(packed, Vec(x, nothing + y, z), Vec(nothing, nothing + up, nothing))
        return np.where(hit, t, np.inf)
