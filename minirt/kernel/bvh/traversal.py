"""The way of rays through the tree, a step of each in turn.

A step waits for numbers to come from memory and through the pipelines, and where a branch was guessed wrong all that
the processor began behind it is lost. Steps of different rays do not wait for each other. So the rays of a packet are
on their way together, and a step has no branch: what would be one is a mask with a bit a ray, and the nearest child is
found among all lanes at once, not by sorting.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.bvh.nodes import (
    HIT,
    INVERSE,
    NEXT,
    REFERENCES,
    STACK,
    STACK_LEVEL,
    TOP,
    WIDTH,
    Group,
    Tree,
    integer_at,
    intersect_boxes,
    leaf_number,
    least_lane,
    near_planes,
    put,
    put_integer,
    reference_of,
    search_limit,
    tag,
    vec_at,
)
from minirt.kernel.trace import for_each_kind
from minirt.lanes import any, load, lowest, where


def traverse(visit: Callable[..., None], tree: Tree, memory: Any, rays: int) -> None:
    """`visit(group, block, tree, memory, ray)` for the leaves that each of the rays meets, the nearest first.

    What is beyond the distance in the first row of `HIT`, which `visit` may lessen, is left out.
    """
    left = rays
    while left != 0:
        ray = lowest(left)
        left = left & (left - 1)
        memory[NEXT + ray] = 0.0  # the root
        put_integer(memory, TOP + ray, STACK - STACK_LEVEL + ray * WIDTH)
    at_node, waiting = rays, 0
    while True:
        left = at_node
        while left != 0:
            ray = lowest(left)
            left = left & (left - 1)
            waiting = waiting | descend(tree.nodes, memory, ray) << ray
        if waiting == 0:
            return
        at_node, at_leaf = 0, 0
        left = waiting
        while left != 0:
            ray = lowest(left)
            left = left & (left - 1)
            node, leaf, last = advance(memory, ray)
            at_node = at_node | node << ray
            at_leaf = at_leaf | leaf << ray
            waiting = waiting ^ last << ray
        for_each_kind(visit_leaves_of_kind, tree.groups, 0, (visit, at_leaf, tree, memory))


def descend(nodes: Any, memory: Any, ray: int) -> int:
    """Let the children of a node that a ray meets wait; 1 if there are any."""
    node = reference_of(memory[NEXT + ray])
    planes = near_planes(vec_at(memory, INVERSE, ray))
    met, near = intersect_boxes(nodes, node, memory, ray, planes, search_limit(memory[HIT + ray]))
    top = integer_at(memory, TOP + ray) + STACK_LEVEL
    put(memory, top, where(met, tag(near, load(nodes, node + REFERENCES)), inf))
    some = int(any(met))
    put_integer(memory, TOP + ray, top - STACK_LEVEL * (1 - some))
    return some


def advance(memory: Any, ray: int) -> tuple[int, int, int]:
    """Take the nearest child of the last node in which some wait. Three answers, 1 or 0: whether it is a node to visit,
    whether it is a leaf to visit, and whether none waits any more."""
    limit = search_limit(memory[HIT + ray])
    top = integer_at(memory, TOP + ray)
    tags = load(memory, top)
    nearest = least_lane(tags)
    others = where(tags == nearest, inf, tags)
    put(memory, top, others)
    top = top - STACK_LEVEL * (1 - int(any(others < limit)))
    put_integer(memory, TOP + ray, top)
    memory[NEXT + ray] = nearest
    matters = nearest < limit
    is_node = reference_of(nearest) >= 0
    return int(matters & is_node), int(matters & (not is_node)), int(top < STACK)


def visit_leaves_of_kind(group: Group, number: int, given: tuple[Callable[..., None], int, Tree, Any]) -> int:
    """Visit the leaves of one kind that rays are at; the state counts the kinds."""
    visit, left, tree, memory = given
    while left != 0:
        ray = lowest(left)
        left = left & (left - 1)
        leaf = leaf_number(reference_of(memory[NEXT + ray]))
        if leaf % len(tree.groups) == number:
            visit(group, leaf // len(tree.groups), tree, memory, ray)
    return number + 1
