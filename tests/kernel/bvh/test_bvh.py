"""BVHs over random shapes, trees without boxes to compare them with, and random rays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from minirt.element import fields_of
from minirt.fields import Point
from minirt.kernel import bvh_build, bvh_collapse, bvh_leaves, bvh_rays, bvh_traversal, functions, ray_batches
from minirt.kernel.bvh_leaves import all_leaves, visit_leaves
from minirt.kernel.bvh_nodes import (
    CENTRE,
    DEEPEST,
    DIRECTION,
    FACTOR,
    HIT,
    MARGIN,
    NODE,
    ORIGIN,
    REFERENCES,
    ROUNDING,
    WIDE,
    WIDTH,
    LeafGroup,
    Tree,
    packet_memory,
)
from minirt.kernel.bvh_rays import RayPacket
from minirt.kernel.bvh_single_rays import traverse
from minirt.lanes import Vec, save, save_vec
from minirt.rendering.packing import bvh
from minirt.rendering.packing.bvh import aligned, block_type, build_bvh, wide_nodes
from minirt.rendering.packing.generic_kernels import FULL_DOUBLE, empty_arrays, generalised
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.threads import Job, ThreadPool
from minirt.shapes import KINDS, Cylinder, Plane, Shape, Sphere
from tests.shapes.examples import example, place
from tests.shapes.regimes import Array, Random, log_uniform, random_directions, unit

ENDLESS = 2.0**40  # farther than any shape, in the space of a tree


class Interpreted:
    """The functions that build a tree, interpreted."""

    divide = staticmethod(bvh_build.divide)
    collapse = staticmethod(bvh_collapse.collapse)


def build_tree(shapes: list[Shape], kernel: Any = functions) -> Tree:
    """Build the BVH over shapes."""
    with np.errstate(all="ignore"):
        return build_bvh(shape_arrays(shapes), kernel)


def without_boxes(scene: Tree) -> Tree:
    """Return a tree whose boxes reach everywhere: every ray is tested against every shape, by the same kernel."""
    nodes = scene.nodes.reshape(-1, NODE // WIDE, WIDE).copy()
    used = nodes[:, :1] < np.inf
    nodes[:, :6] = np.where(used, np.repeat([-ENDLESS, ENDLESS], 3)[:, None], nodes[:, :6])
    return scene._replace(nodes=nodes.ravel())


def brute_force(shapes: list[Shape]) -> Tree:
    """Return a tree without nodes, all of whose shapes are unbounded."""
    arrays = shape_arrays(shapes)
    kinds = [kind for kind in KINDS if kind.element in set(map(type, shapes))]
    groups = []
    for i, (kind, rows) in enumerate(zip(kinds, arrays.rows, strict=True)):
        labels = np.zeros((0, WIDE, 2))
        unbounded = np.flatnonzero(arrays.slots[:, 0] == i)
        groups.append(LeafGroup(rows, aligned(0, block_type(kind)), labels, unbounded, 1, i))
    root = np.repeat(np.array([np.inf, -np.inf, 0.0], np.float32), [3 * WIDE, 3 * WIDE, 4 * WIDE])
    place = np.array([*np.eye(3).ravel(), 0.0, 0.0, 0.0, 1.0, 0.0])
    return Tree(root, place, arrays.colours_and_extents[:, 3].copy(), arrays.slots, tuple(groups))


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
    if run is functions.trace_rays:  # by the kernel for all kinds
        scene = generalised(scene, empty_arrays(FULL_DOUBLE).bvh)
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


def coherent(random: Random, rays: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return rays whose packets go almost the same way: like the first ray of each, those of every fourth apart."""
    origins, directions = (np.repeat(each[::WIDTH], WIDTH, axis=0)[: len(each)] for each in rays)
    spread = np.where(np.arange(len(origins)) // WIDTH % 4 == 0, 0.3, 1e-3)[:, None]
    return origins, unit(directions + spread * random.normal(size=directions.shape))


GREY = (128, 128, 128)


def sphere(*numbers: float) -> Sphere:
    """A grey sphere, by centre and diameter."""
    return Sphere(numbers[:3], numbers[3], GREY)


def node_count(scene: Tree) -> int:
    """Count the nodes of a tree, without its leaves."""
    return len(scene.nodes) // NODE - sum(len(group.blocks) for group in scene.groups)


def check_tree(scene: Tree, shapes: list[Shape]) -> int:
    """Check that a tree has every node and shape once, within the boxes above, and return its number of levels."""
    nodes = scene.nodes.reshape(-1, NODE // WIDE, WIDE).astype(float)
    references, owned, depth = [0], [], 0
    todo = [(0, np.full(3, -np.inf), np.full(3, np.inf), 1)]
    while todo:
        node, low, high, level = todo.pop()
        depth = max(depth, level)
        for child in np.flatnonzero(nodes[node, 0] < np.inf):
            box_low, box_high = nodes[node, :3, child], nodes[node, 3:6, child]
            assert (low <= box_low).all()
            assert (box_high <= high).all()
            reference = int(nodes[node, REFERENCES // WIDE, child])
            references.append(abs(reference))
            if reference > 0:
                todo.append((reference, box_low, box_high, level + 1))
                continue
            (group,) = (g for g in scene.groups if g.first_leaf <= -reference < g.first_leaf + len(g.blocks))
            labels = group.labels[-reference - group.first_leaf]
            owners = labels[:, 0].astype(int)
            owned += set(owners.tolist())
            assert np.array_equal(labels[:, 1], scene.extents[owners])
            middle, factor = scene.place[CENTRE:FACTOR], scene.place[FACTOR]
            corners = (np.array([shapes[index].bounds() for index in owners]) - middle) * factor
            assert check_boxes(nodes[node, :6, [child] * WIDE].T, corners).all()
            assert np.array_equal(check_boxes(nodes[-reference, :6], corners), np.arange(WIDE) < len(set(owners)))
        empty = nodes[node, 0] == np.inf
        assert (nodes[node, :3, empty] == np.inf).all()
        assert (nodes[node, 3:6, empty] == -np.inf).all()
    assert sorted(references) == list(range(len(nodes)))
    unbounded = np.concatenate(
        [np.zeros(0, int), *(g.unbounded for g in scene.groups if g.unbounded is not None)]
    ).tolist()
    assert sorted(owned + unbounded) == list(range(len(shapes)))
    return depth


def check_boxes(boxes: Array, corners: Array) -> Array:
    """Return which boxes (6, WIDE) enclose those with some corners (WIDE, 2, 3), with margins; the others are empty."""
    slack = (ROUNDING * np.abs(corners) + MARGIN * np.abs(corners).max(axis=(1, 2))[:, None, None]) / 2
    encloses = (corners[:, 0] - slack[:, 0] >= boxes[:3].T) & (corners[:, 1] + slack[:, 1] <= boxes[3:].T)
    assert (boxes[:3].T[~encloses.all(axis=1)] == np.inf).all()
    return encloses.all(axis=1)


@pytest.mark.parametrize("count", [1, 2, WIDE, WIDE + 1, 100, 1000])
@pytest.mark.parametrize("kernel", [Interpreted, functions], ids=["interpreted", "compiled"])
def test_every_shape_is_in_the_tree_once_and_every_box_encloses_its_subtree(count: int, kernel: Any) -> None:
    shapes = random_shapes(np.random.default_rng(count), count)
    check_tree(build_tree(shapes, kernel), shapes)


@pytest.mark.parametrize(
    "shapes",
    [
        [sphere(1, 2, 3, 1)] * 1000,
        [sphere(0, 0, 0, 2.0**-i) for i in range(30) for _ in range(30)],
        [sphere(2.0**i, 0, 0, 2.0**i) for i in range(-40, 48) for _ in range(20)],
        [Cylinder((0, 0, 1e-3 * i), (0, 0, 1), 1, 1e-9, GREY) for i in range(300)],
        [sphere(1, 2, 3, 1), Cylinder((1, 2, 3), (0, 0, 1), 1, 1, GREY)] * 300,
    ],
    ids=["equal", "nested", "halving", "flat", "two kinds in one place"],
)
def test_degenerate_distributions_of_shapes_give_a_tree_of_limited_depth(shapes: list[Shape]) -> None:
    assert check_tree(build_tree(shapes), shapes) <= DEEPEST


def test_the_traversal_stack_holds_the_deepest_tree() -> None:
    # Each box is half as large and as far as the one before: the cheapest splits separate one box at a time.
    far = 2.0 ** np.arange(-899, 1)[:, None]
    boxes = np.hstack([np.repeat(far, 6, axis=1) * [-1, -1, -1, 1.5, 1.5, 1.5], np.zeros((900, 2))])
    nodes, inside, _ = wide_nodes(np.repeat(boxes, WIDE, axis=0), functions)
    children = nodes[: len(nodes) - len(inside), REFERENCES // WIDE].astype(int)
    deepest = np.ones(len(children), int)
    for node in range(len(children) - 1, -1, -1):  # a child comes behind its parent
        deepest[node] += (
            max(deepest[child] for child in children[node] if child > 0) if (children[node] > 0).any() else 0
        )
    assert inside.max() + 1 == 900 * WIDE
    assert deepest[0] <= DEEPEST


def test_any_number_of_threads_builds_the_same_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bvh, "PARALLEL", 8)
    corners = np.random.default_rng(3).normal(size=(20_000, 3)) ** 3
    groups = np.repeat([0, 1], [15_000, 5_000])
    boxes = np.column_stack([-corners, corners + 0.01, np.arange(len(corners)), groups])
    trees, jobs = [], []
    for threads in (0, 1, 3):
        pool = ThreadPool(threads)

        def run(job: Job, pool: ThreadPool = pool, threads: int = threads) -> None:
            jobs.append(job)
            pool.run([job] * threads, lambda: None)

        sorted_boxes = boxes.copy()
        trees.append([*wide_nodes(sorted_boxes, functions, run=run if threads else None), sorted_boxes])
    assert len(jobs) > 6
    assert all(np.array_equal(one, other) for tree in trees[1:] for one, other in zip(trees[0], tree, strict=True))


def test_a_ray_visits_few_leaves() -> None:
    # 27,000 spheres on a grid: a ray passes about 30 of them, in nodes of 16.
    shapes: list[Shape] = [sphere(*place, 0.1) for place in np.ndindex(30, 30, 30)]
    scene = build_tree(shapes)
    assert 0 < len(leaves_along(scene, (-1, 14.3, 13.7), unit(np.array([1, 0.3, 0.2])))) < 60
    assert node_count(scene) < 27_000 / 16


def test_leaves_and_nodes_are_nearly_full() -> None:
    # They cost the same however full they are, so splits into multiples of `WIDE` are cheaper.
    random = np.random.default_rng(3)
    scene = build_tree([sphere(*place, 1) for place in random.uniform(0, 100, (10_000, 3))])
    assert 0.85 * WIDE * len(scene.groups[0].labels) < 10_000
    assert 0.6 * WIDE * node_count(scene) < len(scene.groups[0].labels)


def packet_of(scene: Tree, origin: Any, direction: Any, limit: float = np.inf) -> RayPacket:
    """Return a packet of rays that have hit something at a distance."""
    memory = packet_memory()
    for at, v in ((ORIGIN, origin), (DIRECTION, direction)):
        save_vec(Vec(*(np.full(WIDTH, x) for x in v)), memory, at)
    save(np.full(WIDTH, limit), memory, HIT)
    rays = RayPacket(scene.nodes, 0, scene.place, memory, bvh_rays.ray_numbers(), bvh_rays.ray_integers(), 0)
    bvh_rays.store_rays(rays)
    return rays


def leaves_along(scene: Tree, origin: Any, direction: Any, limit: float = np.inf) -> list[int]:
    """Return the leaves that a ray visits, in order, if it hits nothing."""
    visited_leaves: list[int] = []
    visit = lambda group, block, rays, ray: visited_leaves.append(block)  # noqa: E731
    packet = packet_of(scene, origin, direction, limit)
    traverse(all_leaves, visit_leaves, (visit, scene), packet, 1 << 5, 0)
    return visited_leaves


def test_leaves_are_visited_nearest_first_up_to_the_limit() -> None:
    # One behind the other: the boxes are entered at x = 0, 3, 6...
    scene = build_tree([sphere(3 * i + 0.5, 0, 0, 1) for i in range(40) for _ in range(WIDE)])
    order = np.argsort(scene.groups[0].labels[:, 0, 0])
    for direction, expected in (((1.0, 0.0, 0.0), order), ((-1.0, 0.0, 0.0), order[::-1])):
        origin = (-1.0 if direction[0] > 0 else 119.0, 0.1, 0.1)
        assert leaves_along(scene, origin, direction) == expected.tolist()
        assert leaves_along(scene, origin, direction, 30.0) == expected[:10].tolist()


@pytest.mark.parametrize("distance", [1.0, 7.0])
def test_leaves_behind_a_hit_are_not_visited(distance: float) -> None:
    scene = build_tree([sphere(3 * i + 0.5, 0, 0, 1) for i in range(40) for _ in range(WIDE)])
    origins = np.linspace(-1, 50, WIDTH)
    packet = packet_of(scene, (origins, 0.1, 0.1), (1.0, 0.0, 0.0))
    visits = np.zeros(WIDTH, int)

    def hit(group: Any, block: int, rays: RayPacket, ray: int) -> None:
        visits[ray] += 1
        rays.memory[HIT + ray] = distance
        bvh_rays.set_limit(rays, ray)

    traverse(all_leaves, visit_leaves, (hit, scene), packet, (1 << WIDTH) - 1 - 4, 0)
    starts = 3.0 * np.arange(40)  # a ray visits at least the first leaf that it hits
    expected = [max(1, ((starts + 1 >= x) & (starts <= x + distance)).sum()) for x in origins]
    expected[2] = 0  # not active
    assert visits.tolist() == expected


def grazing_rays(seed: int) -> tuple[list[Shape], Array, Array]:
    """Return a sphere, and rays that touch it where it touches its box, along the box's side within rounding."""
    random = np.random.default_rng(seed)
    centre, radius = random.normal(size=3) * 10, random.uniform(0.01, 1)
    axis = np.eye(3)[random.integers(3, size=300)] * random.choice([-1, 1], size=(300, 1))
    directions = unit(np.cross(axis, random_directions(random, 300))) + random.uniform(-4e-16, 4e-16, (300, 1)) * axis
    return (
        [sphere(*centre, 2 * radius)],
        centre + radius * axis - random.uniform(1, 50, (300, 1)) * directions,
        directions,
    )


def wrong_hits(scene: Tree, shapes: list[Shape], rays: tuple[Array, Array]) -> int:
    """Count the rays that hit something else than without boxes, both interpreted."""
    result, expected = (
        trace(scene, *rays, ray_batches.trace_rays),
        trace(brute_force(shapes), *rays, ray_batches.trace_rays),
    )
    return int((result[1] != expected[1]).sum())


def test_rays_that_graze_the_sides_of_boxes_hit_what_they_hit_without_boxes() -> None:
    hits = 0
    for seed in range(100):
        shapes, *rays = grazing_rays(seed)
        tree = build_tree(shapes)
        result, expected = trace(tree, *rays), trace(without_boxes(tree), *rays)
        assert np.array_equal(result[1], expected[1])
        hits += (result[1] >= 0).sum()
    assert 3000 < hits < 27_000


def test_rays_without_margins_are_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (bvh, bvh_rays):
        monkeypatch.setattr(module, "ROUNDING", 0.0)
    shapes, *rays = grazing_rays(1)
    shapes.append(sphere(1.1, 2.2, 3.3, 0.7))
    assert wrong_hits(build_tree(shapes), shapes, (rays[0], rays[1])) > 5


NOT_NUMBERS = [((np.nan,) * 3, (0, 0, 1)), ((0, 0, 0), (np.nan,) * 3), ((1e308, -1e308, 1e308), (0, 1e-300, -1))]


@pytest.mark.parametrize("ray", NOT_NUMBERS)
@pytest.mark.parametrize("count", [0, 1, 100])
def test_rays_of_nan_and_infinity_end(ray: tuple[Any, Any], count: int) -> None:
    """Rays of NaN pass all box tests, even those of the lanes to spare, whose boxes no other ray hits."""
    tree = build_tree([*random_shapes(np.random.default_rng(5), count), Plane((0, 0, 9), (0, 0, 1), GREY)])
    with np.errstate(all="ignore"):
        leaves_along(tree, *ray)
    trace(tree, *(np.full((WIDTH, 3), part, float) for part in ray))


def axis_rays() -> tuple[list[Shape], tuple[Array, Array]]:
    """Return spheres around the origin, and rays from there along axes, whose other components are 0 or -0."""
    shapes: list[Shape] = [sphere(*(10 * sign * axis), 1) for axis in np.eye(3) for sign in (1, -1)]
    zero = np.array([[x, y] for x in (0.0, -0.0) for y in (0.0, -0.0)])
    ways = [np.insert(pair, axis, sign) for axis in range(3) for sign in (1.0, -1.0) for pair in zero]
    return shapes, (np.zeros((24, 3)), np.array(ways))


def test_components_of_a_direction_may_be_0_or_minus_0(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes, rays = axis_rays()
    for result in (trace(build_tree(shapes), *rays), trace(build_tree(shapes), *rays, ray_batches.trace_rays)):
        assert result[1].tolist() == np.repeat(range(6), 4).tolist()
        assert np.array_equal(result[0], np.full(24, 9.5))
    tree = build_tree(shapes)
    assert min(len(leaves_along(tree, *ray)) for ray in zip(*rays, strict=True)) > 0
    rays_in_box = bvh_rays.rays_in_box

    def by_planes_of_first(*box: Any) -> Any:
        with monkeypatch.context() as patch:
            patch.setattr(bvh_rays, "where", lambda mask, a, b: np.where(mask[0], a, b))
            return rays_in_box(*box)

    for module in (bvh_traversal, bvh_leaves):
        monkeypatch.setattr(module, "rays_in_box", by_planes_of_first)
    assert wrong_hits(tree, shapes, rays) > 5


def test_rays_along_axes_visit_no_boxes_beside_them(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = build_tree([sphere(*place, 0.1) for place in np.ndindex(12, 12, 12)])
    ways = [((-1, 5.02, 6.03), (1, 0, 0)), ((5.02, -1, 6.03), (0, 1, -0.0)), ((5.02, 6.03, 20), (0, -0.0, -1))]
    few = [len(leaves_along(scene, *way)) for way in ways]
    assert max(few) <= 12
    # With an infinite inverse, positions along the other axes make no difference.
    monkeypatch.setattr(bvh_rays, "safe_inverse", lambda x: 1.0 / x)
    with np.errstate(all="ignore"):
        assert min(len(leaves_along(scene, *way)) for way in ways) > 12
