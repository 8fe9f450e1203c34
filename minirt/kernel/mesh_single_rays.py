"""Traversal of the trees of meshes by single rays, each of which meets all children of a node at a time.

The tree of a mesh is that of `minirt.kernel.beams`. Boxes and triangles are tested in float32, relative to the point of
the ray that is closest to the middle of the tree, with margins for all that is rounded; what is left is tested exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.beams import APART, CENTRE, FACTOR, HIGH, HUGE, LOOSE, NODE, REFERENCES, ROUNDING, ROUNDINGS, WIDE
from minirt.kernel.bvh_nodes import DIRECTION, HIT, ORIGIN, search_limit, vec_at
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
    greatest,
    load,
    lowest,
    max_norm,
    maximum,
    minimum,
    save,
    unit_roundoff,
    where,
)

FAR = 4.0  # more than the depth of anything in a tree
TINY = 2.0**-60  # replaces 0 in a direction

# Memory of a traversal: for each level a row with the depths of children still to visit, and the number of their node.
PARENTS = LEVELS * WIDE
MEMORY = PARENTS + LEVELS


class TreeRay(NamedTuple):
    """A ray in the space of a tree. Depths are counted along it from its point closest to the middle, in units of the
    tree."""

    x: int  # offsets in a node of the planes by which the ray enters boxes
    y: int
    z: int
    enter: Vec  # as `minirt.kernel.bvh_nodes.store_rays` prepares rays for the slab test
    leave: Vec
    inverse: Vec
    ahead: float  # minus the depth of the ray's origin, or 0
    begin: float  # the least depth that counts
    factor: float  # units of the tree in one of the scene
    slack: float
    deep: int  # offsets in a node of the corners' coordinates along the axis on which the ray advances most, and of
    across: int  # those along the two others
    down: int
    sign: float  # of the ray's direction along that axis
    at: Vec  # coordinates of the point from which depths are counted, along these axes, the first times the sign
    slope: Vec  # advance along these axes, for each depth along the ray, and for each unit along the first axis
    rounding: float


def ray_memory() -> Any:
    """Allocate the memory of a traversal; compiled, it lies on the stack of the thread."""
    return np.zeros(MEMORY, np.float32)


def ray_in_tree(place: Any, origin: Vec, direction: Vec) -> TreeRay:
    """Return a ray of unit direction in the space of a tree; `place` is a row of `MeshTrees.places`."""
    factor = place[FACTOR]
    away = factor * (origin - vector(place, CENTRE))
    p = Vec(dot(vector(place, 0), away), dot(vector(place, 3), away), dot(vector(place, 6), away))
    d = Vec(dot(vector(place, 0), direction), dot(vector(place, 3), direction), dot(vector(place, 6), direction))
    ahead = maximum(-dot(p, d), 0.0)
    p = p + ahead * d
    farthest = max_norm(origin) + max_norm(vector(place, CENTRE)) + place[APART]
    error = ROUNDINGS * unit_roundoff(d.x) * farthest * factor
    slack, rounding = ROUNDING + error, ROUNDING + 4.0 * error
    if not slack < LOOSE:
        p, slack, rounding = Vec(0.0, 0.0, 0.0), HUGE, HUGE
    inverse = Vec(safe_inverse(d.x), safe_inverse(d.y), safe_inverse(d.z))
    grow = Vec(copysign(slack, d.x), copysign(slack, d.y), copysign(slack, d.z))
    enter, leave = p + grow, p - grow
    enter = Vec(enter.x * inverse.x, enter.y * inverse.y, enter.z * inverse.z)
    leave = Vec(leave.x * inverse.x, leave.y * inverse.y, leave.z * inverse.z)
    planes = 0 if inverse.x > 0.0 else HIGH, WIDE if inverse.y > 0.0 else HIGH + WIDE
    begin = maximum(-ahead, -FAR) - slack
    x, y, z = abs(d.x), abs(d.y), abs(d.z)
    axis = (0 if x >= z else 2) if x >= y else (1 if y >= z else 2)
    along, second, third = d.x, d.y, d.z
    at, beside, above = p.x, p.y, p.z
    if axis == 1:
        along, second, third, at, beside, above = d.y, d.z, d.x, p.y, p.z, p.x
    if axis == 2:
        along, second, third, at, beside, above = d.z, d.x, d.y, p.z, p.x, p.y
    sign = 1.0 if along > 0.0 else -1.0
    advance, at = sign * along, sign * at
    slope = Vec(advance, second / advance, third / advance)
    passing = Vec(at, beside - slope.y * at, above - slope.z * at)
    offsets = axis * WIDE, (axis + 1) % 3 * WIDE, (axis + 2) % 3 * WIDE
    z_plane = 2 * WIDE if inverse.z > 0.0 else HIGH + 2 * WIDE
    return TreeRay(
        *planes, z_plane, enter, leave, inverse, ahead, begin, factor, slack, *offsets, sign, passing, slope, rounding
    )


def safe_inverse(x: float) -> float:
    """Return 1 / x, or a large number with the sign of x for x near 0."""
    return 1.0 / (x if abs(x) > TINY else copysign(TINY, x))


def depth_of(ray: TreeRay, distance: float) -> float:
    """Return the depth up to which a ray is to be followed that has hit something at a distance."""
    return minimum(search_limit(distance) * ray.factor - ray.ahead, FAR) + ray.slack


def boxes_on_ray(nodes: Any, node: int, ray: TreeRay, limit: float) -> tuple[Mask, Number]:
    """Return which children of a node a ray may meet up to a depth, and the depths at which it enters their boxes."""
    x, y, z = ray.x, ray.y, ray.z
    in_x = load(nodes, node + x) * ray.inverse.x - ray.enter.x
    in_y = load(nodes, node + y) * ray.inverse.y - ray.enter.y
    in_z = load(nodes, node + z) * ray.inverse.z - ray.enter.z
    out_x = load(nodes, node + HIGH - x) * ray.inverse.x - ray.leave.x
    out_y = load(nodes, node + HIGH + 2 * WIDE - y) * ray.inverse.y - ray.leave.y
    out_z = load(nodes, node + HIGH + 4 * WIDE - z) * ray.inverse.z - ray.leave.z
    begin = maximum(maximum(in_x, in_y), maximum(in_z, ray.begin))
    end = minimum(minimum(out_x, out_y), minimum(out_z, limit))
    return begin <= end, begin


def triangles_on_ray(nodes: Any, node: int, ray: TreeRay, limit: float) -> Mask:
    """Return which triangles of a leaf a ray may hit up to a depth."""
    a, b, c = sheared(nodes, node, ray), sheared(nodes, node + 3 * WIDE, ray), sheared(nodes, node + 6 * WIDE, ray)
    most = ray.at.x + ray.slope.x * limit + ray.rounding + ray.slack
    least = ray.at.x + ray.slope.x * ray.begin - ray.rounding - ray.slack
    inside = (minimum(minimum(a.x, b.x), c.x) <= most) & (maximum(maximum(a.x, b.x), c.x) >= least)
    ab, bc, ca = b - a, c - b, a - c
    of_a, of_b, of_c = b.y * bc.z - b.z * bc.y, c.y * ca.z - c.z * ca.y, a.y * ab.z - a.z * ab.y
    longest = maximum(maximum(fabs(ab.y), fabs(ab.z)), maximum(fabs(ca.y), fabs(ca.z)))
    margin = (ROUNDING * (maximum(fabs(a.y), fabs(a.z)) + longest) + ray.rounding) * longest
    low, high = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return inside & ((low >= -margin) | (high <= margin))


def sheared(nodes: Any, at: int, ray: TreeRay) -> Vec:
    """Return corners of the triangles of a leaf as seen along the ray: depths along an axis, and places beside it."""
    depth = ray.sign * load(nodes, at + ray.deep)
    x, y = load(nodes, at + ray.across) - ray.at.y, load(nodes, at + ray.down) - ray.at.z
    return Vec(depth, x - ray.slope.y * depth, y - ray.slope.z * depth)


def triangles_along(visit: Callable[..., None], group: Group, row: int, memory: Any, lane: int) -> None:
    """Call `visit(group, row, index, memory, lane)` for the triangles of a mesh that a ray may hit, the nearest nodes
    first, up to the distance in the first row of `HIT`, which `visit` may lessen.

    `row` is that of the first triangle of the mesh, and the ray is in a lane of the packet's memory.
    """
    mesh = group.trees.numbers[row]
    place, start, nodes = group.trees.places[mesh], group.trees.starts[mesh], group.trees.nodes
    origin, direction = vec_at(memory, ORIGIN, lane), vec_at(memory, DIRECTION, lane)
    ray = ray_in_tree(place, origin, direction)
    rows = ray_memory()
    limit = depth_of(ray, memory[HIT + lane])
    node, top = 0, -1
    while True:
        at = (start[0] + node) * NODE
        if nodes[at + REFERENCES] < 0.0:
            candidates = bits(triangles_on_ray(nodes, at, ray, limit))
            while candidates != 0:
                triangle = int(-1.0 - nodes[at + REFERENCES + lowest(candidates)])
                candidates = candidates & (candidates - 1)
                visit(group, row + triangle, start[1] + triangle, memory, lane)
                limit = depth_of(ray, memory[HIT + lane])
        else:
            hit, near = boxes_on_ray(nodes, at, ray, limit)
            if any(hit):
                top += 1
                save(where(hit, near, inf), rows, top * WIDE)
                rows[PARENTS + top] = node
        nearest = inf
        while top >= 0:
            nearest = -greatest(-load(rows, top * WIDE))
            if nearest <= limit:
                break
            top -= 1
        if top < 0:
            return
        child = first(load(rows, top * WIDE) == nearest)
        rows[top * WIDE + child] = inf
        node = int(nodes[(start[0] + int(rows[PARENTS + top])) * NODE + REFERENCES + child])
