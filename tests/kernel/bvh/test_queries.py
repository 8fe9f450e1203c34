"""Queries through the BVH: closest hits and occlusion are those found without boxes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel import bvh_traversal, ray_batches
from minirt.kernel.bvh_nodes import WIDTH
from minirt.lanes import Vec, lane, load, where
from minirt.shapes import KINDS, Cylinder
from tests.kernel.bvh.test_bvh import (
    brute_force,
    build_tree,
    coherent,
    random_rays,
    random_shapes,
    sphere,
    trace,
    without_boxes,
)
from tests.shapes.examples import example
from tests.shapes.execution_modes import run_compiled
from tests.shapes.regimes import random_directions, unit

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
@pytest.mark.parametrize("is_coherent", [False, True])
def test_rays_hit_what_they_hit_without_boxes(regime: str, count: int, is_coherent: bool) -> None:
    random = np.random.default_rng(count)
    shapes = random_shapes(random, count, **REGIMES[regime])
    rays = random_rays(random, shapes, 8000)
    if is_coherent:
        rays = coherent(random, rays)
    tree = build_tree(shapes)
    result, expected = trace(tree, *rays), trace(without_boxes(tree), *rays)
    # And the tree without boxes misses no shape that one without nodes hits.
    few = [part[: 4 * WIDTH] for part in rays]
    assert np.array_equal(trace(brute_force(shapes), *few, ray_batches.trace_rays)[1], expected[1][: 4 * WIDTH])
    assert (expected[1] >= 0).mean() > 0.05
    assert np.array_equal(result[1], expected[1])
    hit = expected[1] >= 0
    rounding = 1e-15 * np.median(expected[0][hit])  # relative to the sizes of the shapes
    assert np.allclose(result[0][hit], expected[0][hit], rtol=1e-11, atol=rounding)


@pytest.mark.parametrize("distance", [10.0, 1e5, 1e9])
def test_small_shapes_on_a_huge_one_are_hit_as_without_boxes(distance: float) -> None:
    random = np.random.default_rng(1)
    places = random.uniform(-10, 10, (300, 3)) * [1, 0, 1] + [0, 0.4, 0]
    shapes = [sphere(0, -1e8, 0, 2e8), *(sphere(*place, random.uniform(0.1, 1)) for place in places)]
    origins = places[random.integers(300, size=4000)] + distance * np.abs(random_directions(random, 4000))
    rays = origins, unit(places[random.integers(300, size=4000)] + 0.3 * random.normal(size=(4000, 3)) - origins)
    tree = build_tree(shapes)
    result, expected = trace(tree, *rays), trace(without_boxes(tree), *rays)
    assert np.array_equal(result[1], expected[1])
    assert np.array_equal(result[0], expected[0])
    assert (expected[1] > 0).sum() > 300


def shadow_queries(tree: Any, o: Any, d: Any, distances: Any, visible: Any) -> None:
    """Answer `unoccluded` for n rays of unit direction, a multiple of `WIDTH`."""
    for i in range(0, distances.shape[0], WIDTH):
        origin = Vec(load(o[0], i), load(o[1], i), load(o[2], i))
        direction = Vec(load(d[0], i), load(d[1], i), load(d[2], i))
        distance = load(distances, i)
        answer = where(bvh_traversal.unoccluded(tree, origin, direction, distance, distance > 0.0), 1.0, 0.0 * distance)
        for ray in range(WIDTH):
            visible[i + ray] = lane(answer, ray)


@pytest.mark.parametrize(("is_compiled", "count"), [(False, 5), (False, 20), (True, 400)])
@pytest.mark.parametrize("is_coherent", [False, True])
def test_nearer_shapes_occlude(is_compiled: bool, count: int, is_coherent: bool) -> None:
    random = np.random.default_rng(count)
    shapes = random_shapes(random, count)
    origins, directions = random_rays(random, shapes, 20 * WIDTH)
    if is_coherent:
        origins, directions = coherent(random, (origins, directions))
    scene = build_tree(shapes)
    result = trace(scene, origins, directions)
    hit = result[1] >= 0
    assert hit.mean() > 0.05
    for factor, is_visible in ((1 - 1e-9, True), (1 + 1e-9, False), (1e6, False), (-1.0, False)):
        distances = np.where(hit, result[0] * factor, 1e9 * np.sign(factor))
        visible = np.full(len(hit), 7.0)
        with np.errstate(all="ignore"):
            arguments = scene, origins.T.copy(), directions.T.copy(), distances, visible
            run_compiled(shadow_queries, *arguments) if is_compiled else shadow_queries(*arguments)
        # Rays with a negative distance are not active, and inactive rays are not visible.
        assert np.array_equal(visible, np.where(hit, is_visible, factor > 0))


@pytest.mark.parametrize("seed", range(6))
def test_the_first_of_coincident_surfaces_is_hit(seed: int) -> None:
    random = np.random.default_rng(seed)
    originals = [example(kind, random) for kind in KINDS]
    further = random_shapes(random, 200, size=0.3, offset=0.0, spread=20)
    twins = [each.replace(colour=(i, 0, 0)) for i in range(3) for each in originals]
    shapes = [*further[:50], *twins, *further[50:]]
    origins, directions = random_rays(random, originals, 4000)
    _, owners, *_ = trace(build_tree(shapes), origins, directions)
    second_copy = 50 + len(originals)
    assert (owners >= 50).sum() > 500
    assert not ((owners >= second_copy) & (owners < 50 + len(twins))).any()


def test_the_first_of_caps_in_one_plane_is_hit() -> None:
    # Boxes begin at the caps: a box whose entry is no nearer than the closest hit so far must still be visited.
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
