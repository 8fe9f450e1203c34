"""Light buffers over frustums: their directions and resolution, and that pictures equal brute force."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.fields import MeshFile
from minirt.kernel import binning
from minirt.kernel.machine_code import functions
from minirt.kernel.shadow_rays import SCALE, TOLERANCE, light_buffer_cell
from minirt.lanes import Vec
from minirt.rendering import Renderer
from minirt.rendering.culling import light_frustum, visibility
from minirt.rendering.culling.light_frustum import LEAST_SHAPES, MOST_OUTSIDE, Cluster, dense_cluster, frustum_grid
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.scene_packing import Packing
from minirt.report.settings import ChangedPacking, without_light_buffers, without_tiles
from minirt.scene import Ambient, Camera, Light, ParallelLight, Scene
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import linear
from tests.meshes.examples import GREY, ball, named
from tests.shapes.regimes import random_directions

WIDTH, HEIGHT = 96, 48
UNIT_BALL = Cluster(np.zeros(3), 1.0)
POSITIONS: dict[str, tuple[float, float, float]] = {
    "far": (-400, 900, -300),
    "very far": (-4e7, 9e7, -3e7),
    "near": (2, 4, -3),
    "as near as it may be": (0, 1.62, 0),
    "inside": (0.5, 0.6, -1.0),
    "under the floor": (0, -5, 1),
}


def meshes(position: Any = (0, 0, 0)) -> tuple[Mesh, ...]:
    """Some 5,000 triangles: a hollow ball, and a knot in front of it."""
    return Mesh(MeshFile("ball.obj", ball(3)), position, 1.0, GREY), named("knot", position, 0.6)


def scene(source: Any, *shapes: Any) -> Scene:
    floor, beside = Plane((0, -1.2, 0), (0, 1, 0), GREY), Sphere((7, 0, 9), 3, GREY)
    light = Light(source, 0.8) if isinstance(source, tuple) else source
    return Scene((Ambient(0.1, (255, 255, 255)), Camera((0, 1.5, -4), (0, -0.3, 1), 60), light, floor, *shapes, beside))


def brute_force(precision: str) -> Renderer:
    """A renderer that tries every shape for every ray."""
    renderer = Renderer(2, precision)
    renderer.packing = ChangedPacking(without_tiles, without_light_buffers, precision=precision)
    return renderer


def test_a_cluster_leaves_out_as_many_shapes_as_it_may_and_no_more() -> None:
    inner = [Sphere((0, 0, i / LEAST_SHAPES), 0.1, GREY) for i in range(LEAST_SHAPES - MOST_OUTSIDE)]
    for outside, is_left_out in ((MOST_OUTSIDE, True), (MOST_OUTSIDE + 1, False)):
        shape_arrays = ShapeArrays()
        shape_arrays.update((*inner, *(Sphere((0, 1000, 0), 1, GREY) for _ in range(outside))))
        cluster = dense_cluster(shape_arrays)
        assert cluster is not None
        assert (cluster.radius < 20) is is_left_out


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("position", POSITIONS)
def test_pictures_equal_brute_force(position: str, precision: str) -> None:
    shown = scene(POSITIONS[position], *meshes())
    packed = Packing().pack(shown, WIDTH, HEIGHT)
    assert (packed.light_buffers[0, SCALE] > 0) == (position != "inside")
    expected = linear(shown, WIDTH, HEIGHT, 2, brute_force(precision))
    assert np.array_equal(expected, linear(shown, WIDTH, HEIGHT, 2, Renderer(2, precision)))
    assert np.ptp(expected) > 0.1 or position == "under the floor"


def test_parallel_light_casts_shadows_without_light_buffer_and_bvh() -> None:
    """Triangles above the picture cast a shadow in it."""
    above = named("icosahedron", (0, 4, 1), 1.0).some(np.arange(6))
    shown = scene(ParallelLight((0, -1, 0.3), 0.8, (255, 255, 255)), above)
    packed = Packing().pack(shown, WIDTH, HEIGHT)
    assert packed.light_buffer_cells == 1
    assert packed.bvh is None
    aside = shown.replace(above, position=(0, 4, -90))
    dark, lit = (linear(each, WIDTH, HEIGHT)[HEIGHT // 2 :] for each in (shown, aside))
    shadow = (dark < lit).any(axis=-1)
    assert 20 < shadow.sum() < 0.2 * shadow.size
    assert np.array_equal(dark[~shadow], lit[~shadow])


def frustum(light: Any, cells: int = 64, cluster: Cluster = UNIT_BALL) -> Any:
    grid = frustum_grid(cluster, np.array(light, float), cells)
    assert grid is not None
    return grid


@pytest.mark.parametrize("distance", [1.42, 2, 30, 1e3])
def test_the_cluster_fills_the_frustum(distance: float) -> None:
    """The slopes of the tangents of the ball are those of the edges of the frustum without the border."""
    grid = frustum((0, distance, 0))
    edge = grid.middle_x / grid.scale_x
    assert edge * (1 - 2 * light_frustum.BORDER / 128) == pytest.approx(np.tan(np.arcsin(1 / distance)), rel=1e-6)
    assert np.allclose(grid.frames[0] @ grid.frames[0].T, np.eye(3), atol=1e-15)
    assert np.allclose(grid.frames[0, 2], [0, -1, 0])


def test_a_light_near_or_inside_the_cluster_has_no_frustum() -> None:
    assert [frustum_grid(UNIT_BALL, np.array([x, 0, 0]), 64) for x in (1.41, 1.0, 0.3, 0.0)] == [None] * 4
    assert frustum_grid(None, np.array([9.0, 0, 0]), 64) is None


def test_no_cell_is_too_fine_for_float32() -> None:
    assert 1 / frustum((1e6, 0, 0)).scale_x == light_frustum.LEAST_SLOPE
    assert 1 / frustum((1e3, 0, 0)).scale_x > light_frustum.LEAST_SLOPE


def test_a_few_shapes_outside_do_not_widen_the_cluster() -> None:
    random = np.random.default_rng(1)
    heap = [Sphere(tuple(random.uniform(-1, 1, 3)), 0.1, GREY) for _ in range(1000)]
    for others, count in (("few", light_frustum.MOST_OUTSIDE), ("many", 2 * light_frustum.MOST_OUTSIDE)):
        shape_arrays = ShapeArrays()
        far = [Sphere((100.0 * i, 5, 900), 30, GREY) for i in range(count)]
        shape_arrays.update((*heap, *far, Plane((0, -1e9, 0), (0, 1, 0), GREY)))
        found = dense_cluster(shape_arrays)
        assert found is not None
        assert (found.radius < 30) == (others == "few")
    few = ShapeArrays()
    few.update(tuple(heap[:900]))
    assert dense_cluster(few) is None


@pytest.mark.parametrize("light", [(1.43, 0, 0), (3, 4, 5), (0, 0, 500)])
def test_the_margin_is_the_reach_of_close_directions(light: Any) -> None:
    random, grid = np.random.default_rng(2), frustum(light)
    buffer = visibility.light_buffer(64, grid)
    half = grid.middle_x / grid.scale_x
    slopes = half * random.uniform(-1, 1, (2, 200_000))
    slopes[:, ::2] = half * np.sign(slopes[:, ::2])  # at the corners they reach farthest
    directions = np.array([*slopes, np.ones(200_000)])
    directions /= np.linalg.norm(directions, axis=0)
    nearby = directions + np.sqrt(buffer[TOLERANCE]) * random_directions(random, 200_000).T
    nearby /= np.linalg.norm(nearby, axis=0)
    close = ((nearby - directions) ** 2).sum(axis=0) <= buffer[TOLERANCE]
    reach = np.abs(nearby[:2] / nearby[2] - slopes)[:, close].max() * grid.scale_x
    assert 0.85 * grid.margin < reach < grid.margin


@pytest.mark.parametrize("kernel", [binning, functions], ids=["interpreted", "compiled"])
def test_shapes_that_reach_out_of_the_frustum_are_listed_elsewhere_too(kernel: Any) -> None:
    grid = frustum((0, 0, -10))
    x, y, z = grid.frames[0]
    begin, end = grid.margin - grid.middle_x, grid.middle_x - grid.margin
    places = [(0, True), (begin + 0.01, True), (begin - 0.01, False), (end - 0.01, True), (end + 0.01, False)]
    for at, within in [*places, (end + 9, False)]:
        for way in (x, y):
            point = np.array([0, 0, -10]) + 7 * (z + at / grid.scale_x * way)
            found = covered(kernel, grid, [[*point, 0.0]])
            assert (grid.elsewhere in found) != within
            assert (len(found) > 1) or within or at == end + 9
    behind, inside = [[0, 0, -20, 1.0]], [[0, 0, -10.5, 1.0]]
    assert covered(kernel, grid, behind) == [grid.elsewhere]
    assert len(covered(kernel, grid, inside)) == 128 * 128 + 1
    assert grid.elsewhere in covered(kernel, grid, [[0, 0, 0, 0.1], [0, 0, -12, 0.1]])


def covered(kernel: Any, grid: Any, balls: list[list[float]]) -> list[int]:
    """The cells that the hull of some balls covers, seen from 0, 0, -10."""
    rectangles, cones, counts = np.zeros((2, 4), np.int32), np.zeros((1, 5)), np.zeros(grid.cells + 1, np.int64)
    first, place = np.array([0, len(balls)]), np.zeros((1, 2), np.int64)
    arguments = np.array([0, 0, -10.0]), grid, np.array(balls), 0.0, first, place
    kernel.project_all(*arguments, rectangles, 0, cones, counts)
    return np.flatnonzero(counts).tolist()


def test_directions_beside_and_behind_the_frustum_are_elsewhere() -> None:
    grid = frustum((0, 0, -10))
    buffer, half = visibility.light_buffer(64, grid), grid.middle_x / grid.scale_x
    x, y, z = grid.frames[0]
    for way in (x, -x, y, -y):
        assert light_buffer_cell(buffer, 64, Vec(*(z + 0.999 * half * way))) < 128 * 128
        assert light_buffer_cell(buffer, 64, Vec(*(z + 1.001 * half * way))) == grid.elsewhere
    assert light_buffer_cell(buffer, 64, Vec(*-z)) == grid.elsewhere
    with np.errstate(all="ignore"):
        assert light_buffer_cell(buffer, 64, Vec(*x)) == grid.elsewhere
    assert light_buffer_cell(buffer, 64, Vec(*(z + half * (0.5 * x - 0.25 * y) + 1e-6 * (x + y)))) == 48 * 128 + 96


def test_a_distant_light_has_short_lists() -> None:
    """With a cube, one list would have all 5,000 shapes."""
    packed = Packing().pack(scene(POSITIONS["far"], *meshes()), WIDTH, HEIGHT)
    sizes = sum(np.diff(group.light_starts[0]) for group in packed.groups)
    assert sizes[128 * 128] == 1  # elsewhere: the ball that is outside of the cluster
    assert sizes.max() < 150
    assert sizes[sizes > 1].mean() < 20
