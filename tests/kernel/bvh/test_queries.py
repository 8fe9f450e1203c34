"""Rays that share no origin hit the same with a tree as without one, and what is nearer hides."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numba import njit, typeof

import minirt.kernel.compiler.jit  # noqa: F401  (attaches the compiler)
from minirt.kernel.bvh import queries
from minirt.kernel.bvh.nodes import WIDTH
from minirt.kernel.compiler.options import FLAGS
from minirt.kernel.scene_arrays import by_reference
from minirt.lanes import Vec, lane, load, where
from minirt.shapes import KINDS
from minirt.shapes.cylinder import Cylinder
from tests.kernel.bvh.trees import Interpreted, brute_force, build_tree, random_rays, random_shapes, trace
from tests.shapes.examples import example

REGIMES: dict[str, dict[str, float]] = {
    "usual": {},
    "crowded": {"spread": 0.5},
    "sparse": {"spread": 100.0},
    "tiny": {"size": 1e-9},
    "huge": {"size": 1e9},
    "far": {"offset": 1e8},
    "tiny and far": {"size": 1e-5, "offset": 1e4},
}


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("count", [1, 20, 400])
def test_rays_hit_what_they_hit_without_boxes(regime: str, count: int) -> None:
    random = np.random.default_rng(count)
    shapes = random_shapes(random, count, **REGIMES[regime])
    rays = random_rays(random, shapes, 20_000)
    found, right = trace(build_tree(shapes), *rays), trace(brute_force(shapes), *rays)
    assert (right[1] >= 0).mean() > 0.05
    assert np.array_equal(found[1], right[1])
    hit = right[1] >= 0
    rounding = 1e-15 * np.median(right[0][hit])  # of the sizes of the shapes
    assert np.allclose(found[0][hit], right[0][hit], rtol=1e-11, atol=rounding)


@cache
def shadows() -> Any:
    """`unhidden`, compiled, for n rays of unit direction, a multiple of `WIDTH`."""

    def run(scene: Any, o: Any, d: Any, distances: Any, free: Any) -> None:
        tree = by_reference(scene)
        for i in range(0, distances.size, WIDTH):
            origin = Vec(load(o[0], i), load(o[1], i), load(o[2], i))
            direction = Vec(load(d[0], i), load(d[1], i), load(d[2], i))
            distance = load(distances, i)
            answer = where(queries.unoccluded(tree, origin, direction, distance, distance > 0.0), 1.0, 0.0 * distance)
            for ray in range(WIDTH):
                free[i + ray] = lane(answer, ray)

    return run, njit(**FLAGS)(run)


@pytest.mark.parametrize("way", [0, 1], ids=["interpreted", "compiled"])
@pytest.mark.parametrize("count", [5, 20, 400])
def test_what_is_nearer_hides(way: int, count: int) -> None:
    random = np.random.default_rng(count)
    shapes = random_shapes(random, count)
    origins, directions = random_rays(random, shapes, 20 * WIDTH)
    scene = build_tree(shapes)
    found = trace(scene, origins, directions)
    hit = found[1] >= 0
    assert 0.05 < hit.mean() < 1
    for factor, seen in ((1 - 1e-9, True), (1 + 1e-9, False), (1e6, False), (-1.0, False)):
        distances = np.where(hit, found[0] * factor, 1e9 * np.sign(factor))
        free = np.full(len(hit), 7.0)
        with np.errstate(all="ignore"):
            shadows()[way](scene, origins.T.copy(), directions.T.copy(), distances, free)
        # Nothing is asked of rays with a distance below 0, and what is not asked for is not free.
        assert np.array_equal(free, np.where(hit, seen, factor > 0))


def test_interpreted_rays_hit_the_same() -> None:
    random = np.random.default_rng(5)
    shapes = random_shapes(random, 60)
    rays = random_rays(random, shapes, 5 * WIDTH + 3)
    for one, other in zip(
        trace(build_tree(shapes), *rays), trace(build_tree(shapes, Interpreted), *rays, queries.trace_rays), strict=True
    ):
        assert np.allclose(one, other, rtol=1e-12, atol=1e-12, equal_nan=True)


@pytest.mark.parametrize("seed", range(6))
def test_of_surfaces_that_coincide_the_first_is_hit(seed: int) -> None:
    random = np.random.default_rng(seed)
    ends = [example(kind, random) for kind in KINDS]
    others = random_shapes(random, 200, size=0.3, offset=0.0, spread=20)
    twins = [each.replace(colour=(i, 0, 0)) for i in range(3) for each in ends]
    shapes = [*others[:50], *twins, *others[50:]]
    origins, directions = random_rays(random, ends, 4000)
    _, owners, *_ = trace(build_tree(shapes), origins, directions)
    last = 50 + len(ends)
    assert (owners >= 50).sum() > 500
    assert not ((owners >= last) & (owners < 50 + len(twins))).any()


def test_of_caps_in_one_plane_the_first_is_hit() -> None:
    # Boxes begin where the caps are: one that is entered no nearer than the hit so far must be looked into.
    random = np.random.default_rng(2)
    x, z, radius, height = random.uniform([-10, -10, 0.1, 0.1], [10, 10, 3, 5], (400, 4)).T
    columns = [
        Cylinder((x[i], 1 - height[i] / 2, z[i]), (0, 1, 0), 2 * radius[i], height[i], (0, 0, 0)) for i in range(400)
    ]
    origins = random.uniform([-10, 3, -10], [10, 40, 10], (4000, 3))
    covers = (origins[:, :1] - x) ** 2 + (origins[:, 2:] - z) ** 2 < radius**2
    distances, owners, *_ = trace(build_tree(columns), origins, np.tile([0.0, -1.0, 0.0], (4000, 1)))
    assert np.array_equal(owners, np.where(covers.any(axis=1), covers.argmax(axis=1), -1))
    assert np.allclose(distances[owners >= 0], origins[owners >= 0, 1] - 1, atol=1e-14)


def test_scenes_of_the_same_kinds_share_a_kernel() -> None:
    random = np.random.default_rng(0)
    sorts = {typeof(build_tree(random_shapes(random, count))) for count in (len(KINDS), 17, 90, 1000)}
    assert len(sorts) == 1
