"""Rays of any origins in the space of a tree, and the test of boxes there.

Boxes are tested in float32, relative to the point of a ray that is closest to the middle of the tree. Boxes and rays
are widened for all that is rounded: boxes by `ROUNDING` of their coordinates, when they are built; rays by `ROUNDING`
of those of that point, and by `MARGIN` of the coordinates from which it is computed. That is more than the rounding
of the test (Ize, Robust BVH Ray Traversal, 2013) and of the formulas of shapes together.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.bvh_nodes import (
    APART,
    CENTRE,
    DEEPEST,
    DIRECTION,
    FACTOR,
    HIGH,
    HIT,
    HUGE,
    MARGIN,
    NODE,
    ORIGIN,
    ROUNDING,
    WIDE,
    WIDTH,
    vec_at,
)
from minirt.kernel.scene_arrays import vector
from minirt.kernel.trace import COINCIDENT
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    copysign,
    dot,
    fabs,
    in_single,
    load,
    load_vec,
    max_norm,
    maximum,
    minimum,
    save,
    splat,
    where,
)
from minirt.lanes.memory import load_half

LOOSE = 4.0  # a ray that is widened by so much meets the whole tree
FAR = 4.0  # more than the depth of anything in a tree
TINY = 2.0**-60  # replaces 0 in a direction, so that no ray is parallel to the planes of boxes

PACKET = WIDTH  # the number of the packet as a whole among the rays
AHEAD = 9 * WIDTH  # offset in the memory of a packet: how far rays go to depth 0 in the scene's tree; then, in a mesh's
# Numbers of rays, by rows with those of all. For boxes: the point of depth 0, moved forward and back and divided by the
# direction; one over the direction; the depths from which and up to which a ray is followed, both widened by its slack.
# For triangles, see `minirt.kernel.mesh_rays.shear_rays`: AT, SLOPE, AXES, ROUNDED and SIGN. Then the stacks: for each
# ray, and each level of the tree, the depths of children, and references to these.
ENTER, LEAVE, INVERSE, AT, SLOPE, AXES = (3 * WIDTH * i for i in range(6))
BEGIN, SLACK, ROUNDED, SIGN, LIMIT = (18 * WIDTH + WIDTH * i for i in range(5))
STACK, LEVEL = 24 * WIDTH, 2 * WIDE
NUMBERS = STACK + (WIDTH + 1) * DEEPEST * LEVEL
# Integers of rays: the reference to what each visits next; the top level of its stack; which triangles of a leaf it may
# hit; for each level of its stack, which of the children it has still to visit; and for each child in the stack of the
# packet, which rays hit it.
NEXT, TOP, CANDIDATES, PENDING = 0, 2 * WIDTH, 4 * WIDTH, 6 * WIDTH
HITS = PENDING + (WIDTH + 1) * DEEPEST
INTEGERS = HITS + DEEPEST * WIDE


class RayPacket(NamedTuple):
    """A packet of rays in the space of a tree."""

    nodes: Any  # of the tree, and maybe of others
    root: int  # the number of its first node
    place: Any  # its space
    memory: Any  # the rays in the scene, and their hits
    numbers: Any  # float32, by offsets as `ENTER`
    integers: Any  # by offsets as `NEXT`
    is_mesh: int  # 1 if the tree is that of a mesh, whose leaves rays read and prefetch; or 0


def ray_numbers() -> Any:
    """Allocate the numbers of rays; compiled, they lie on the stack of the thread."""
    return np.zeros(NUMBERS, np.float32)


def ray_integers() -> Any:
    """Allocate the integers of rays; compiled, they lie on the stack of the thread."""
    return np.zeros(INTEGERS, np.int64)


def store_rays(rays: RayPacket) -> tuple[Vec, Vec, Number]:
    """Prepare rays of unit directions for the box test. Returns, in the space of the tree, their points closest to its
    middle, their directions, and how wrong these may be.

    Depths are counted along a ray from that point, or from its origin behind that.
    """
    place, numbers, origin = rays.place, rays.numbers, load_vec(rays.memory, ORIGIN)
    direction, factor = load_vec(rays.memory, DIRECTION), place[FACTOR]
    away = factor * (origin - vector(place, CENTRE))
    p = Vec(dot(vector(place, 0), away), dot(vector(place, 3), away), dot(vector(place, 6), away))
    d = Vec(dot(vector(place, 0), direction), dot(vector(place, 3), direction), dot(vector(place, 6), direction))
    ahead = maximum(-dot(p, d), 0.0)
    p = p + ahead * d
    error = MARGIN * factor * (max_norm(origin) + max_norm(vector(place, CENTRE)) + place[APART])
    is_loose = error > LOOSE  # so far away that nothing is known
    p = where(is_loose, splat(Vec(0.0, 0.0, 0.0), d.x), p)
    slack = ROUNDING * max_norm(p) + minimum(error, 2.0 * LOOSE)
    inverse = Vec(safe_inverse(d.x), safe_inverse(d.y), safe_inverse(d.z))
    grow = Vec(copysign(slack, d.x), copysign(slack, d.y), copysign(slack, d.z))
    enter, leave = p + grow, p - grow  # moving the ray forward moves the planes by which it enters boxes back
    save_single(Vec(enter.x * inverse.x, enter.y * inverse.y, enter.z * inverse.z), numbers, ENTER)
    save_single(Vec(leave.x * inverse.x, leave.y * inverse.y, leave.z * inverse.z), numbers, LEAVE)
    save_single(inverse, numbers, INVERSE)
    slack, error = where(is_loose, HUGE, slack), where(is_loose, HUGE, error)
    save(in_single(maximum(-ahead, -FAR) - slack), numbers, BEGIN)
    save(in_single(slack), numbers, SLACK)
    save(ahead, rays.memory, AHEAD + WIDTH * rays.is_mesh)
    set_limits(rays)
    return p, d, error


def save_single(v: Vec, numbers: Any, at: int) -> None:
    """Store the vectors of all rays, rounded: all x, then all y, then all z."""
    save(in_single(v.x), numbers, at)
    save(in_single(v.y), numbers, at + WIDTH)
    save(in_single(v.z), numbers, at + 2 * WIDTH)


def safe_inverse(x: Number) -> Number:
    """Return 1 / x, or a large number with the sign of x for x near 0."""
    return 1.0 / where(fabs(x) > TINY, x, copysign(TINY, x))


def search_limit(distance: Number) -> Number:
    """Return how far to search for hits nearer than `distance` or coincident with a hit there."""
    return distance * (1.0 + 2.0 * COINCIDENT)


def set_limits(rays: RayPacket) -> None:
    """Set the depths up to which all rays are followed, by the distances at which they have hit something."""
    distance, ahead = load(rays.memory, HIT), load(rays.memory, AHEAD + WIDTH * rays.is_mesh)
    depth = minimum(search_limit(distance) * rays.place[FACTOR] - ahead, FAR)
    save(in_single(depth) + load_half(rays.numbers, SLACK), rays.numbers, LIMIT)


def set_limit(rays: RayPacket, ray: int) -> None:
    """Set the depth up to which one ray is followed."""
    distance, ahead = rays.memory[HIT + ray], rays.memory[AHEAD + WIDTH * rays.is_mesh + ray]
    depth = minimum(search_limit(distance) * rays.place[FACTOR] - ahead, FAR)
    rays.numbers[LIMIT + ray] = depth + rays.numbers[SLACK + ray]


def boxes_on_ray(rays: RayPacket, node: int, ray: int) -> tuple[Mask, Number]:
    """Return which children of a node a ray may meet up to its limit, and the depths at which it enters their boxes."""
    nodes, numbers, at = rays.nodes, rays.numbers, node * NODE
    enter, leave, inverse = vec_at(numbers, ENTER, ray), vec_at(numbers, LEAVE, ray), vec_at(numbers, INVERSE, ray)
    x = at if inverse.x > 0.0 else at + HIGH
    y = at + WIDE if inverse.y > 0.0 else at + HIGH + WIDE
    z = at + 2 * WIDE if inverse.z > 0.0 else at + HIGH + 2 * WIDE
    other = 2 * at + HIGH  # the sum of the offsets of the low and the high planes along x
    near = Vec(load_half(nodes, x), load_half(nodes, y), load_half(nodes, z))
    far_y, far_z = load_half(nodes, other + 2 * WIDE - y), load_half(nodes, other + 4 * WIDE - z)
    far = Vec(load_half(nodes, other - x), far_y, far_z)
    return slab_test(near, far, enter, leave, inverse, numbers[BEGIN + ray], numbers[LIMIT + ray])


def rays_in_box(rays: RayPacket, node: int, child: int) -> tuple[Mask, Number]:
    """Return which rays of a packet may meet a child of a node up to their limits, and the depths at which they enter
    its box."""
    nodes, numbers, at = rays.nodes, rays.numbers, node * NODE + child
    enter, leave, inverse = half_vec(numbers, ENTER), half_vec(numbers, LEAVE), half_vec(numbers, INVERSE)
    x, y, z = inverse.x > 0.0, inverse.y > 0.0, inverse.z > 0.0
    low = splat(Vec(nodes[at], nodes[at + WIDE], nodes[at + 2 * WIDE]), inverse.x)
    high = splat(Vec(nodes[at + HIGH], nodes[at + HIGH + WIDE], nodes[at + HIGH + 2 * WIDE]), inverse.x)
    near = Vec(where(x, low.x, high.x), where(y, low.y, high.y), where(z, low.z, high.z))
    far = Vec(where(x, high.x, low.x), where(y, high.y, low.y), where(z, high.z, low.z))
    return slab_test(near, far, enter, leave, inverse, load_half(numbers, BEGIN), load_half(numbers, LIMIT))


def half_vec(numbers: Any, at: int) -> Vec:
    """Load the vectors of all rays, as `save_single` stores them."""
    return Vec(load_half(numbers, at), load_half(numbers, at + WIDTH), load_half(numbers, at + 2 * WIDTH))


def slab_test(
    near: Vec, far: Vec, enter: Vec, leave: Vec, inverse: Vec, begin: Number, limit: Number
) -> tuple[Mask, Number]:
    """Slab test (Kay and Kajiya 1986): whether rays meet boxes up to a limit, and the depths at which they enter."""
    in_x, in_y, in_z = near.x * inverse.x - enter.x, near.y * inverse.y - enter.y, near.z * inverse.z - enter.z
    out_x, out_y, out_z = far.x * inverse.x - leave.x, far.y * inverse.y - leave.y, far.z * inverse.z - leave.z
    begin = maximum(maximum(in_x, in_y), maximum(in_z, begin))
    end = minimum(minimum(out_x, out_y), minimum(out_z, limit))
    return begin <= end, begin
