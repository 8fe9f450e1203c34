"""Visibility culling: no shape that a ray hits is missing from the bin of the ray."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

import minirt
from minirt.errors import RenderError
from minirt.helpers import system
from minirt.kernel import functions, interpreted
from minirt.kernel.frame import ray_direction, tile_count
from minirt.kernel.pixels import TILE
from minirt.kernel.projection import projected_rectangle
from minirt.kernel.scene_arrays import kind_of, read
from minirt.kernel.shadow_rays import CACHED, CIRCLE, is_close, light_buffer_cell, remember_cell
from minirt.kernel.trace import in_cone
from minirt.lanes import Vec, unit
from minirt.rendering.packing import light_buffers, shape_arrays, visibility
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.renderer import PRECISIONS, Renderer
from minirt.rendering.scene_packing import FEW, Packing
from minirt.scene import Camera, FurtherLight, Light, Scene, parse
from minirt.shapes import Cylinder, Plane, Sphere
from tests.random_scenes import random_scene
from tests.seeds import seed_of
from tests.shapes.regimes import random_directions

WIDTH, HEIGHT = 70, 45  # five tiles by three, the last ones cut


def listed(starts: np.ndarray, table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The bin of each member of the bins of a kind, and the members, one bin after the other."""
    return np.repeat(np.arange(len(starts) - 1), np.diff(starts)), table[starts[0] : starts[-1]]


def members(arrays: Any, starts: str, table: np.ndarray, row: Any = ...) -> np.ndarray:
    """Whether each shape, of all kinds, is in each of the bins: (bins, shapes)."""
    all_starts = [getattr(group, starts)[row] for group in arrays.groups]
    found = np.zeros((len(all_starts[0]) - 1, len(arrays.slots)), bool)
    for each in all_starts:
        at, numbers = listed(each, table)
        found[at, arrays.listed[numbers, 2]] = True
    return found


def places_of(arrays: Any) -> np.ndarray:
    """The number in lists of each shape, (n,)."""
    return np.argsort(arrays.listed[:, 2])


class RayHits(NamedTuple):
    """All hits of the rays through all pixels, not only the closest ones."""

    tile: np.ndarray
    shape: np.ndarray
    distance: np.ndarray
    in_cone: np.ndarray  # whether the ray is in the bounding cone of the shape


def camera_hits(arrays: Any) -> RayHits:
    """All hits of the rays of a picture."""
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)))
    origin, direction = Vec(*arrays.camera[:3]), unit(ray_direction(arrays.camera, x, y))
    edge = arrays.square
    tile = (y // edge * tile_count(WIDTH, edge) + x // edge).astype(int)
    found = [RayHits(*np.zeros((4, 0), int))]
    for index, (hit, t) in enumerate(hits_of_all_shapes(arrays, origin, direction)):
        cone = np.broadcast_to(in_cone(arrays.cones[places_of(arrays)[index]], direction), x.shape)
        found.append(RayHits(tile[hit], np.full(hit.sum(), index), t[hit], cone[hit]))
    return RayHits(*map(np.concatenate, zip(*found, strict=True)))


def hits_of_all_shapes(arrays: Any, origin: Vec, direction: Vec) -> list[Any]:
    answers = []
    for group, i in arrays.slots:
        rows = arrays.groups[group].rows
        with np.errstate(all="ignore"):
            answers.append(kind_of(rows.dtype.names).intersect(read(rows, i), origin, direction))
    return answers


def hard_scene(seed: int) -> Scene:
    """Tiny and huge shapes anywhere, some at 1e8 from the origin; eye and light often inside or near a surface."""
    random = np.random.default_rng(seed)
    offset = random.choice([0, 0, 1e8]) * random.normal(size=3)

    def place(spread: float) -> Any:
        return tuple(offset + spread * random.normal(size=3))

    def way() -> Any:
        return tuple(random.normal(size=3).clip(-1, 1))

    shapes: list[Any] = [Plane(place(3), way(), (1, 2, 3)) for _ in range(random.integers(3))]
    for _ in range(random.choice([3, 12])):
        size = 10.0 ** random.uniform(-3, 3)
        shapes.append(Sphere(place(5 + size / 2), size, (1, 2, 3)))
        shapes.append(Cylinder(place(5 + size / 2), way(), size, 10.0 ** random.uniform(-3, 3), (1, 2, 3)))
    near = [tuple(np.array(each.centre) + 0.5 * each.diameter * np.array(way())) for each in shapes[-2:]]
    eye, light = near if random.random() < 0.6 else (place(5), place(5))
    return Scene((Camera(eye, way(), random.choice([1e-3, 20, 90, 170, 179.99])), Light(light, 1), *shapes))


SCENES = [*((random_scene, seed) for seed in range(4)), *((hard_scene, seed) for seed in range(14))]
KERNELS = pytest.mark.parametrize("kernel", [interpreted, functions], ids=["interpreted", "compiled"])
# By the compiled kernel, and a few by the interpreter, which takes ten times as long.
BY_KERNEL = [*((functions, *each) for each in SCENES), *((interpreted, *each) for each in SCENES[3:7])]


@pytest.fixture(params=[False, True], ids=["few", "crowd"])
def crowd(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The lists as usual, and those that crowds have, of smaller squares and cells and in Morton order, for all."""
    if request.param:
        monkeypatch.setattr(shape_arrays, "CROWD", 0)
        monkeypatch.setattr(visibility, "SQUARES_BY_SHAPES", ((np.inf, TILE // 4),))
        monkeypatch.setattr(light_buffers, "CELLS_BY_SHAPES", ((light_buffers.SMALL, 1), (np.inf, 256)))


@pytest.mark.parametrize(("kernel", "make", "seed"), BY_KERNEL)
@pytest.mark.usefixtures("crowd")
def test_a_tile_lists_all_shapes_that_its_rays_hit(kernel: Any, make: Any, seed: int) -> None:
    arrays = Packing(kernel).pack(make(seed), WIDTH, HEIGHT)
    seen, in_tile = camera_hits(arrays), members(arrays, "tile_starts", arrays.tile_shapes)
    assert len(in_tile) == tile_count(WIDTH, arrays.square) * tile_count(HEIGHT, arrays.square)
    assert in_tile[seen.tile, seen.shape].all()
    assert seen.in_cone.all()
    assert (seen.distance >= arrays.cones[places_of(arrays)[seen.shape], 4]).all()


def outside_scene(seed: int) -> Scene:
    """A hard scene whose shapes but a few are in a heap, with a light outside of the heap, near or far."""
    random = np.random.default_rng(seed)
    shapes = [each for each in hard_scene(seed).shapes if isinstance(each, Plane) or random.random() < 0.1]
    middle, size = 10.0 ** random.uniform(0, 6) * random.normal(size=3), 10.0 ** random.uniform(-1, 2)
    for _ in range(40):
        place = tuple(middle + size * random.uniform(-0.5, 0.5, 3))
        shapes.append(Sphere(place, size * 10.0 ** random.uniform(-4, -0.5), (1, 2, 3)))
    light = middle + size * 10.0 ** random.uniform(0.1, 4) * unit_direction(random)
    return Scene((Camera((0, 0, 0), (0, 0, 1), 90), Light(tuple(light), 1), *shapes))


def unit_direction(random: np.random.Generator) -> Any:
    way = random.normal(size=3)
    return way / np.linalg.norm(way)


@pytest.mark.parametrize(
    ("kernel", "make", "seed"),
    [*BY_KERNEL, *((functions, outside_scene, seed) for seed in range(14)), (interpreted, outside_scene, 0)],
)
@pytest.mark.usefixtures("crowd")
def test_a_light_buffer_cell_lists_all_shapes_that_are_hit_through_it(kernel: Any, make: Any, seed: int) -> None:
    arrays = Packing(kernel).pack(make(seed), WIDTH, HEIGHT)
    random = np.random.default_rng(seed)
    directions = random.normal(size=(3, 2000))
    directions[:, :40] = np.round(directions[:, :40])  # along axes and diagonals too
    directions[2, (directions == 0).all(axis=0)] = 1
    directions /= np.linalg.norm(directions, axis=0)
    planes = [index for index, shape in enumerate(make(seed).shapes) if shape.infinite_plane()]
    for light, row in enumerate(arrays.lights):
        edge = arrays.light_buffer_cells
        count = 6 * edge**2 if edge > 1 else 1
        with np.errstate(all="ignore"):
            cells = light_buffer_cell(Vec(*directions), edge)[0] if edge > 1 else np.zeros(2000)
        in_cell = members(arrays, "light_starts", arrays.light_shapes, light)
        assert 0 <= cells.min() <= cells.max() < count <= len(in_cell)
        left_out = {shape for shape in planes if not in_cell[:, shape].any()}
        for shape, (hit, t) in enumerate(hits_of_all_shapes(arrays, Vec(*row[:3]), Vec(*directions))):
            cone = arrays.light_cones[light, places_of(arrays)[shape]]
            assert (t[hit] >= cone[4]).all()
            assert (in_cone(cone, Vec(*directions)) | ~hit).all()
            assert shape in left_out or in_cell[cells[hit].astype(int), shape].all()


@pytest.mark.parametrize("edge", [16, 32, 512])
def test_cells_list_what_is_in_the_circles_around_them(edge: int) -> None:
    random, grid, cached, met = np.random.default_rng(edge), light_buffers.cube_grid(edge), np.zeros(CACHED), 0
    for way in random_directions(random, 1000):
        ball = np.array([[*way, 1e-9]])
        listed = [projected_rectangle(np.zeros(3), grid, face, ball, 0, 1, 0.0) for face in range(6)]
        for reach in random.uniform(0, [0, *[2 * CIRCLE / edge] * 8]):
            nearby = unit(Vec(*way + reach * unit_direction(random)))
            remember_cell(cached, edge, -Vec(*(np.array([each]) for each in (nearby.x, nearby.y, nearby.z))), 0)
            assert reach > 0 or is_close(cached, -Vec(*way))
            if is_close(cached, -Vec(*way)):
                face, row, column = int(cached[3]) // edge**2, int(cached[3]) // edge % edge, int(cached[3]) % edge
                left, top, columns, rows = listed[face]
                assert left <= column < left + columns
                assert top <= row < top + rows
                met += 1
    assert met > 3000


@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_lists_of_a_crowd_change_no_bit_of_a_picture(precision: str, monkeypatch: pytest.MonkeyPatch) -> None:
    seed = seed_of(f"a crowd in {precision}")
    coincident = [Cylinder((y, y, 0), (1, 1, 0), 1, 3, (9, 99 * y, 9)) for y in (1, 0)]
    scene = random_scene(seed).add(Sphere((0, 0, 0), 1, (9, 9, 9)), *coincident)
    drawn = []
    for edge in (TILE, TILE // 4):
        monkeypatch.setattr(shape_arrays, "CROWD", 0 if edge < TILE else np.inf)
        monkeypatch.setattr(visibility, "SQUARES_BY_SHAPES", ((np.inf, edge),))
        renderer, pixels, light = Renderer(2, precision), np.zeros((HEIGHT, WIDTH, 4), np.uint8), []
        for samples, edges_only in ((1, False), (3, False), (2, True)):  # the last one by a plan of packets
            light.append(np.zeros((HEIGHT, WIDTH, 3)))
            renderer.render(scene, pixels, samples, light[-1], edges_only=edges_only)
        drawn.append(np.stack(light))
        assert (renderer.packing.last[2].square < TILE) == (edge < TILE)
    assert np.array_equal(*drawn), seed


@pytest.mark.parametrize(("make", "seed"), SCENES)
def test_bins_list_each_shape_once_and_the_nearest_first(make: Any, seed: int) -> None:
    arrays = Packing().pack(make(seed), WIDTH, HEIGHT)
    for near, found, every in [
        (arrays.cones[:, 4], arrays.tile_shapes, [group.tile_starts for group in arrays.groups]),
        *(
            (near, arrays.light_shapes, [group.light_starts[light] for group in arrays.groups])
            for light, near in enumerate(arrays.light_cones[..., 4])
        ),
    ]:
        assert np.isfinite(near).all()
        assert (near >= 0).all()
        for starts in every:
            at, shapes = listed(starts, found)
            assert (np.diff(near[shapes])[np.diff(at) == 0] >= 0).all()
            assert len(np.unique([at, shapes], axis=1).T) == len(shapes)


@pytest.mark.parametrize("seed", range(8))
def test_a_sphere_is_listed_only_near_the_pixels_that_show_it(seed: int) -> None:
    random = np.random.default_rng(seed)
    ball = Sphere(tuple(0.5 * random.normal(size=3) + (0, 0, 5)), random.uniform(0.1, 3), (1, 2, 3))
    arrays = Packing().pack(Scene((Camera((0, 0, 0), (0, 0, 1), 90), ball)), 640, 640)
    listed = np.diff(arrays.groups[0].tile_starts).reshape(40, 40) > 0
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(640), np.arange(640)))
    ((hit, _),) = hits_of_all_shapes(arrays, Vec(*arrays.camera[:3]), unit(ray_direction(arrays.camera, x, y)))
    assert not hit.reshape(640, 640)[[0, -1]].any()
    for axis in (0, 1):
        seen, there = (np.flatnonzero(each.any(axis=axis)) for each in (hit.reshape(640, 640), listed))
        assert there[0] in (seen[0] // TILE, seen[0] // TILE - 1)
        assert there[-1] in (seen[-1] // TILE, seen[-1] // TILE + 1)


def test_a_huge_ball_is_not_listed_above_its_horizon() -> None:
    # The centre is only 3 in front of the eye, and the radius far greater.
    planet = Sphere((0, -101, 3), 200, (1, 2, 3))
    arrays = Packing().pack(Scene((Camera((0, 0, 0), (0, 0, 1), 90), planet)), 320, 320)
    listed = np.diff(arrays.groups[0].tile_starts).reshape(20, 20) > 0
    assert listed[13:].all()
    assert not listed[:9].any()


@KERNELS
@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-7])
def test_corners_and_tangents_are_in_the_bounding_cone(size: float, kernel: Any) -> None:
    """The cone encloses corners of triangles and rims of balls of this size, seen from a point, and hardly more."""
    random = np.random.default_rng(7)
    for _ in range(100):
        way = unit_direction(random)
        corners = 10.0 ** random.uniform(-3, 3) * (way + size * 0.4 * random.normal(size=(3, 3)))
        axis, cosine = cone_from_origin(kernel, np.c_[corners, np.zeros(3)])
        assert all(np.dot(axis, corner / np.linalg.norm(corner)) >= cosine for corner in corners)
        sine = size * random.uniform(0.3, 0.99999)
        axis, cosine = cone_from_origin(kernel, np.array([[*3 * way, 3 * sine]]))
        aside = np.cross(way, unit_direction(random))
        rim = np.sqrt(1 - sine * sine) * way + sine * aside / np.linalg.norm(aside)
        assert np.dot(axis, rim / np.linalg.norm(rim)) >= cosine
        wider = 1.01 * np.arcsin(sine) + 2e-7
        assert cosine > np.cos(wider)


def cone_from_origin(kernel: Any, balls: np.ndarray) -> tuple[np.ndarray, float]:
    """The bounding cone of the hull of some balls, seen from the origin: axis and cosine."""
    arrays = ShapeArrays()
    arrays.update((Sphere((0, 0, 0), 1, (1, 2, 3)),))
    arrays.balls, arrays.first_ball = balls, np.array([0, len(balls)])
    bins = visibility.Bins(kernel, arrays, light_buffers.cube_grid(2))
    bins.see_from(np.zeros(3))
    return bins.arrays.cones[0, :3], float(bins.arrays.cones[0, 3])


# Lists of shapes that would take too much memory are made of coarser cells, and the picture stays the same.
SCENE = "A 0.2 255,255,255\nC 0,0,-9 0,0,1 60\nL 2,5,-6 0.7 255,255,255\npl 0,-3,0 0,1,0 90,120,150\n"
BALLS = [f"sp {x},{y},{(x * y) % 3} 1.2 255,{20 * x + 120},90" for x in range(-4, 5) for y in range(-3, 4)]


def scene(times: int = 1) -> Scene:
    """Return a scene of overlapping spheres, each so many times; a light buffer has 32 cells along an edge."""
    return parse(SCENE + "\n".join(BALLS * times) + "\n", "x.rt").scene


def light_of(scene: Scene) -> tuple[np.ndarray, int]:
    """Return the light of a picture of the scene, and the cells of its light buffers."""
    renderer, light = Renderer(threads=1), np.zeros((48, 64, 3))
    assert renderer.render(scene, np.empty((48, 64, 4), np.uint8), 1, light)
    assert renderer.packing.last is not None
    return light, int(renderer.packing.last[2].light_buffer_cells)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_too_many_cones_of_lights_take_no_memory_and_give_the_same_picture(
    precision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    lit = parse(SCENE + "\n".join([*BALLS, *(f"l {x},6,-6 0.1 255,255,255" for x in range(6))]), "x.rt").scene
    lights, found = [], []
    for most in (light_buffers.MOST_CONES, 1):
        monkeypatch.setattr(light_buffers, "MOST_CONES", most)
        renderer, light = Renderer(threads=1, precision=precision), np.zeros((48, 64, 3))
        assert renderer.render(lit, np.empty((48, 64, 4), np.uint8), 1, light)
        assert renderer.packing.last is not None
        lights.append(light)
        found.append(renderer.packing.last[2].light_cones.any())
        kept = [each for each in renderer.packing.cache.values() if isinstance(each, visibility.BinnedShapes)]
        assert sum(len(each.cones) > 0 for each in kept) == (7 if most > 1 else 4)
    assert np.array_equal(*lights)
    assert found == [True, False]


def test_lights_that_are_deleted_bring_the_cones_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(light_buffers, "MOST_CONES", 6 * (len(BALLS) + 1))
    packing, lamps = Packing(), [f"dl 0.{y},-1,0 0.1 255,255,255" for y in range(1, 7)]
    lit = parse(SCENE + "\n".join([*BALLS, *lamps]), "x.rt").scene
    assert not packing.pack(lit, 64, 48).light_cones.any()
    assert packing.pack(lit.remove(lit.lights[1]), 64, 48).light_cones.any()


def test_coarser_cells_give_the_same_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    expected, cells = light_of(scene())
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(light_buffers, "QUICKLY_BUILT", 20_000)
    coarse, fewer = light_of(scene())
    assert fewer < cells
    assert np.array_equal(coarse, expected)


def test_lists_that_no_cells_make_small_enough_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(system, "room", lambda: 64 * 48 * 7)  # enough for the picture
    with pytest.raises(RenderError, match=r"the lists of shapes in view need about [0-9]+ KiB of memory"):
        minirt.render(scene(9), 64, 48, linear=False)


def test_few_lights_keep_scratch_memory() -> None:
    packing, lights = Packing(), (FurtherLight((0, 5, 0.1 * i), 1) for i in range(2 * FEW))
    packing.pack(scene().add(*lights), 64, 48)
    bins = [each.bins for each in packing.cache.values() if isinstance(each, visibility.BinnedShapes)]
    assert [each is not None for each in bins] == [True] * FEW + [False] * (FEW + 1)
