"""Single rays in the space of a mesh's tree, each of which is tested against all children of a node at a time.

Boxes and triangles are tested in float32, relative to the point of the ray that is closest to the middle of the tree,
with margins for all that is rounded. What is left of the triangles is tested exactly.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.kernel.beams import LOOSE, ROUNDINGS
from minirt.kernel.bvh_nodes import DIRECTION, HIT, ORIGIN, WIDTH, search_limit, vec_at
from minirt.kernel.mesh_nodes import APART, CENTRE, FACTOR, HIGH, HUGE, ROUNDING, WIDE
from minirt.kernel.scene_arrays import LEVELS, vector
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    copysign,
    dot,
    fabs,
    in_single,
    max_norm,
    maximum,
    minimum,
    save,
    unit_roundoff,
    where,
)
from minirt.lanes.memory import load_half

FAR = 4.0  # more than the depth of anything in a tree
TINY = 2.0**-60  # replaces 0 in a direction

# Numbers of a traversal: rows with those of all rays, and for each ray and level of its stack the depths of children
# still to visit.
ENTER, LEAVE, INVERSE, AT, SLOPE, AXES = (3 * WIDTH * i for i in range(6))
BEGIN, LIMIT, SLACK, ROUNDED, SIGN = (18 * WIDTH + WIDTH * i for i in range(5))
ROWS = 23 * WIDTH
MEMORY = ROWS + WIDTH * LEVELS * WIDE


def ray_numbers() -> Any:
    """Allocate the numbers of a traversal; compiled, they lie on the stack of the thread."""
    return np.zeros(MEMORY, np.float32)


def store_rays(place: Any, origin: Vec, direction: Vec, numbers: Any) -> None:
    """Store rays of unit directions in the space of a tree; `place` is a row of `MeshTrees.places`.

    Depths are counted along a ray from its point closest to the middle of the tree, or from its origin behind that.
    """
    factor = place[FACTOR]
    away = factor * (origin - vector(place, CENTRE))
    p = Vec(dot(vector(place, 0), away), dot(vector(place, 3), away), dot(vector(place, 6), away))
    d = Vec(dot(vector(place, 0), direction), dot(vector(place, 3), direction), dot(vector(place, 6), direction))
    ahead = maximum(-dot(p, d), 0.0)
    p = p + ahead * d
    error = (
        ROUNDINGS * unit_roundoff(d.x) * factor * (max_norm(origin) + max_norm(vector(place, CENTRE)) + place[APART])
    )
    loose = error > LOOSE  # so far away that nothing is known
    p, error = where(loose, Vec(0.0 * p.x, 0.0 * p.y, 0.0 * p.z), p), where(loose, HUGE, error)
    slack = ROUNDING + error
    inverse = Vec(safe_inverse(d.x), safe_inverse(d.y), safe_inverse(d.z))
    grow = Vec(copysign(slack, d.x), copysign(slack, d.y), copysign(slack, d.z))
    enter, leave = p + grow, p - grow
    save_single(Vec(enter.x * inverse.x, enter.y * inverse.y, enter.z * inverse.z), numbers, ENTER)
    save_single(Vec(leave.x * inverse.x, leave.y * inverse.y, leave.z * inverse.z), numbers, LEAVE)
    save_single(inverse, numbers, INVERSE)
    # The axis along which a ray advances most comes first; along the others, coordinates are those seen along the ray.
    x, y, z = fabs(d.x), fabs(d.y), fabs(d.z)
    by_x = (x >= y) & (x >= z)
    by_y = (y >= z) & ~by_x
    d = where(by_x, d, where(by_y, Vec(d.y, d.z, d.x), Vec(d.z, d.x, d.y)))
    p = where(by_x, p, where(by_y, Vec(p.y, p.z, p.x), Vec(p.z, p.x, p.y)))
    sign = where(d.x > 0.0, 0.0 * x + 1.0, -1.0)
    slope = Vec(sign * d.x, d.y / (sign * d.x), d.z / (sign * d.x))
    save_single(Vec(sign * p.x, p.y - slope.y * (sign * p.x), p.z - slope.z * (sign * p.x)), numbers, AT)
    save_single(slope, numbers, SLOPE)
    axis = where(by_x, 0.0 * x, where(by_y, 1.0, 2.0))
    second, third = where(axis < 2.0, axis + 1.0, 0.0), where(axis < 1.0, axis + 2.0, axis - 1.0)
    save_single(Vec(WIDE * axis, WIDE * second, WIDE * third), numbers, AXES)
    save_single(Vec(maximum(-ahead, -FAR) - slack, 0.0 * x, slack), numbers, BEGIN)
    save(in_single(ROUNDING + 4.0 * error), numbers, ROUNDED)
    save(in_single(sign), numbers, SIGN)


def save_single(v: Vec, numbers: Any, at: int) -> None:
    """Store the vectors of all rays, rounded: all x, then all y, then all z."""
    save(in_single(v.x), numbers, at)
    save(in_single(v.y), numbers, at + WIDTH)
    save(in_single(v.z), numbers, at + 2 * WIDTH)


def safe_inverse(x: Number) -> Number:
    """Return 1 / x, or a large number with the sign of x for x near 0."""
    return 1.0 / where(fabs(x) > TINY, x, copysign(TINY, x))


def set_limit(place: Any, memory: Any, numbers: Any, ray: int) -> None:
    """Set the depth up to which a ray is followed, by the distance at which it has hit something."""
    factor = place[FACTOR]
    away = vec_at(memory, ORIGIN, ray) - vector(place, CENTRE)
    ahead = maximum(-factor * dot(away, vec_at(memory, DIRECTION, ray)), 0.0)
    numbers[LIMIT + ray] = minimum(search_limit(memory[HIT + ray]) * factor - ahead, FAR) + numbers[SLACK + ray]


def boxes_on_ray(nodes: Any, node: int, numbers: Any, ray: int) -> tuple[Mask, Number]:
    """Return which children of a node a ray may meet up to its limit, and the depths at which it enters their boxes."""
    enter, leave = vec_at(numbers, ENTER, ray), vec_at(numbers, LEAVE, ray)
    inverse = vec_at(numbers, INVERSE, ray)
    x = 0 if inverse.x > 0.0 else HIGH
    y = WIDE if inverse.y > 0.0 else HIGH + WIDE
    z = 2 * WIDE if inverse.z > 0.0 else HIGH + 2 * WIDE
    in_x = load_half(nodes, node + x) * inverse.x - enter.x
    in_y = load_half(nodes, node + y) * inverse.y - enter.y
    in_z = load_half(nodes, node + z) * inverse.z - enter.z
    out_x = load_half(nodes, node + HIGH - x) * inverse.x - leave.x
    out_y = load_half(nodes, node + HIGH + 2 * WIDE - y) * inverse.y - leave.y
    out_z = load_half(nodes, node + HIGH + 4 * WIDE - z) * inverse.z - leave.z
    begin = maximum(maximum(in_x, in_y), maximum(in_z, numbers[BEGIN + ray]))
    end = minimum(minimum(out_x, out_y), minimum(out_z, numbers[LIMIT + ray]))
    return begin <= end, begin


def triangles_on_ray(nodes: Any, node: int, numbers: Any, ray: int) -> Mask:
    """Return which triangles of a leaf a ray may hit up to its limit."""
    a, b = sheared(nodes, node, numbers, ray), sheared(nodes, node + 3 * WIDE, numbers, ray)
    c = sheared(nodes, node + 6 * WIDE, numbers, ray)
    at, slope, rounding = numbers[AT + ray], numbers[SLOPE + ray], numbers[ROUNDED + ray]
    most = at + slope * numbers[LIMIT + ray] + (rounding + numbers[SLACK + ray])
    least = at + slope * numbers[BEGIN + ray] - (rounding + numbers[SLACK + ray])
    inside = (minimum(minimum(a.x, b.x), c.x) <= most) & (maximum(maximum(a.x, b.x), c.x) >= least)
    ab, bc, ca = b - a, c - b, a - c
    of_a, of_b, of_c = b.y * bc.z - b.z * bc.y, c.y * ca.z - c.z * ca.y, a.y * ab.z - a.z * ab.y
    longest = maximum(maximum(fabs(ab.y), fabs(ab.z)), maximum(fabs(ca.y), fabs(ca.z)))
    margin = (ROUNDING * (maximum(fabs(a.y), fabs(a.z)) + longest) + rounding) * longest
    low, high = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return inside & ((low >= -margin) | (high <= margin))


def sheared(nodes: Any, corner: int, numbers: Any, ray: int) -> Vec:
    """Return corners of the triangles of a leaf as seen along a ray: depths along an axis, and places beside it."""
    at, slope, axes = vec_at(numbers, AT, ray), vec_at(numbers, SLOPE, ray), vec_at(numbers, AXES, ray)
    depth = numbers[SIGN + ray] * load_half(nodes, corner + int(axes.x))
    x, y = load_half(nodes, corner + int(axes.y)) - at.y, load_half(nodes, corner + int(axes.z)) - at.z
    return Vec(depth, x - slope.y * depth, y - slope.z * depth)
