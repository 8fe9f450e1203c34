"""Which rays through a common point may meet a triangle: those in the pyramid between the two.

The sides of the pyramid are the same for all rays of a packet, so this takes a third of the time that the test of a hit
does, and of a mesh with triangles as small as pixels it leaves only those to that test which are hit.
"""

from __future__ import annotations

from minirt.lanes import Vec, cross, dot, maximum, minimum, splat, unit_roundoff, where
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number

APART = 1024  # roundings of its length by which a ray may pass beside the point, or beside a side of the pyramid
BEHIND = 4  # roundings of the coordinates by which a start may seem to lie behind the triangle


def may_meet(
    corners: tuple[Vec, Vec, Vec], normal: Vec, apex: Vec, start: Vec | None, direction: Vec, active: Mask
) -> Mask:
    """Of the rays that are `asked` for, those that may meet the triangle, whatever the rounding.

    They come from the apex; or, where they have a `start`, they lead to it, and those that start before the triangle,
    as it is seen from there, meet nothing of it.
    """
    a, b, c = corners[0] - apex, corners[1] - apex, corners[2] - apex
    of_a, of_b, of_c = dot(cross(b, c), direction), dot(cross(c, a), direction), dot(cross(a, b), direction)
    size = maximum(maximum(largest(a), largest(b)), largest(c))
    far = splat(size, direction.x)
    if start is not None:
        far = far + largest(apex - start)
        active = active & (depth_behind_plane(corners[0], normal, dot(normal, a), start) >= 0.0)
    margin = APART * unit_roundoff(direction.x) * size * far
    least, most = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return active & ((least >= -margin) | (most <= margin))


def depth_behind_plane(corner: Vec, normal: Vec, height: float, start: Vec) -> Number:
    """How far behind a plane points lie at most, for somebody before it; of the plane `normal` points away from him
    where `height` is above 0."""
    away = where(height > 0.0, 1.0, -1.0)
    slack = BEHIND * unit_roundoff(start.x) * (largest(start) + largest(corner))
    return away * dot(normal, start - corner) + slack
