"""Sorts boxes into a binary tree by the surface area heuristic, with bins (Wald, On Fast Construction of SAH-based
Bounding Volume Hierarchies, 2007).

How far a box reaches is six numbers, towards -x, -y, -z, x, y and z: the reach of two boxes is the larger of each.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from minirt.kernel.bvh.nodes import LEVELS, WIDTH
from minirt.lanes import maximum

BINS = 16
INDEX, GROUP = 6, 7  # columns of a box, behind its reach


class BinaryTree(NamedTuple):
    """A binary tree over n boxes, in which a node is a range of them. Both children of a node come behind it."""

    boxes: Any  # (n, 8) reach, index and group of each shape, in the order of the leaves
    bounds: Any  # (m, 6) of each node
    links: Any  # (m, 3) its first box, the box behind its last, and its first child, of two in a row, or 0 for a leaf
    bins: Any  # (BINS + 1, 7) reach and number of the boxes in each bin, and of some of them together
    costs: Any  # (BINS,) of what lies above each bin
    centres: Any  # (6,) how far twice the centres of a node's boxes reach
    stack: Any  # (m, 2) nodes to divide, and their levels


def divide(tree: BinaryTree) -> int:
    """Divide all boxes until each range is a leaf, of one group and at most `WIDTH` boxes; the number of nodes."""
    links = tree.links
    links[0, 0], links[0, 1] = 0, tree.boxes.shape[0]
    tree.stack[0, 0], tree.stack[0, 1] = 0, 0
    used, left = 1, 1
    while left > 0:
        left -= 1
        node, level = tree.stack[left, 0], tree.stack[left, 1]
        start, stop = links[node, 0], links[node, 1]
        fit_bounds(tree, node)
        links[node, 2] = 0
        if stop - start > WIDTH or has_mixed_groups(tree.boxes, start, stop):
            middle = partition(tree, start, stop, level)
            links[node, 2] = used
            links[used, 0], links[used, 1] = start, middle
            links[used + 1, 0], links[used + 1, 1] = middle, stop
            for child in range(2):
                tree.stack[left + child, 0], tree.stack[left + child, 1] = used + child, level + 1
            left += 2
            used += 2
    return used


def has_mixed_groups(boxes: Any, start: int, stop: int) -> bool:
    """Whether boxes of a range are of different groups."""
    same = start
    while same < stop and boxes[same, GROUP] == boxes[start, GROUP]:
        same += 1
    return same < stop


def fit_bounds(tree: BinaryTree, node: int) -> None:
    """How far the boxes of a node reach, and their centres."""
    boxes, reaches, centres = tree.boxes, tree.bounds, tree.centres
    for k in range(6):
        reaches[node, k] = -inf
        centres[k] = -inf
    for i in range(tree.links[node, 0], tree.links[node, 1]):
        for k in range(6):
            reaches[node, k] = maximum(boxes[i, k], reaches[node, k])
        for k in range(3):
            centre = boxes[i, 3 + k] - boxes[i, k]
            centres[k] = maximum(-centre, centres[k])
            centres[3 + k] = maximum(centre, centres[3 + k])


def partition(tree: BinaryTree, start: int, stop: int, level: int) -> int:
    """Sort the boxes of a range into two, and return where the second begins."""
    boxes = tree.boxes
    if stop - start <= WIDTH:
        return partition_by_group(boxes, start, stop)
    axis, last = best_split(tree, start, stop)
    if axis < 0 or stop - start > WIDTH << (LEVELS - 1 - level):  # all in one place, or too many for halves from here
        return (start + stop) // 2
    low, scale = bin_scale(tree.centres, axis)
    while start < stop:
        if bin_index(boxes, start, axis, low, scale) <= last:
            start += 1
        else:
            stop -= 1
            swap(boxes, start, stop)
    return start


def partition_by_group(boxes: Any, start: int, stop: int) -> int:
    """`partition` into those of the group of the first, and the others."""
    middle = start + 1
    for i in range(start + 1, stop):
        if boxes[i, GROUP] == boxes[start, GROUP]:
            swap(boxes, i, middle)
            middle += 1
    return middle


def swap(boxes: Any, i: int, j: int) -> None:
    for k in range(8):
        boxes[i, k], boxes[j, k] = boxes[j, k], boxes[i, k]


def best_split(tree: BinaryTree, start: int, stop: int) -> tuple[int, int]:
    """The axis along which to split, and the last bin of the first part; -1 where no split divides the boxes."""
    best, axis, last = inf, -1, 0
    for each in range(3):
        low, scale = bin_scale(tree.centres, each)
        if scale < inf:
            fill_bins(tree, start, stop, each, low, scale)
            cost, place = best_bin(tree.bins, tree.costs)
            if cost < best:
                best, axis, last = cost, each, place
    return axis, last


def bin_scale(centres: Any, axis: int) -> tuple[float, float]:
    """Where the first bin begins, and bins per length."""
    low, high = -centres[axis], centres[3 + axis]
    return low, BINS / (high - low)


def bin_index(boxes: Any, i: int, axis: int, low: float, scale: float) -> int:
    return min(int((boxes[i, 3 + axis] - boxes[i, axis] - low) * scale), BINS - 1)


def fill_bins(tree: BinaryTree, start: int, stop: int, axis: int, low: float, scale: float) -> None:
    """Sort the boxes of a range into bins by their centres."""
    boxes, bins = tree.boxes, tree.bins
    for b in range(BINS):
        clear_bin(bins, b)
    for i in range(start, stop):
        b = bin_index(boxes, i, axis, low, scale)
        for k in range(6):
            bins[b, k] = maximum(boxes[i, k], bins[b, k])
        bins[b, 6] += 1.0


def best_bin(bins: Any, costs: Any) -> tuple[float, int]:
    """The least cost of a split between bins, and the bin below it."""
    clear_bin(bins, BINS)
    for b in range(BINS - 1, 0, -1):
        merge_bin(bins, b)
        costs[b - 1] = sah_cost(bins)
    clear_bin(bins, BINS)
    best, last = inf, 0
    for b in range(BINS - 1):
        merge_bin(bins, b)
        cost = sah_cost(bins) + costs[b]
        if cost < best:
            best, last = cost, b
    return best, last


def clear_bin(bins: Any, b: int) -> None:
    for k in range(6):
        bins[b, k] = -inf
    bins[b, 6] = 0.0


def merge_bin(bins: Any, b: int) -> None:
    """Take the boxes of a bin to those in the last row."""
    for k in range(6):
        bins[BINS, k] = maximum(bins[b, k], bins[BINS, k])
    bins[BINS, 6] += bins[b, 6]


def sah_cost(bins: Any) -> float:
    """How often rays meet the box around those in the last row, times the leaves that they fill."""
    leaves = (int(bins[BINS, 6]) + WIDTH - 1) // WIDTH
    return half_area(bins, BINS) * leaves if leaves > 0 else inf


def half_area(reaches: Any, i: int) -> float:
    """Half of the surface of a box."""
    x, y, z = reaches[i, 0] + reaches[i, 3], reaches[i, 1] + reaches[i, 4], reaches[i, 2] + reaches[i, 5]
    return x * y + y * z + z * x
