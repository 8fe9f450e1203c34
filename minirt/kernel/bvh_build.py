"""Construction of a binary BVH by the surface area heuristic (SAH), which `minirt.kernel.bvh_collapse` makes wide.

The tree is built with bins (Wald, On Fast Construction of SAH-based Bounding Volume Hierarchies, 2007). A box is
six numbers, its bounds towards -x, -y, -z, x, y and z: the bounds of two boxes are the maximum of each.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from minirt.kernel.bvh_nodes import WIDE, packet_memory
from minirt.kernel.pixels import fetch_add
from minirt.kernel.scene_arrays import LEVELS
from minirt.lanes import maximum

BINS = 16  # bins along an axis
INDEX, GROUP = 6, 7  # columns of `boxes`, behind the bounds
BIN = 7  # numbers of a bin: bounds and number of the boxes in it
# Offsets in the memory of a thread: the bins, of which the last is several together; the SAH cost of the boxes above
# each bin; bounds of the centres, times two, of a node's boxes; nodes still to divide, and their levels.
SEVERAL = BINS * BIN
COSTS = SEVERAL + BIN
CENTRES = COSTS + BINS
STACK = CENTRES + 6


class BinaryTree(NamedTuple):
    """A binary tree over n boxes, each node a range of them. Both children of a node have higher numbers than it."""

    boxes: Any  # (n, 8) bounds, index and group of each shape, in the order of the leaves
    bounds: Any  # (m, 6) bounds of each node
    links: Any  # (m, 3) first box of a node, the box behind its last, and the first of its two children; 0: a leaf
    found: Any  # (2,) the number of nodes, and what `collapse` finds


def divide(next_root: Any, tree: BinaryTree, roots: Any, most: int) -> None:
    """Divide nodes, taking them from the counter `next_root` until none is left, until each leaf has one group and at
    most `WIDE` boxes.

    Any number of threads may do so at the same time. `roots` (r, 2) are nodes and their levels. Of nodes below them
    those with at most `most` boxes are left, marked by -1 - level in place of a child. The tree is the same whatever is
    left and whoever divides it, but for the numbers of its nodes.
    """
    memory, links = packet_memory(), tree.links
    while True:
        root = fetch_add(next_root, 1)
        if root >= roots.shape[0]:
            return
        memory[STACK], memory[STACK + 1] = roots[root, 0], roots[root, 1]
        top = STACK + 2
        while top > STACK:
            top -= 2
            node, level = int(memory[top]), int(memory[top + 1])
            start, stop = links[node, 0], links[node, 1]
            if stop - start <= most and level > roots[root, 1]:
                links[node, 2] = -1 - level
                continue
            fit_bounds(tree, node, memory)
            links[node, 2] = 0
            if stop - start > WIDE or has_mixed_groups(tree.boxes, start, stop):
                middle, child = partition(tree, start, stop, level, memory), fetch_add(tree.found, 2)
                links[node, 2] = child
                links[child, 0], links[child, 1] = start, middle
                links[child + 1, 0], links[child + 1, 1] = middle, stop
                for i in range(2):
                    memory[top], memory[top + 1] = child + i, level + 1
                    top += 2


def has_mixed_groups(boxes: Any, start: int, stop: int) -> bool:
    """Whether the boxes of a range are of different groups."""
    i = start
    while i < stop and boxes[i, GROUP] == boxes[start, GROUP]:
        i += 1
    return i < stop


def fit_bounds(tree: BinaryTree, node: int, memory: Any) -> None:
    """Compute the bounds of a node's boxes, and the bounds of their centres."""
    boxes, bounds = tree.boxes, tree.bounds
    for k in range(6):
        bounds[node, k] = -inf
        memory[CENTRES + k] = -inf
    for i in range(tree.links[node, 0], tree.links[node, 1]):
        for k in range(6):
            bounds[node, k] = maximum(boxes[i, k], bounds[node, k])
        for k in range(3):
            centre = boxes[i, 3 + k] - boxes[i, k]
            memory[CENTRES + k] = maximum(-centre, memory[CENTRES + k])
            memory[CENTRES + 3 + k] = maximum(centre, memory[CENTRES + 3 + k])


def partition(tree: BinaryTree, start: int, stop: int, level: int, memory: Any) -> int:
    """Partition the boxes of a range at the best split, and return the first box of the second part."""
    boxes = tree.boxes
    if stop - start <= WIDE:
        return partition_by_group(boxes, start, stop)
    axis, last = best_split(tree, start, stop, memory)
    if axis < 0 or stop - start > WIDE << (LEVELS - 1 - level):  # all centres coincide, or too deep: halves
        return (start + stop) // 2
    low, scale = bin_scale(memory, axis)
    while start < stop:
        if bin_index(boxes, start, axis, low, scale) <= last:
            start += 1
        else:
            stop -= 1
            swap(boxes, start, stop)
    return start


def partition_by_group(boxes: Any, start: int, stop: int) -> int:
    """Partition the boxes of a range into those of the first box's group and all others."""
    middle = start + 1
    for i in range(start + 1, stop):
        if boxes[i, GROUP] == boxes[start, GROUP]:
            swap(boxes, i, middle)
            middle += 1
    return middle


def swap(boxes: Any, i: int, j: int) -> None:
    """Swap two boxes."""
    for k in range(8):
        boxes[i, k], boxes[j, k] = boxes[j, k], boxes[i, k]


def best_split(tree: BinaryTree, start: int, stop: int, memory: Any) -> tuple[int, int]:
    """Find the axis of the best split, and the last bin of its first part; axis -1 if no split divides the boxes."""
    least, best_axis, last = inf, -1, 0
    for axis in range(3):
        low, scale = bin_scale(memory, axis)
        if scale < inf:
            fill_bins(tree.boxes, start, stop, axis, low, scale, memory)
            cost, bin_below = best_bin(memory)
            if cost < least:
                least, best_axis, last = cost, axis, bin_below
    return best_axis, last


def bin_scale(memory: Any, axis: int) -> tuple[float, float]:
    """Return the coordinate, times two, at which the first bin begins, and the number of bins per unit of it."""
    low, high = -memory[CENTRES + axis], memory[CENTRES + 3 + axis]
    return low, BINS / (high - low)


def bin_index(boxes: Any, i: int, axis: int, low: float, scale: float) -> int:
    """Return the bin of a box, by its centre."""
    return min(int((boxes[i, 3 + axis] - boxes[i, axis] - low) * scale), BINS - 1)


def fill_bins(boxes: Any, start: int, stop: int, axis: int, low: float, scale: float, memory: Any) -> None:
    """Gather the bounds and numbers of the boxes of a range in bins, by their centres."""
    for b in range(BINS):
        clear_bin(memory, BIN * b)
    for i in range(start, stop):
        at = BIN * bin_index(boxes, i, axis, low, scale)
        for k in range(6):
            memory[at + k] = maximum(boxes[i, k], memory[at + k])
        memory[at + 6] += 1.0


def best_bin(memory: Any) -> tuple[float, int]:
    """Find the least cost of a split between two bins, and the bin below that split."""
    clear_bin(memory, SEVERAL)
    for b in range(BINS - 1, 0, -1):
        merge_bin(memory, BIN * b)
        memory[COSTS + b - 1] = sah_cost(memory)
    clear_bin(memory, SEVERAL)
    least, last = inf, 0
    for b in range(BINS - 1):
        merge_bin(memory, BIN * b)
        cost = sah_cost(memory) + memory[COSTS + b]
        if cost < least:
            least, last = cost, b
    return least, last


def clear_bin(memory: Any, at: int) -> None:
    """Empty a bin."""
    for k in range(6):
        memory[at + k] = -inf
    memory[at + 6] = 0.0


def merge_bin(memory: Any, at: int) -> None:
    """Merge a bin into the last one."""
    for k in range(6):
        memory[SEVERAL + k] = maximum(memory[at + k], memory[SEVERAL + k])
    memory[SEVERAL + 6] += memory[at + 6]


def sah_cost(memory: Any) -> float:
    """Return the SAH cost of the boxes in the last bin: half of their surface area times the leaves that they fill."""
    leaves = (int(memory[SEVERAL + 6]) + WIDE - 1) // WIDE
    return half_area(memory, SEVERAL) * leaves if leaves > 0 else inf


def half_area(bounds: Any, at: int) -> float:
    """Return half of the surface area of a box, whose bounds begin at an index."""
    x, y, z = bounds[at] + bounds[at + 3], bounds[at + 1] + bounds[at + 4], bounds[at + 2] + bounds[at + 5]
    return x * y + y * z + z * x
