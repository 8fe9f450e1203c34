"""Gathers the nodes of a binary tree into wide ones so that a ray meets as few as may be.

What a subtree costs as at most k nodes and leaves side by side follows from what its halves cost with fewer, so the
cheapest of all ways is found from the leaves up (Ylitie et al., Efficient Incoherent Ray Traversal on GPUs Through
Compressed Wide BVHs, 2017, 3.1).
"""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.bvh.build import BinaryTree, half_area
from minirt.kernel.bvh.nodes import MARGIN, NODE, WIDTH


def weigh(tree: BinaryTree, costs: Any, choices: Any) -> None:
    """The best for each node i of the binary tree.

    `costs[i, k]` (m, WIDTH + 1) is the least cost of its boxes in at most k places, in units of a node that every ray
    meets. `choices[i, k]` is how many of the k go to the first child, or 0 where k - 1 places are no worse; with k = 1,
    in a node of its own, the choice is for its `WIDTH` places.
    """
    for i in range(tree.links.shape[0] - 1, -1, -1):
        size, first = half_area(tree.bounds, i), tree.links[i, 2]
        for k in range(WIDTH, 1, -1):
            costs[i, k], choices[i, k] = inf, 0
            if first > 0:
                costs[i, k], choices[i, k] = best_division(costs, first, k)
        costs[i, 1], choices[i, 1] = size, 0
        if first > 0:
            costs[i, 1], choices[i, 1] = size + costs[i, WIDTH], choices[i, WIDTH]
        for k in range(2, WIDTH + 1):
            if costs[i, k] >= costs[i, k - 1]:
                costs[i, k], choices[i, k] = costs[i, k - 1], 0


def best_division(costs: Any, first: int, places: int) -> tuple[float, int]:
    """The least cost of two nodes in so many places, and the places of the first of them."""
    best, share = costs[first, 1] + costs[first + 1, places - 1], 1
    for k in range(2, places):
        cost = costs[first, k] + costs[first + 1, places - k]
        if cost < best:
            best, share = cost, k
    return best, share


def collapse(tree: BinaryTree, choices: Any, nodes: Any, leaves: Any, todo: Any, parts: Any) -> tuple[int, int]:
    """Write the wide nodes, of which leaf i is named -1 - i, and to `leaves` which nodes of the binary tree those are.

    `todo` (m, 2) and `parts` (WIDTH, 2) are room to work in. Returns how many nodes and leaves there are.
    """
    used, named, left = 1, 0, 1
    todo[0, 0], todo[0, 1] = 0, 0
    while left > 0:
        left -= 1
        binary, node = todo[left, 0], todo[left, 1]
        count = collect_children(tree.links, choices, binary, parts)
        for place in range(WIDTH):
            at = node * NODE + place
            if place >= count:
                write_child(nodes, at, tree.bounds, -1, 0.0)
            elif tree.links[parts[place, 0], 2] == 0:
                write_child(nodes, at, tree.bounds, parts[place, 0], -1.0 - named)
                leaves[named] = parts[place, 0]
                named += 1
            else:
                write_child(nodes, at, tree.bounds, parts[place, 0], float(used * NODE))
                todo[left, 0], todo[left, 1] = parts[place, 0], used
                left += 1
                used += 1
    return used, named


def collect_children(links: Any, choices: Any, node: int, parts: Any) -> int:
    """The nodes of the binary tree that are the children of a wide one, and their number; a leaf is its own child,
    but none where nothing is in it."""
    parts[0, 0], parts[0, 1] = node, 1
    if links[node, 2] == 0:
        return min(1, links[node, 1] - links[node, 0])
    done, count = 0, 1
    places = WIDTH
    share = choices[node, 1]
    while True:
        # Share the places of this part between its halves.
        first = links[parts[done, 0], 2]
        parts[done, 0], parts[done, 1] = first, share
        parts[count, 0], parts[count, 1] = first + 1, places - share
        count += 1
        while done < count:
            places = parts[done, 1]
            while places > 1 and choices[parts[done, 0], places] == 0:
                places -= 1
            share = choices[parts[done, 0], places]
            if places > 1:
                break
            done += 1
        if done == count:
            return count


def write_child(nodes: Any, at: int, reaches: Any, i: int, name: float) -> None:
    """A child of a wide node: its box, grown by `MARGIN`, and its name; a box that no ray meets for i = -1."""
    size = 0.0
    for k in range(6):
        size = max(size, abs(reaches[i, k]))
    for k in range(3):
        nodes[at + k * WIDTH] = -reaches[i, k] - MARGIN * size if i >= 0 else inf
        nodes[at + (3 + k) * WIDTH] = reaches[i, 3 + k] + MARGIN * size if i >= 0 else -inf
    nodes[at + 6 * WIDTH] = name
