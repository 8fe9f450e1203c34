"""BVHs over random shapes, trees without boxes to compare them with, and random rays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel import bvh_build
from minirt.kernel.bvh_nodes import WIDTH, Group, Tree
from minirt.kernel.machine_code import functions
from minirt.rendering.packing.bvh import aligned, block_type, build_bvh
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import KINDS, Shape
from tests.shapes.examples import example, place
from tests.shapes.regimes import Array, Random, log_uniform, random_directions, unit


class Interpreted:
    """The functions that build a tree, interpreted."""

    divide = staticmethod(bvh_build.divide)
    weigh = staticmethod(bvh_build.weigh)
    collapse = staticmethod(bvh_build.collapse)


def build_tree(shapes: list[Shape], kernel: Any = functions) -> Tree:
    """Build the BVH over shapes."""
    with np.errstate(all="ignore"):
        return build_bvh(shape_arrays(shapes), kernel)


def brute_force(shapes: list[Shape]) -> Tree:
    """Return a tree whose shapes are all unbounded: every ray is tested against every shape."""
    arrays = shape_arrays(shapes)
    kinds = [kind for kind in KINDS if kind.element in set(map(type, shapes))]
    groups = []
    for i, (kind, rows) in enumerate(zip(kinds, arrays.rows, strict=True)):
        labels = np.zeros((0, WIDTH, 2))
        unbounded = np.flatnonzero(arrays.slots[:, 0] == i)
        groups.append(Group(rows, aligned(0, block_type(kind)), labels, unbounded, i))
    root = np.repeat([np.inf, -np.inf, 0.0], [3 * WIDTH, 3 * WIDTH, WIDTH])
    return Tree(root, arrays.colours_and_extents[:, 3].copy(), arrays.slots, tuple(groups))


def shape_arrays(shapes: list[Shape]) -> ShapeArrays:
    """Pack shapes."""
    arrays = ShapeArrays()
    arrays.update(tuple(shapes))
    return arrays


def trace(
    scene: Tree, origins: Array, directions: Array, run: Callable[..., None] = functions.trace_rays
) -> tuple[Array, Array, Array, Array]:
    """Trace rays: distances, owners, points and normals of their closest hits."""
    n = len(origins)
    result = np.full(n, np.inf), np.full(n, -1), np.full((n, 3), np.nan), np.full((n, 3), np.nan)
    with np.errstate(all="ignore"):
        run(np.zeros(1, np.int64), scene, origins, directions, *result)
    return result


def random_shapes(
    random: Random, count: int, size: float = 1.0, offset: float = 0.0, spread: float = 4.0
) -> list[Shape]:
    """Return random shapes of every kind and many sizes that overlap each other; only a few are unbounded."""
    middle = offset * random_directions(random)
    shapes = [example(KINDS[i % len(KINDS)], random, size * log_uniform(random, 0.05, 2)) for i in range(count)]
    few_unbounded = [each for i, each in enumerate(shapes) if each.bounds() or i < 6]
    return [moved(each, middle + size * spread * random.normal(size=3)) for each in few_unbounded]


def moved(shape: Shape, by: Array) -> Shape:
    """Return a shape moved by a vector."""
    names = [each.name for each in fields_of(type(shape)) if isinstance(each, Point)]
    return shape.replace(**{name: tuple(np.add(getattr(shape, name), by)) for name in names})


def random_rays(random: Random, shapes: list[Shape], count: int) -> tuple[Array, Array]:
    """Return origins and directions of rays from inside of shapes and between them, a third of them along axes."""
    centres = np.stack([place(each) for each in shapes])
    size = max(np.ptp(centres, axis=0).max(), 1e-9 * np.abs(centres).max())
    origins = centres[random.integers(len(shapes), size=count)]
    origins = origins + size * log_uniform(random, 1e-4, 1, count, 1) * random_directions(random, count)
    aims = centres[random.integers(len(shapes), size=count)] + 0.02 * size * random.normal(size=(count, 3))
    axes = np.eye(3)[random.integers(3, size=count)] * random.choice([-1.0, 1.0], size=(count, 1))
    return origins, unit(np.where(np.arange(count)[:, None] % 3 == 0, axes, aims - origins))
