"""The tree: every shape once, every box around what is in it, and the same hits as without boxes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel.bvh import collapse, nodes, queries, traversal
from minirt.kernel.bvh.nodes import LEVELS, MARGIN, MEMORY, NODE, STACK, STACK_LEVEL, WIDTH, Tree, reference_of
from minirt.kernel.compiler import jit_bvh
from minirt.lanes import Vec
from minirt.rendering.packing.bvh import wide_nodes
from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.bvh.trees import Interpreted, brute_force, build_tree, random_shapes, trace
from tests.shapes.regimes import Array, unit, ways

GREY = (128, 128, 128)


def ball(*numbers: float) -> Sphere:
    return Sphere(numbers[:3], numbers[3], GREY)


def checked(scene: Tree, shapes: list[Shape]) -> int:
    """The levels of a tree; every node and every shape is in it once, and within the boxes above it."""
    nodes = scene.nodes.reshape(-1, 7, WIDTH)
    names, met, depth = [0], [], 0
    todo = [(0, np.full(3, -np.inf), np.full(3, np.inf), 1)]
    while todo:
        node, low, high, level = todo.pop()
        depth = max(depth, level)
        for child in np.flatnonzero(nodes[node, 0] < np.inf):
            box_low, box_high = nodes[node, :3, child], nodes[node, 3:6, child]
            assert (low <= box_low).all()
            assert (box_high <= high).all()
            name = reference_of(nodes[node, 6, child])
            if name >= 0:
                names.append(name // NODE)
                todo.append((name // NODE, box_low, box_high, level + 1))
                continue
            block, group = divmod(-1 - name, len(scene.groups))
            labels = scene.groups[group].labels[block]
            owners = labels[:, 0].astype(int)
            met += set(owners.tolist())
            assert np.array_equal(labels[:, 1], scene.extents[owners])
            corners = np.array([shapes[index].bounds() for index in owners])
            assert (box_low <= corners[:, 0] - MARGIN * np.abs(corners).max(axis=(1, 2))[:, None] / 2).all()
            assert (box_high >= corners[:, 1] + MARGIN * np.abs(corners).max(axis=(1, 2))[:, None] / 2).all()
        empty = nodes[node, 0] == np.inf
        assert (nodes[node, :3, empty] == np.inf).all()
        assert (nodes[node, 3:6, empty] == -np.inf).all()
    assert sorted(names) == list(range(len(nodes)))
    endless = np.concatenate([group.unbounded for group in scene.groups]).tolist()
    assert sorted(met + endless) == list(range(len(shapes)))
    return depth


@pytest.mark.parametrize("count", [1, 2, WIDTH, WIDTH + 1, 100, 1000])
@pytest.mark.parametrize("kernel", [Interpreted, jit_bvh], ids=["interpreted", "compiled"])
def test_every_shape_is_in_the_tree_once_and_every_box_holds_what_is_below_it(count: int, kernel: Any) -> None:
    shapes = random_shapes(np.random.default_rng(count), count)
    checked(build_tree(shapes, kernel), shapes)


def test_shapes_without_end_are_in_no_box() -> None:
    shapes: list[Shape] = [Plane((0, i, 0), (0, 1, 0), GREY) for i in range(40)]
    assert checked(build_tree(shapes), shapes) == 1


@pytest.mark.parametrize(
    "shapes",
    [
        [ball(1, 2, 3, 1)] * 1000,
        [ball(0, 0, 0, 2.0**-i) for i in range(30) for _ in range(30)],
        [ball(2.0**i, 0, 0, 2.0**i) for i in range(-40, 48) for _ in range(20)],
        [Cylinder((0, 0, 1e-3 * i), (0, 0, 1), 1, 1e-9, GREY) for i in range(300)],
        [ball(1, 2, 3, 1), Cylinder((1, 2, 3), (0, 0, 1), 1, 1, GREY)] * 300,
    ],
    ids=["equal", "nested", "halving", "flat", "two kinds in one place"],
)
def test_bad_shapes_to_sort(shapes: list[Shape]) -> None:
    assert checked(build_tree(shapes), shapes) <= LEVELS + WIDTH


def test_a_ray_has_room_for_all_that_it_meets() -> None:
    # Each box is half as large and as far as the one before: the cheapest is to split them off one by one.
    far = 2.0 ** np.arange(-450, 450)[:, None]
    boxes = np.hstack([np.repeat(far, 6, axis=1) * [-1, -1, -1, 1.5, 1.5, 1.5], np.zeros((900, 2))])
    nodes, leaves = wide_nodes(np.repeat(boxes, WIDTH, axis=0), jit_bvh)
    children = nodes.reshape(-1, 7, WIDTH)[:, 6].astype(int) // NODE
    deepest = np.ones(len(children), int)
    for node in range(len(children) - 1, -1, -1):  # a child comes behind its parent
        deepest[node] += (
            max(deepest[child] for child in children[node] if child > 0) if (children[node] > 0).any() else 0
        )
    assert leaves[:, 1].max() == 900 * WIDTH
    assert STACK + deepest[0] * STACK_LEVEL <= MEMORY


def test_few_boxes_are_met() -> None:
    # 27,000 balls on a grid: a ray passes some 30 of them, in nodes of 16.
    shapes: list[Shape] = [ball(*place, 0.1) for place in np.ndindex(30, 30, 30)]
    scene = build_tree(shapes)
    assert 0 < len(visited(scene, (-1, 14.3, 13.7), unit(np.array([1, 0.3, 0.2])))) < 60
    assert len(scene.nodes) // NODE < 27_000 / 16


def test_leaves_are_nearly_full() -> None:
    # A leaf takes as long however full it is: splits that leave multiples of `WIDTH` are cheaper.
    random = np.random.default_rng(3)
    scene = build_tree([ball(*place, 1) for place in random.uniform(0, 100, (10_000, 3))])
    assert 0.85 * WIDTH * len(scene.groups[0].labels) < 10_000


def visited(scene: Tree, origin: Any, direction: Any, limit: float = np.inf) -> list[int]:
    """The leaves that a ray visits, in their order, where it hits nothing."""
    memory = nodes.packet_memory()
    met: list[int] = []
    nodes.store_rays(memory, *(Vec(*(np.full(WIDTH, x) for x in v)) for v in (origin, direction)))
    memory[nodes.HIT : nodes.HIT + WIDTH] = limit
    traversal.traverse(lambda group, block, tree, memory, ray: met.append(block), scene, memory, 1 << 5)
    return met


def test_leaves_are_visited_the_nearest_first_as_far_as_it_matters() -> None:
    # In front of each other, so that the boxes are entered at x = 0, 3, 6...
    scene = build_tree([ball(3 * i + 0.5, 0, 0, 1) for i in range(40) for _ in range(WIDTH)])
    order = np.argsort(scene.groups[0].labels[:, 0, 0])
    for direction, right in (((1.0, 0.0, 0.0), order), ((-1.0, 0.0, 0.0), order[::-1])):
        origin = (-1.0 if direction[0] > 0 else 119.0, 0.1, 0.1)
        assert visited(scene, origin, direction) == right.tolist()
        assert visited(scene, origin, direction, 30.0) == right[:10].tolist()


@pytest.mark.parametrize("distance", [1.0, 7.0])
def test_what_a_hit_hides_is_not_visited(distance: float) -> None:
    scene = build_tree([ball(3 * i + 0.5, 0, 0, 1) for i in range(40) for _ in range(WIDTH)])
    memory = nodes.packet_memory()
    rays = [np.linspace(-1, 50, WIDTH), np.full(WIDTH, 0.1), np.full(WIDTH, 0.1)]
    nodes.store_rays(memory, Vec(*rays), Vec(np.ones(WIDTH), np.zeros(WIDTH), np.zeros(WIDTH)))
    memory[nodes.HIT : nodes.HIT + WIDTH] = np.inf
    met = np.zeros(WIDTH, int)

    def hit(group: Any, block: int, tree: Tree, memory: Any, ray: int) -> None:
        met[ray] += 1
        memory[nodes.HIT + ray] = distance

    traversal.traverse(hit, scene, memory, (1 << WIDTH) - 1 - 4)
    starts = 3.0 * np.arange(40)  # a ray visits at least the first that it meets
    right = [max(1, ((starts + 1 >= x) & (starts <= x + distance)).sum()) for x in rays[0]]
    right[2] = 0  # not asked for
    assert met.tolist() == right


def grazing(seed: int) -> tuple[list[Shape], Array, Array]:
    """A ball, and rays that touch it where it touches its box, along the side of that within rounding."""
    random = np.random.default_rng(seed)
    centre, radius = random.normal(size=3) * 10, random.uniform(0.01, 1)
    axis = np.eye(3)[random.integers(3, size=300)] * random.choice([-1, 1], size=(300, 1))
    directions = unit(np.cross(axis, ways(random, 300))) + random.uniform(-4e-16, 4e-16, (300, 1)) * axis
    return (
        [ball(*centre, 2 * radius)],
        centre + radius * axis - random.uniform(1, 50, (300, 1)) * directions,
        directions,
    )


def lost(scene: Tree, shapes: list[Shape], rays: tuple[Array, Array]) -> int:
    """How many rays, interpreted, hit something else than without boxes."""
    found, right = trace(scene, *rays, queries.trace_rays), trace(brute_force(shapes), *rays, queries.trace_rays)
    return int((found[1] != right[1]).sum())


def test_rays_that_graze_the_sides_of_boxes() -> None:
    hits = 0
    for seed in range(100):
        shapes, *rays = grazing(seed)
        found, right = trace(build_tree(shapes), *rays), trace(brute_force(shapes), *rays)
        assert np.array_equal(found[1], right[1])
        hits += (found[1] >= 0).sum()
    assert 3000 < hits < 27_000


def test_boxes_that_are_not_widened_do_not_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes, *rays = grazing(1)
    assert lost(build_tree(shapes, Interpreted), shapes, rays) == 0
    monkeypatch.setattr(nodes, "MARGIN", 0.0)
    assert (
        lost(build_tree(shapes, Interpreted), shapes, rays) == 0
    )  # one of the two margins is enough so near to the box
    monkeypatch.setattr(collapse, "MARGIN", 0.0)
    assert lost(build_tree(shapes, Interpreted), shapes, rays) > 5


def zeros() -> tuple[list[Shape], tuple[Array, Array]]:
    """Balls around the origin, and rays from there along axes: the other parts of a direction are 0 or -0."""
    shapes: list[Shape] = [ball(*(10 * sign * axis), 1) for axis in np.eye(3) for sign in (1, -1)]
    zero = np.array([[x, y] for x in (0.0, -0.0) for y in (0.0, -0.0)])
    ways = [np.insert(pair, axis, sign) for axis in range(3) for sign in (1.0, -1.0) for pair in zero]
    return shapes, (np.zeros((24, 3)), np.array(ways))


def test_parts_of_a_direction_may_be_0_or_minus_0(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes, rays = zeros()
    for found in (trace(build_tree(shapes), *rays), trace(build_tree(shapes), *rays, queries.trace_rays)):
        assert found[1].tolist() == np.repeat(range(6), 4).tolist()
        assert np.array_equal(found[0], np.full(24, 9.5))
    right = nodes.near_planes
    tiny = lambda x: np.abs(x) if np.abs(x) * nodes.TINY == 1.0 else x  # noqa: E731  (-0 as if it were 0)
    monkeypatch.setattr(
        traversal, "near_planes", lambda inverse: right(Vec(tiny(inverse.x), tiny(inverse.y), tiny(inverse.z)))
    )
    assert lost(build_tree(shapes), shapes, rays) > 5


def test_rays_along_axes_meet_no_boxes_beside_them(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = build_tree([ball(*place, 0.1) for place in np.ndindex(12, 12, 12)])
    ways = [((-1, 5.02, 6.03), (1, 0, 0)), ((5.02, -1, 6.03), (0, 1, -0.0)), ((5.02, 6.03, 20), (0, -0.0, -1))]
    few = [len(visited(scene, *way)) for way in ways]
    assert max(few) <= 12
    # Without a number in the place of infinity all places along the other axes are the same.
    monkeypatch.setattr(nodes, "safe_inverse", lambda x: 1.0 / x)
    with np.errstate(all="ignore"):
        assert min(len(visited(scene, *way)) for way in ways) > 12
