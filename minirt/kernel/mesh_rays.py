"""Single rays at the triangles of a mesh, which are tested in float32, with margins for all that is rounded. What is
left of them is tested exactly."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from minirt.kernel.bvh_nodes import CORNERS, NODE, REFERENCES, ROUNDING, WIDE, vec_at
from minirt.kernel.bvh_rays import (
    AT,
    AXES,
    BEGIN,
    CANDIDATES,
    LIMIT,
    NEXT,
    ROUNDED,
    SIGN,
    SLACK,
    SLOPE,
    RayPacket,
    ray_integers,
    ray_numbers,
    save_single,
    set_limit,
    store_rays,
)
from minirt.kernel.bvh_single_rays import traverse
from minirt.kernel.scene_arrays import Group, prefetch_triangle
from minirt.lanes import Mask, Vec, bits, fabs, in_single, lowest, maximum, minimum, save, where
from minirt.lanes.memory import load_half


def triangles_along(touch: Callable[..., None], group: Group, row: int, memory: Any, chosen: int) -> None:
    """Call `touch(group, row, index, memory, ray)` for the triangles of a mesh that rays may hit, the nearest nodes
    first, up to the distance in the first row of `HIT`, which `touch` may lessen.

    `row` is that of the first triangle of the mesh. The rays are those of the packet's memory with a bit in `chosen`.
    """
    trees, mesh = group.trees, group.trees.numbers[row]
    numbers, integers = ray_numbers(), ray_integers()
    rays = RayPacket(trees.nodes, trees.starts[mesh, 0], trees.places[mesh], memory, numbers, integers, 1)
    shear_rays(rays)
    traverse(find_triangles, visit_triangles, (touch, group, row), rays, chosen, 0)


def shear_rays(rays: RayPacket) -> None:
    """Prepare rays for the test of boxes and of triangles.

    The axis along which a ray advances most comes first; along the others, coordinates are those seen along the ray.
    """
    p, d, error = store_rays(rays)
    x, y, z = fabs(d.x), fabs(d.y), fabs(d.z)
    by_x = (x >= y) & (x >= z)
    by_y = (y >= z) & ~by_x
    d = where(by_x, d, where(by_y, Vec(d.y, d.z, d.x), Vec(d.z, d.x, d.y)))
    p = where(by_x, p, where(by_y, Vec(p.y, p.z, p.x), Vec(p.z, p.x, p.y)))
    sign = where(d.x > 0.0, 0.0 * x + 1.0, -1.0)
    slope = Vec(sign * d.x, d.y / (sign * d.x), d.z / (sign * d.x))
    save_single(Vec(sign * p.x, p.y - slope.y * (sign * p.x), p.z - slope.z * (sign * p.x)), rays.numbers, AT)
    save_single(slope, rays.numbers, SLOPE)
    axis = where(by_x, 0.0 * x, where(by_y, 1.0, 2.0))
    second, third = where(axis < 2.0, axis + 1.0, 0.0), where(axis < 1.0, axis + 2.0, axis - 1.0)
    save_single(Vec(WIDE * axis, WIDE * second, WIDE * third), rays.numbers, AXES)
    save(in_single(ROUNDING + 4.0 * error), rays.numbers, ROUNDED)
    save(in_single(sign), rays.numbers, SIGN)


def find_triangles(rays: RayPacket, at_leaf: int, data: tuple[Callable[..., None], Group, int]) -> int:
    """Find the triangles that rays may hit in the leaves that they are at; returns the rays for which there are any,
    one bit for each."""
    _, group, row = data
    remaining, found = at_leaf, 0
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        found = found | find_candidates(rays, group, row, ray) << ray
    return found


def visit_triangles(rays: RayPacket, found: int, data: tuple[Callable[..., None], Group, int]) -> None:
    """Visit the triangles that `find_triangles` found."""
    touch, group, row = data
    while found != 0:
        ray = lowest(found)
        found = found & (found - 1)
        candidates, leaf = int(rays.integers[CANDIDATES + ray]), rays.root - rays.integers[NEXT + ray]
        while candidates != 0:
            triangle = int(-1.0 - rays.nodes[leaf * NODE + REFERENCES + lowest(candidates)])
            candidates = candidates & (candidates - 1)
            first = group.trees.starts[group.trees.numbers[row], 1]
            touch(group, row + triangle, first + triangle, rays.memory, ray)
        set_limit(rays, ray)


def find_candidates(rays: RayPacket, group: Group, row: int, ray: int) -> int:
    """Find the triangles of the next leaf that a ray may hit, and prefetch the first; returns 1 if there are any."""
    leaf = (rays.root - rays.integers[NEXT + ray]) * NODE
    candidates = bits(triangles_on_ray(rays.nodes, leaf, rays.numbers, ray))
    rays.integers[CANDIDATES + ray] = candidates
    if candidates != 0:
        prefetch_triangle(group.triangles, row + int(-1.0 - rays.nodes[leaf + REFERENCES + lowest(candidates)]))
    return int(candidates != 0)


def triangles_on_ray(nodes: Any, leaf: int, numbers: Any, ray: int) -> Mask:
    """Return which triangles of a leaf a ray may hit up to its limit.

    As seen along it the ray is the point 0. It hits a triangle if its areas with the three edges have one sign, within
    a margin for coordinates that are rounded by `ROUNDING` of their sizes and by the ray's own `rounding`.
    """
    a, b = sheared(nodes, leaf, numbers, ray), sheared(nodes, leaf + 3 * WIDE, numbers, ray)
    c = sheared(nodes, leaf + CORNERS, numbers, ray)
    at, slope, rounding = numbers[AT + ray], numbers[SLOPE + ray], numbers[ROUNDED + ray]  # slope > 0: see `shear_rays`
    most = at + slope * numbers[LIMIT + ray] + (rounding + numbers[SLACK + ray])
    least = at + slope * numbers[BEGIN + ray] - (rounding + numbers[SLACK + ray])
    inside = (minimum(minimum(a.x, b.x), c.x) <= most) & (maximum(maximum(a.x, b.x), c.x) >= least)
    ab, bc, ca = b - a, c - b, a - c
    of_a, of_b, of_c = b.y * bc.z - b.z * bc.y, c.y * ca.z - c.z * ca.y, a.y * ab.z - a.z * ab.y
    longest = maximum(maximum(fabs(ab.y), fabs(ab.z)), maximum(fabs(ca.y), fabs(ca.z)))  # bc is at most twice as long
    margin = (ROUNDING * (maximum(fabs(a.y), fabs(a.z)) + longest) + rounding) * longest
    low, high = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
    return inside & ((low >= -margin) | (high <= margin))


def sheared(nodes: Any, corner: int, numbers: Any, ray: int) -> Vec:
    """Return corners of the triangles of a leaf as seen along a ray: depths along an axis, and places beside it."""
    at, slope, axes = vec_at(numbers, AT, ray), vec_at(numbers, SLOPE, ray), vec_at(numbers, AXES, ray)
    depth = numbers[SIGN + ray] * load_half(nodes, corner + int(axes.x))
    x, y = load_half(nodes, corner + int(axes.y)) - at.y, load_half(nodes, corner + int(axes.z)) - at.z
    return Vec(depth, x - slope.y * depth, y - slope.z * depth)
