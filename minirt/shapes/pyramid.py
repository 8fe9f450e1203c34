"""Culling of triangles for packets of rays with a common point, by the pyramid between that point and the triangle.

The side planes of the pyramid are the same for all rays of a packet. So this test takes a third of the time of an
intersection, and in a mesh with triangles as small as pixels nearly every triangle that passes it is hit.
"""

from __future__ import annotations

from minirt.lanes import Mask, Number, Vec, cross, dot, max_norm, maximum, minimum, splat, unit_roundoff, where

APART = 1024  # roundings of its length by which a ray may miss the apex, or a side plane of the pyramid
BEHIND = 4  # roundings of the coordinates by which a start may seem to lie behind the triangle


def may_meet(
    corners: tuple[Vec, Vec, Vec], normal: Vec, apex: Vec, start: Vec | None, direction: Vec, active: Mask
) -> Mask:
    """Cull the `active` rays that cannot hit the triangle, whatever the rounding: a mask of the others.

    Without a `start` rays leave the apex. With one they lead to the apex, and those that start in front of the
    triangle, as seen from the apex, cannot hit it.
    """
    a, b, c = corners[0] - apex, corners[1] - apex, corners[2] - apex
    of_a, of_b, of_c = dot(cross(b, c), direction), dot(cross(c, a), direction), dot(cross(a, b), direction)
    size = maximum(maximum(max_norm(a), max_norm(b)), max_norm(c))
    far = splat(size, direction.x)
    if start is not None:
        far = far + max_norm(apex - start)
        active = active & (depth_behind_plane(corners[0], normal, dot(normal, a), start) >= 0.0)
    margin = APART * unit_roundoff(direction.x) * size * far
    least, most = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return active & ((least >= -margin) | (most <= margin))


def depth_behind_plane(corner: Vec, normal: Vec, height: Number, start: Vec) -> Number:
    """The greatest depth of `start` behind a plane, as seen from the apex.

    `height` is the height of the plane above the apex along `normal`.
    """
    away = where(height > 0.0, splat(1.0, height), -1.0)
    slack = BEHIND * unit_roundoff(start.x) * (max_norm(start) + max_norm(corner))
    return away * dot(normal, start - corner) + slack
