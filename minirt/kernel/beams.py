"""Beams of coherent rays, and which boxes and triangles in the tree of a mesh they meet.

A beam encloses rays that share an apex. Along the axis on which they advance most, its bounds are the least and the
greatest slope of the rays across it: so four products decide for all children of a node at once whether the beam
meets their boxes (Boulos, Wald and Shirley, Geometric and Arithmetic Culling Methods for Entire Ray Packets, 2006).
Boxes are float32. Beams are widened for the rounding of boxes, of rays and of triangles.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.bvh_nodes import APART, CENTRE, CORNERS, FACTOR, HIGH, HUGE, ROUNDING, WIDE
from minirt.kernel.scene_arrays import LEVELS, vector
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    cross,
    dot,
    fabs,
    first,
    greatest,
    in_single,
    lane,
    max_norm,
    maximum,
    minimum,
    save,
    unit_roundoff,
    where,
)
from minirt.lanes.memory import load_half

ROUNDINGS = 64  # unit roundoffs of the coordinates: rounding of rays and of triangles
LOOSE = 4.0  # a beam that is widened by so much encloses the whole tree
SPREAD = 0.25  # most difference of two slopes in a beam
WIDENING = 4.0  # of a beam whose rays do not leave the apex itself, by so many times their distance from it
TINY = 2.0**-100  # a ray that is shorter meets nothing

# Memory of a traversal: references to nodes that wait, the depths at which the beam enters them, and those of a node;
# of the triangles of a leaf, planes, edges and margins, see `between_planes`.
DEPTHS = LEVELS * WIDE
CHILDREN = 2 * DEPTHS
PLANES = CHILDREN + WIDE
EDGES, MARGINS = PLANES + 9 * WIDE, PLANES + 18 * WIDE
MEMORY = MARGINS + WIDE


Bounds = tuple[int, int, int, float, float, float, float]


class Beam(NamedTuple):
    """Bounds of some rays in the space of a tree; offsets are those of planes in a node.

    A box meets the beam unless one of its tests fails, each with a plane of the box and one along the axis.
    """

    sign: float  # of the rays' direction along the axis
    near: int  # offsets of the planes by which rays enter and leave boxes along the axis
    far: int
    apex: float  # along the axis, in the direction of the rays
    slack: float
    across: Bounds  # see `between_slopes`
    down: Bounds
    within: Mask  # the rays
    rate: Number  # the depth by which a ray advances along its way
    central: Vec  # the direction of one ray, 1 along the axis
    passing: Vec  # where that ray is at depth 0
    rays: Vec  # the directions of all, 1 along the axis and as seen along that ray: sheared
    moments: Vec  # of the rays about the apex
    rounding: float  # of the rays, and of what `triangles_in_beam` computes
    is_point: bool  # whether the rays leave the apex itself


def beam_memory() -> Any:
    """Allocate the memory of a traversal; compiled, it lies on the stack of the thread."""
    return np.zeros(MEMORY, np.float32)


def beam_of(place: Any, apexes: Vec, way: Vec, remaining: Mask) -> Beam:
    """Return a beam around the first of the `remaining` rays and those close to it; `place` is a row of `places`."""
    factor = place[FACTOR]
    ray = first(remaining)
    one, apex = vec_of(way, ray), vec_of(apexes, ray)
    x, y, z = abs(dot(vector(place, 0), one)), abs(dot(vector(place, 3), one)), abs(dot(vector(place, 6), one))
    axis = (0 if x >= z else 2) if x >= y else (1 if y >= z else 2)
    second, third = (axis + 1) % 3, (axis + 2) % 3
    along = dot(vector(place, 3 * axis), way)
    sign = 1.0 if lane(along, ray) > 0.0 else -1.0
    ahead = sign * along
    per_depth = 1.0 / ahead
    u, v = dot(vector(place, 3 * second), way) * per_depth, dot(vector(place, 3 * third), way) * per_depth
    within = remaining & (ahead > 0.0)
    within = within & (fabs(u - lane(u, ray)) <= SPREAD) & (fabs(v - lane(v, ray)) <= SPREAD)
    apart = greatest(where(within, max_norm(apexes - apex), 0.0))
    at = (apex - vector(place, CENTRE)) * factor
    in_u, in_v = dot(vector(place, 3 * second), at), dot(vector(place, 3 * third), at)
    depth = sign * dot(vector(place, 3 * axis), at)
    farthest = max_norm(apex) + max_norm(vector(place, CENTRE)) + place[APART] + apart
    error, apart = ROUNDINGS * unit_roundoff(way.x) * farthest * factor, apart * factor
    slack, rounding = ROUNDING + error + WIDENING * apart, ROUNDING * (1.0 + apart) + 4.0 * error
    if not slack < LOOSE:
        in_u, in_v, depth, slack, rounding = 0.0, 0.0, 0.0, HUGE, HUGE
    near, far = (axis * WIDE, HIGH + axis * WIDE) if sign > 0.0 else (HIGH + axis * WIDE, axis * WIDE)
    across = slope_bounds(u, within, second, in_u, depth, slack, near, far, sign)
    down = slope_bounds(v, within, third, in_v, depth, slack, near, far, sign)
    central = Vec(1.0, lane(u, ray), lane(v, ray))
    y, z = u - central.y, v - central.z
    rays = moments = Vec(in_single(u), in_single(y), in_single(z))
    if apart > 0.0:
        beside = (apexes - apex) * factor
        back = sign * dot(vector(place, 3 * axis), beside)
        x, up = dot(vector(place, 3 * second), beside) - u * back, dot(vector(place, 3 * third), beside) - v * back
        moments = Vec(in_single(y * up - z * x), in_single(-up), in_single(x))
    passing = Vec(0.0, in_u - central.y * depth, in_v - central.z * depth)
    of_rays = within, ahead * factor, central, passing, rays, moments, rounding, apart == 0.0
    return Beam(sign, near, far, depth, slack, across, down, *of_rays)


def vec_of(v: Vec, ray: int) -> Vec:
    """Return the vector of one ray."""
    return Vec(lane(v.x, ray), lane(v.y, ray), lane(v.z, ray))


def slope_bounds(
    slopes: Number, within: Mask, axis: int, at: float, depth: float, slack: float, near: int, far: int, sign: float
) -> Bounds:
    """Return what `between_slopes` takes, for some rays whose apex has the coordinates `at` and `depth`."""
    least, most = -greatest(where(within, -slopes, -inf)), greatest(where(within, slopes, -inf))
    low, high = at - least * depth - slack, at - most * depth + slack
    first_plane, last_plane = near if least > 0.0 else far, far if most > 0.0 else near
    return axis * WIDE, first_plane, last_plane, sign * least, sign * most, low, high


def boxes_in_beam(nodes: Any, node: int, beam: Beam, limit: float) -> tuple[Mask, Number]:
    """Return which children of a node a beam may meet up to a depth, and the depths at which it enters their boxes.

    Depths are counted from the origin of the tree's space."""
    near, far = beam.sign * load_half(nodes, node + beam.near), beam.sign * load_half(nodes, node + beam.far)
    inside = (near <= limit) & (far >= beam.apex - beam.slack)
    inside = inside & between_slopes(nodes, node, beam.across) & between_slopes(nodes, node, beam.down)
    return inside, near


def between_slopes(nodes: Any, node: int, bounds: Bounds) -> Mask:
    """Return which boxes of a node lie at least partly between two planes through an apex."""
    axis, first_plane, last_plane, least, most, low, high = bounds
    above = load_half(nodes, node + HIGH + axis) - least * load_half(nodes, node + first_plane) >= low
    below = load_half(nodes, node + axis) - most * load_half(nodes, node + last_plane) <= high
    return above & below


# Triangles are seen along one ray of the beam, sheared: so coordinates across are small, and float32 tells exactly
# enough which rays pass between the planes through the apex and the edges.


def triangles_in_beam(nodes: Any, node: int, beam: Beam, limit: float, memory: Any) -> Mask:
    """Return which triangles of a leaf a beam may meet up to a depth, and write what `between_planes` takes."""
    a, b = sheared(nodes, node, beam), sheared(nodes, node + 3 * WIDE, beam)
    c = sheared(nodes, node + CORNERS, beam)
    slack, far = beam.slack + beam.rounding, maximum(maximum(a.x, b.x), c.x)
    most = limit - beam.apex + (slack + ROUNDING * abs(beam.apex))
    inside = (minimum(minimum(a.x, b.x), c.x) <= most) & (far >= -slack)
    inside = inside & beside_axis(a.y, b.y, c.y, far, beam.across, beam.sign, beam.central.y, slack)
    inside = inside & beside_axis(a.z, b.z, c.z, far, beam.down, beam.sign, beam.central.z, slack)
    if any(inside):
        ab, bc, ca = b - a, c - b, a - c
        save_edge(b, bc, memory, 0, beam)
        save_edge(c, ca, memory, 3 * WIDE, beam)
        save_edge(a, ab, memory, 6 * WIDE, beam)
        longest = maximum(max_norm(ab), max_norm(ca))
        save((ROUNDING * (maximum(fabs(a.y), fabs(a.z)) + longest) + beam.rounding) * longest, memory, MARGINS)
    return inside


def save_edge(corner: Vec, edge: Vec, memory: Any, at: int, beam: Beam) -> None:
    """Write the normals of the planes through the apex and an edge of each triangle, which begins at a corner."""
    save_children(cross(corner, edge), memory, PLANES + at)
    if not beam.is_point:
        save_children(edge, memory, EDGES + at)


def save_children(v: Vec, memory: Any, at: int) -> None:
    """Store a vector for each child of a node: all x, then all y, then all z."""
    save(v.x, memory, at)
    save(v.y, memory, at + WIDE)
    save(v.z, memory, at + 2 * WIDE)


def sheared(nodes: Any, at: int, beam: Beam) -> Vec:
    """Return corners of the triangles of a leaf: depths behind the apex, and places beside the central ray."""
    depth = beam.sign * load_half(nodes, at + min(beam.near, beam.far))
    x, y = load_half(nodes, at + beam.across[0]) - beam.passing.y, load_half(nodes, at + beam.down[0]) - beam.passing.z
    return Vec(depth - beam.apex, x - beam.central.y * depth, y - beam.central.z * depth)


def beside_axis(
    a: Number, b: Number, c: Number, far: Number, bounds: Bounds, sign: float, slope: float, slack: float
) -> Mask:
    """Return which sheared triangles lie at least partly between two planes through the apex."""
    least, most = sign * bounds[3] - slope, sign * bounds[4] - slope
    above = maximum(maximum(a, b), c) - least * far >= -slack
    return above & (minimum(minimum(a, b), c) - most * far <= slack)


def between_planes(memory: Any, place: int, beam: Beam) -> Mask:
    """Return which rays may hit a triangle of a leaf, in front of the apex or behind it."""
    of_a, of_b = above_plane(memory, place, beam), above_plane(memory, place + 3 * WIDE, beam)
    of_c, margin = above_plane(memory, place + 6 * WIDE, beam), memory[MARGINS + place]
    least, most = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return (least >= -margin) | (most <= margin)


def above_plane(memory: Any, at: int, beam: Beam) -> Number:
    """Return on which side of an edge rays pass: the volume between it and their directions."""
    plane, edge = PLANES + at, EDGES + at
    above = memory[plane + WIDE] * beam.rays.y + (memory[plane + 2 * WIDE] * beam.rays.z + memory[plane])
    if not beam.is_point:
        above = above - dot(Vec(memory[edge], memory[edge + WIDE], memory[edge + 2 * WIDE]), beam.moments)
    return above
