"""Traversal of the trees of meshes by beams of coherent rays, see `minirt.kernel.beams`."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.beams import (
    CHILDREN,
    DEPTHS,
    TINY,
    Beam,
    beam_memory,
    beam_of,
    between_planes,
    boxes_in_beam,
    triangles_in_beam,
)
from minirt.kernel.bvh_nodes import NODE, REFERENCES, prefetch_node
from minirt.kernel.scene_arrays import Group, prefetch_triangle
from minirt.lanes import Mask, Number, Vec, any, bits, fabs, greatest, lowest, save, where

Visit = Callable[..., Any]
Reach = Callable[[Any, Any], Number]
Rays = tuple[Vec, Vec, Number]


def fold_over_mesh(
    visit: Visit, reach: Reach, group: Group, row: int, rays: Rays, active: Mask, state: Any, data: Any
) -> Any:
    """Fold `state = visit(group, row, index, within, state, data)` over the triangles of a mesh that rays may meet.

    `row` is that of the first triangle of the mesh. `rays` are their apexes, which are alike or close together, their
    ways, of any length, and for each the index of a triangle that it does not meet; only the `active` ones count. Those
    within a beam around the first of them traverse the tree together, the nearest triangles first, and then the rest.
    No triangle beyond `reach(state, data)` times its way matters to a ray. `visit` is called with the row of a
    triangle, its index in the scene, and the rays that may meet it. Returns the last state.
    """
    apexes, way, own = rays
    length = fabs(way.x) + fabs(way.y) + fabs(way.z)
    remaining = active & (length > TINY) & (4.0 * length < inf)  # no product of beams overflows
    while any(remaining):  # the first of them is in its own beam: so this ends
        beam = beam_of(group.trees.places[group.trees.numbers[row]], apexes, way, remaining)
        state = walk(visit, reach, group, row, beam, own, state, data)
        remaining = remaining & ~beam.within
    return state


def walk(visit: Visit, reach: Reach, group: Group, row: int, beam: Beam, own: Number, state: Any, data: Any) -> Any:
    """Continue `fold_over_mesh` over the triangles whose boxes a beam meets, the nearest nodes first."""
    nodes, start = group.trees.nodes, group.trees.starts[group.trees.numbers[row]]
    excluded, memory = own - start[1], beam_memory()
    memory[0], memory[DEPTHS] = 0.0, -inf
    waiting = 1
    limit = depth_of_reach(beam, reach(state, data))
    while waiting > 0:
        waiting -= 1
        if memory[DEPTHS + waiting] > limit:
            continue
        node = (start[0] + abs(int(memory[waiting]))) * NODE
        if memory[waiting] < 0.0:
            children = bits(triangles_in_beam(nodes, node, beam, limit, memory))
            candidates = children
            while candidates != 0:
                triangle = int(-1.0 - nodes[node + REFERENCES + lowest(candidates)])
                candidates = candidates & (candidates - 1)
                prefetch_triangle(group.triangles, row + triangle)
            while children != 0:
                place = lowest(children)
                triangle = int(-1.0 - nodes[node + REFERENCES + place])
                children = children & (children - 1)
                met = beam.within & between_planes(memory, place, beam) & (excluded != triangle)
                if any(met):
                    state = visit(group, row + triangle, start[1] + triangle, met, state, data)
                    limit = depth_of_reach(beam, reach(state, data))
        else:
            inside, near = boxes_in_beam(nodes, node, beam, limit)
            children = bits(inside)
            save(near, memory, CHILDREN)
            while children != 0:
                child = lowest(children)
                children = children & (children - 1)
                reference = nodes[node + REFERENCES + child]
                prefetch_node(nodes, start[0] + abs(int(reference)), 1)
                push(memory, waiting, reference, memory[CHILDREN + child])
                waiting += 1
    return state


def depth_of_reach(beam: Beam, reach: Number) -> float:
    """Return the depth up to which any ray of a beam has to go; each has to go `reach` times its way."""
    return beam.apex + beam.slack + greatest(where(beam.within, reach * beam.rate, -inf))


def push(memory: Any, waiting: int, reference: float, depth: float) -> None:
    """Insert a node among those that wait, the nearest of which is the last."""
    while waiting > 0 and memory[DEPTHS + waiting - 1] < depth:
        memory[waiting], memory[DEPTHS + waiting] = memory[waiting - 1], memory[DEPTHS + waiting - 1]
        waiting -= 1
    memory[waiting], memory[DEPTHS + waiting] = reference, depth
