"""Collapse of a binary BVH into a wide one of least surface area heuristic (SAH) cost.

The cost of a subtree as at most k nodes and leaves side by side follows from the costs of its halves with fewer, so
dynamic programming from the leaves up finds the cheapest tree (Ylitie et al., Efficient Incoherent Ray Traversal on
GPUs Through Compressed Wide BVHs, 2017, 3.1).
"""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.bvh.build import BinaryTree, half_area
from minirt.kernel.bvh.nodes import MARGIN, NODE, WIDTH


def weigh(tree: BinaryTree, costs: Any, choices: Any) -> None:
    """Compute the least cost of each subtree of the binary tree, and the choices that lead to it.

    `costs[i, k]` (m, WIDTH + 1) is the least cost of the boxes of node i in at most k places of a wide node, in units
    of a node that every ray hits. `choices[i, k]` is how many of the k places go to the first child, or 0 if k - 1
    places cost no more; for k = 1, a wide node of its own, the choice is for the `WIDTH` places of that node.
    """
    for i in range(tree.links.shape[0] - 1, -1, -1):
        size, first = half_area(tree.bounds, i), tree.links[i, 2]
        for k in range(WIDTH, 1, -1):
            costs[i, k], choices[i, k] = inf, 0
            if first > 0:
                costs[i, k], choices[i, k] = best_share(costs, first, k)
        costs[i, 1], choices[i, 1] = size, 0
        if first > 0:
            costs[i, 1], choices[i, 1] = size + costs[i, WIDTH], choices[i, WIDTH]
        for k in range(2, WIDTH + 1):
            if costs[i, k] >= costs[i, k - 1]:
                costs[i, k], choices[i, k] = costs[i, k - 1], 0


def best_share(costs: Any, first: int, places: int) -> tuple[float, int]:
    """Find the least cost of two nodes in so many places, and the places that go to the first of them."""
    least, share = costs[first, 1] + costs[first + 1, places - 1], 1
    for k in range(2, places):
        cost = costs[first, k] + costs[first + 1, places - k]
        if cost < least:
            least, share = cost, k
    return least, share


def collapse(tree: BinaryTree, choices: Any, nodes: Any, leaves: Any, stack: Any, parts: Any) -> tuple[int, int]:
    """Write the wide nodes, and to `leaves` the binary node of each leaf; returns the numbers of nodes and leaves.

    The reference to leaf i is -1 - i. `stack` (m, 2) and `parts` (WIDTH, 2) are working memory.
    """
    node_count, leaf_count, waiting = 1, 0, 1
    stack[0, 0], stack[0, 1] = 0, 0
    while waiting > 0:
        waiting -= 1
        binary, node = stack[waiting, 0], stack[waiting, 1]
        count = collect_children(tree.links, choices, binary, parts)
        for place in range(WIDTH):
            at = node * NODE + place
            if place >= count:
                write_child(nodes, at, tree.bounds, -1, 0.0)
            elif tree.links[parts[place, 0], 2] == 0:
                write_child(nodes, at, tree.bounds, parts[place, 0], -1.0 - leaf_count)
                leaves[leaf_count] = parts[place, 0]
                leaf_count += 1
            else:
                write_child(nodes, at, tree.bounds, parts[place, 0], float(node_count * NODE))
                stack[waiting, 0], stack[waiting, 1] = parts[place, 0], node_count
                waiting += 1
                node_count += 1
    return node_count, leaf_count


def collect_children(links: Any, choices: Any, node: int, parts: Any) -> int:
    """Write to `parts` the binary nodes that become the children of a wide node, and return their number.

    The only child of a leaf is the leaf itself, or none if the leaf is empty.
    """
    parts[0, 0], parts[0, 1] = node, 1
    if links[node, 2] == 0:
        return min(1, links[node, 1] - links[node, 0])
    done, count = 0, 1
    places = WIDTH
    share = choices[node, 1]
    while True:
        # Divide the places of this part among its halves.
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


def write_child(nodes: Any, at: int, bounds: Any, i: int, reference: float) -> None:
    """Write a child of a wide node: box i, grown by `MARGIN`, and a reference; for i = -1 a box that no ray hits."""
    size = 0.0
    for k in range(6):
        size = max(size, abs(bounds[i, k]))
    for k in range(3):
        nodes[at + k * WIDTH] = -bounds[i, k] - MARGIN * size if i >= 0 else inf
        nodes[at + (3 + k) * WIDTH] = bounds[i, 3 + k] + MARGIN * size if i >= 0 else -inf
    nodes[at + 6 * WIDTH] = reference
