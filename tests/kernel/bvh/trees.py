"""Trees over random shapes, the same shapes without a tree, and rays through them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel.bvh import build, collapse
from minirt.kernel.bvh.nodes import WIDTH, Group, Tree
from minirt.kernel.compiler import jit_bvh
from minirt.rendering.packing.bvh import aligned, block_type, bvh_of
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import KINDS, Shape
from tests.shapes.examples import example, place
from tests.shapes.regimes import Array, Random, log, unit, ways


class Interpreted:
    """The functions that build a tree, interpreted."""

    divide = staticmethod(build.divide)
    weigh = staticmethod(collapse.weigh)
    collapse = staticmethod(collapse.collapse)


def build_tree(shapes: list[Shape], kernel: Any = jit_bvh) -> Tree:
    """The tree over shapes."""
    with np.errstate(all="ignore"):
        return bvh_of(shape_arrays(shapes), kernel)


def brute_force(shapes: list[Shape]) -> Tree:
    """The shapes in no box, so that every ray tries them all."""
    kept = shape_arrays(shapes)
    kinds = [kind for kind in KINDS if kind.element in set(map(type, shapes))]
    groups = []
    for i, (kind, rows) in enumerate(zip(kinds, kept.rows, strict=True)):
        labels = np.zeros((0, WIDTH, 2))
        groups.append(Group(rows, aligned(0, block_type(kind)), labels, np.flatnonzero(kept.slots[:, 0] == i)))
    root = np.repeat([np.inf, -np.inf, 0.0], [3 * WIDTH, 3 * WIDTH, WIDTH])
    return Tree(root, kept.colours_and_extents[:, 3].copy(), kept.slots, tuple(groups))


def shape_arrays(shapes: list[Shape]) -> ShapeArrays:
    made = ShapeArrays()
    made.update(tuple(shapes))
    return made


def trace(
    scene: Tree, origins: Array, directions: Array, run: Callable[..., None] = jit_bvh.trace_rays
) -> tuple[Array, Array, Array, Array]:
    """Distances, owners, points and normals of rays."""
    n = len(origins)
    found = np.full(n, np.inf), np.full(n, -1), np.full((n, 3), np.nan), np.full((n, 3), np.nan)
    with np.errstate(all="ignore"):
        run(np.zeros(1, np.int64), scene, origins, directions, *found)
    return found


def random_shapes(
    random: Random, count: int, size: float = 1.0, offset: float = 0.0, spread: float = 4.0
) -> list[Shape]:
    """Shapes of every kind, of many sizes and in one another; those without end are few."""
    middle = offset * ways(random)
    made = [example(KINDS[i % len(KINDS)], random, size * log(random, 0.05, 2)) for i in range(count)]
    kept = [each for i, each in enumerate(made) if each.bounds() or i < 6]
    return [moved(each, middle + size * spread * random.normal(size=3)) for each in kept]


def moved(shape: Shape, by: Array) -> Shape:
    """A shape in another place."""
    names = [each.name for each in fields_of(type(shape)) if isinstance(each, Point)]
    return shape.replace(**{name: tuple(np.add(getattr(shape, name), by)) for name in names})


def random_rays(random: Random, shapes: list[Shape], count: int) -> tuple[Array, Array]:
    """Rays from inside of shapes and from between them, a third of them along axes."""
    middles = np.stack([place(each) for each in shapes])
    size = max(np.ptp(middles, axis=0).max(), 1e-9 * np.abs(middles).max())
    origins = middles[random.integers(len(shapes), size=count)]
    origins = origins + size * log(random, 1e-4, 1, count, 1) * ways(random, count)
    aims = middles[random.integers(len(shapes), size=count)] + 0.02 * size * random.normal(size=(count, 3))
    axes = np.eye(3)[random.integers(3, size=count)] * random.choice([-1.0, 1.0], size=(count, 1))
    return origins, unit(np.where(np.arange(count)[:, None] % 3 == 0, axes, aims - origins))
