"""Traversal of the trees of meshes by single rays, each of which meets all children of a node at a time.

The tree of a mesh is that of `minirt.kernel.beams`. Boxes and triangles are tested in float32, relative to the point of
the ray that is closest to the middle of the tree, with margins for all that is rounded; what is left is tested exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np

from minirt.kernel.beams import APART, CENTRE, FACTOR, HIGH, HUGE, LOOSE, NODE, REFERENCES, ROUNDING, ROUNDINGS, WIDE
from minirt.kernel.bvh_nodes import DIRECTION, HIT, ORIGIN, WIDTH, least_lane, search_limit, vec_at
from minirt.kernel.scene_arrays import LEVELS, Group, vector
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    bits,
    copysign,
    dot,
    fabs,
    first,
    in_single,
    load_half,
    load_vec,
    lowest,
    max_norm,
    maximum,
    minimum,
    prefetch,
    save,
    unit_roundoff,
    where,
)

FAR = 4.0  # more than the depth of anything in a tree
TINY = 2.0**-60  # replaces 0 in a direction

# Memory of a traversal. In float32: rows with the numbers of all rays, and for each ray and level of its stack the
# depths of children still to visit. In integers: for each ray the node that it visits next, the top row of its stack,
# and which triangles of a leaf it may hit; and for each row the node whose children are there.
ENTER, LEAVE, INVERSE, AT, SLOPE, AXES = (3 * WIDTH * i for i in range(6))
BEGIN, LIMIT, SLACK, ROUNDED, SIGN = (18 * WIDTH + WIDTH * i for i in range(5))
ROWS = 23 * WIDTH
MEMORY = ROWS + WIDTH * LEVELS * WIDE
NEXT, TOP, CANDIDATES, PARENTS = 0, WIDTH, 2 * WIDTH, 3 * WIDTH
INTEGERS = PARENTS + WIDTH * LEVELS
LINE = 16  # float32 in a line of the processor's cache


def ray_numbers() -> Any:
    """Allocate the numbers of a traversal; compiled, they lie on the stack of the thread."""
    return np.zeros(MEMORY, np.float32)


def ray_integers() -> Any:
    """Allocate the integers of a traversal; compiled, they lie on the stack of the thread."""
    return np.zeros(INTEGERS, np.int64)


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


def triangles_along(visit: Callable[..., None], group: Group, row: int, memory: Any, rays: int) -> None:
    """Call `visit(group, row, index, memory, ray)` for the triangles of a mesh that rays may hit, the nearest nodes
    first, up to the distance in the first row of `HIT`, which `visit` may lessen.

    `row` is that of the first triangle of the mesh. The rays are those of the packet's memory with a bit in `rays`.
    """
    mesh = group.trees.numbers[row]
    place, start, nodes = group.trees.places[mesh], group.trees.starts[mesh], group.trees.nodes
    numbers, integers = ray_numbers(), ray_integers()
    store_rays(place, load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), numbers)
    remaining = rays
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        set_limit(place, memory, numbers, ray)
        integers[NEXT + ray], integers[TOP + ray] = start[0], -1
    at_node, at_leaf, unfinished = rays, 0, 0
    while True:
        remaining, at_leaf = at_leaf, 0
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            at_leaf = at_leaf | find_candidates(group, row, numbers, integers, ray) << ray
        remaining = at_node
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            unfinished = unfinished | descend(nodes, numbers, integers, ray) << ray
        while at_leaf != 0:
            ray = lowest(at_leaf)
            at_leaf = at_leaf & (at_leaf - 1)
            visit_candidates(visit, group, row, memory, numbers, integers, ray)
        if unfinished == 0:
            return
        at_node, remaining = 0, unfinished
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            node, leaf, last = advance(nodes, start[0], numbers, integers, ray)
            at_node, at_leaf = at_node | node << ray, at_leaf | leaf << ray
            unfinished = unfinished ^ last << ray


def descend(nodes: Any, numbers: Any, integers: Any, ray: int) -> int:
    """Push the children of the next node whose boxes a ray hits onto its stack; returns 1 if the stack has any."""
    node, top = integers[NEXT + ray], integers[TOP + ray] + 1
    hit, near = boxes_on_ray(nodes, node * NODE, numbers, ray)
    save(where(hit, near, inf), numbers, ROWS + (ray * LEVELS + top) * WIDE)
    integers[PARENTS + ray * LEVELS + top] = node
    top = top - 1 + int(any(hit))
    integers[TOP + ray] = top
    return int(top >= 0)


def advance(nodes: Any, root: int, numbers: Any, integers: Any, ray: int) -> tuple[int, int, int]:
    """Pop the nearest child from the top row of a ray's stack, and make it the next to visit; a row in which nothing
    else is within reach is dropped.

    Returns three flags, 1 or 0: whether the child is a node to visit, whether it is a leaf to visit, and whether the
    stack is now empty.
    """
    top = integers[TOP + ray]
    at = ROWS + (ray * LEVELS + top) * WIDE
    depths = load_half(numbers, at)
    within = bits(depths <= numbers[LIMIT + ray])
    child = first(depths == least_lane(depths))
    numbers[at + child] = inf
    reference = int(nodes[integers[PARENTS + ray * LEVELS + top] * NODE + REFERENCES + child])
    node = root + abs(reference)
    for line in range(0, NODE, LINE):
        prefetch(nodes, node * NODE + line)
    integers[NEXT + ray] = node
    top = top - int(within & (within - 1) == 0)
    integers[TOP + ray] = top
    return int((within != 0) & (reference >= 0)), int((within != 0) & (reference < 0)), int(top < 0)


def find_candidates(group: Group, row: int, numbers: Any, integers: Any, ray: int) -> int:
    """Find the triangles of the next leaf that a ray may hit, and prefetch the first; returns 1 if there are any."""
    nodes, triangles, node = group.trees.nodes, group.triangles, integers[NEXT + ray] * NODE
    candidates = bits(triangles_on_ray(nodes, node, numbers, ray))
    integers[CANDIDATES + ray] = candidates
    if candidates != 0:
        triangle = row + int(-1.0 - nodes[node + REFERENCES + lowest(candidates)])
        prefetch(triangles.normals[triangle], 0)
        for corner in range(3):
            prefetch(triangles.points[triangles.corners[triangle, corner]], 0)
    return int(candidates != 0)


def visit_candidates(
    visit: Callable[..., None], group: Group, row: int, memory: Any, numbers: Any, integers: Any, ray: int
) -> None:
    """Visit the triangles that `find_candidates` found for a ray."""
    mesh, at = group.trees.numbers[row], integers[NEXT + ray] * NODE + REFERENCES
    candidates = integers[CANDIDATES + ray]
    while candidates != 0:
        triangle = int(-1.0 - group.trees.nodes[at + lowest(candidates)])
        candidates = candidates & (candidates - 1)
        visit(group, row + triangle, group.trees.starts[mesh, 1] + triangle, memory, ray)
    set_limit(group.trees.places[mesh], memory, numbers, ray)
