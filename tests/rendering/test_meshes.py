"""Meshes among other shapes are traced, packed, edited, picked and outlined, each as one shape."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import minirt
from minirt.fields import MeshFile
from minirt.kernel import functions, interpreted
from minirt.kernel.scene_arrays import read_row
from minirt.lanes import Vec
from minirt.materials import Specular
from minirt.meshes import Triangles
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.pick import covers, pick
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Mesh, Plane, Sphere
from tests.meshes.examples import GREY, ball, first_hits, named, soup
from tests.rendering.test_scene_packing import assert_same
from tests.shapes.regimes import random_directions, unit

WHITE = (255, 255, 255)
EYE = Camera((0, 0, -9), (0, 0, 1), 60)
LIGHT = Light((5, 8, -9), 0.9, WHITE)


def corners(*shapes: Mesh) -> np.ndarray:
    return np.concatenate([each.rows()[:, :9].reshape(-1, 3, 3) for each in shapes])


def test_rays_hit_the_same_triangles_as_brute_force() -> None:
    random = np.random.default_rng(1)
    shapes = soup(random, 300), named("icosahedron", (1, 0, 0), 2.0), named("icosahedron", (-2, 1, 1), 0.7)
    origins, directions = 6 * random.normal(size=(3000, 3)), random_directions(random, 3000)
    hits = minirt.trace(Scene((EYE, *shapes)), origins, directions)
    right, triangle, doubt = first_hits(corners(*shapes), origins, directions)
    owner = np.where(triangle < 0, -1, np.searchsorted([300, 320, 340], triangle, side="right"))
    sure = doubt > 1e-9
    assert sure.mean() > 0.999
    assert np.array_equal(hits.owner[sure], owner[sure])
    is_hit = sure & np.isfinite(right)
    assert is_hit.sum() > 500
    assert np.abs(hits.distance[is_hit] / right[is_hit] - 1).max() < 1e-10
    points = origins + right[:, None] * directions
    assert np.abs(hits.point[is_hit] - points[is_hit]).max() < 1e-10


@pytest.mark.parametrize(("position", "scale"), [((0, 0, 0), 1.0), ((1e6, -3e5, 1 / 3), 1e-2)])
def test_no_ray_leaks_through_edges_and_corners(position: tuple[float, float, float], scale: float) -> None:
    random = np.random.default_rng(2)
    shape = named("icosphere", position, scale)
    made = corners(shape)
    count = 50_000
    ends = made[random.integers(len(made), size=count)]
    share = random.random((count, 1)) * (np.arange(count)[:, None] % 5 > 0)  # every fifth at a corner
    aims = ends[:, 0] + share * (ends[:, 1] - ends[:, 0])
    inside = position + 0.9 * scale * random.random((count, 1)) * random_directions(random, count)
    through = minirt.trace(Scene((EYE, shape)), inside, aims - inside)
    assert np.isfinite(through.distance).all()
    outside = position + 3 * scale * random_directions(random, count)
    met = minirt.trace(Scene((EYE, shape)), outside, position + 0.5 * (aims - position) - outside)
    assert np.isfinite(met.distance).all()
    assert (met.distance < 3 * scale).all()


def test_a_ball_with_normals_is_lit_like_a_sphere() -> None:
    shape = Mesh(MeshFile("ball.obj", ball(3)), (0, 0, 0), 3.0, WHITE)
    scene = Scene((EYE, Light(EYE.position, 1.0, WHITE), shape))
    seen = minirt.render(scene, 160, 120).linear[..., 0].ravel()
    x, y = (each.ravel() for each in np.meshgrid(np.arange(160) + 0.5, np.arange(120) + 0.5))
    half = np.tan(np.radians(30))
    directions = unit(np.stack([(1 - x / 80) * half, (1 - y / 60) * half * 0.75, np.ones_like(x)], axis=1))
    hits = minirt.trace(scene, np.broadcast_to(np.array(EYE.position), directions.shape), directions)
    is_hit = hits.owner == 0
    assert 4000 < is_hit.sum() < 9000
    cosines = -np.einsum("ij,ij->i", unit(hits.point[is_hit]), directions[is_hit])
    assert np.abs(seen[is_hit] - np.maximum(cosines, 0)).max() < 1e-9  # at the rim a normal may lean away
    assert not seen[~is_hit].any()


def test_arrays_after_edits_equal_those_of_a_fresh_packing() -> None:
    ico, knot = named("icosahedron"), named("icosphere", (2, 0, 0), 0.5)
    balls = Sphere((0, 3, 0), 1, GREY), Sphere((0, -3, 0), 1, GREY)
    scene = Scene((Ambient(0.2, WHITE), EYE, LIGHT, balls[0], ico, Plane((0, -5, 0), (0, 1, 0), GREY), knot, balls[1]))
    packing = Packing()
    packing.pack(scene, 24, 16)
    edits = [
        lambda s: s.replace(s.meshes[0], position=(0.5, 1, 0)),
        lambda s: s.replace(s.meshes[1], scale=2.0),
        lambda s: s.replace(s.meshes[1], colour=(1, 2, 3), specular=Specular(0.5, 20)),
        lambda s: s.replace(s.spheres[0], centre=(1, 1, 1)),
        lambda s: s.replace(s.meshes[0], s.meshes[0].replace(file=s.meshes[1].file)),  # more triangles
        lambda s: s.edit(len(s.elements) - 1, s.elements[-1], ico.replace(position=(0, 0, 9))),
        lambda s: s.edit(3),
        lambda s: s.replace(s.meshes[1], s.meshes[1].some(np.arange(5))),
        lambda s: s.edit(3),
    ]
    for edit in edits:
        scene = edit(scene)
        assert_same(packing.pack(scene, 24, 16), scene)
        sizes = [shape.parts for shape in scene.shapes]
        assert np.array_equal(packing.shape_arrays.owner, np.repeat(np.arange(len(sizes)), sizes))
        assert packing.shape_arrays.first_primitive.tolist() == [0, *np.cumsum(sizes)]


@pytest.mark.parametrize("kernel", [functions, interpreted], ids=["compiled", "interpreted"])
def test_the_kernel_reads_the_packed_triangles_of_a_mesh_that_was_moved_turned_and_scaled(kernel: Any) -> None:
    """One mesh has normals, one texture coordinates, and the corners of the last are one point in the scene."""
    dot = Triangles(np.array([[0.0, 0, 0], [1e-20, 0, 0], [0, 1e-20, 0]]), np.array([[0, 1, 2]]))
    files = MeshFile("ball.obj", ball(1)), named("icosahedron").file, named("pot").file, MeshFile("dot.obj", dot)
    meshes = [Mesh(file, (i, 0.1, 0.0), 1.0, GREY) for i, file in enumerate(files)]
    packing, arrays = Packing(kernel), None
    for axis in ((0.0, 1.0, 0.0), (0.6, 0.0, 0.8)):
        meshes = [mesh.replace(axis=axis, scale=1.7, position=(1e3, 0.3, i)) for i, mesh in enumerate(meshes)]
        arrays = packing.pack(Scene((EYE, *meshes)), 24, 16)
    rows = np.concatenate([mesh.rows() for mesh in meshes])
    for i in range(0, len(rows), 7) if kernel is functions else (0, 90, 100, len(rows) - 1):
        found = np.hstack([(v.x, v.y, v.z) if isinstance(v, Vec) else v for v in read_row(arrays.groups[0], i)])
        assert np.array_equal(found[:9], rows[i, :9])
        assert np.array_equal(found[21:], rows[i, 21:])
        assert np.allclose(found[9:12], rows[i, 9:12], rtol=0, atol=1e-15)
        if i < meshes[0].parts:
            assert np.allclose(found[12:21], rows[i, 12:21], rtol=0, atol=1e-15)


def test_a_pixel_is_picked_for_the_mesh_that_it_shows() -> None:
    shapes = named("knot", (1, 0, 0), 2.0), named("pot", (-3, -1, 2), 1.5), Sphere((0, 2, 0), 2, GREY)
    scene, shape_arrays = Scene((EYE, *shapes)), ShapeArrays()
    shown = [pick(scene, 40, 30, x, y, shape_arrays)[0] for y in range(0, 30, 2) for x in range(0, 40, 2)]
    assert {*shapes, None} == set(shown)
    for x, y in ((11, 9), (15, 20), (30, 18), (0, 0)):
        _, point = pick(scene, 40, 30, x, y)
        if point:
            direction = np.array(point) - EYE.position
            hits = minirt.trace(scene, [EYE.position], [direction])
            assert hits.distance[0] == pytest.approx(np.linalg.norm(direction), rel=1e-9)


def test_the_first_of_coincident_meshes_is_picked() -> None:
    one, other = named("icosphere", scale=2.0), named("icosphere", scale=2.0, mirror=0.5)
    for shapes in ((one, other), (other, one)):
        for x, y in ((32, 24), (30, 20), (36, 27)):
            assert pick(Scene((EYE, *shapes)), 64, 48, x, y)[0] is shapes[0]


@pytest.mark.parametrize("name", ["icosahedron", "icosphere", "knot", "pot", "soup"])
def test_an_outline_encloses_the_pixels_whose_rays_hit(name: str) -> None:
    random = np.random.default_rng(3)
    shape = soup(random, 60).replace(scale=0.7) if name == "soup" else named(name, (0.3, 0.2, 0.1), 2.5)
    camera = Camera((3.0, 4.0, -9.0), (-0.3, -0.35, 0.9), 70, roll=20)
    x, y = np.meshgrid(np.arange(80), np.arange(60))
    found = covers(shape, camera, 80, 60, x, y)
    scene = Scene((camera, shape))
    picked = [[pick(scene, 80, 60, i, j)[0] is shape for i in range(0, 80, 4)] for j in range(0, 60, 4)]
    assert np.array_equal(found[::4, ::4], picked)
    assert 20 < np.sum(picked) < 290
    assert not covers(shape, camera, 80, 60, np.array([-1, 80, 3]), np.array([3, 3, 60])).any()


def test_a_mesh_that_fills_the_picture_covers_no_pixel_beside_it() -> None:
    x, y = np.array([3, -1, 8, 3, 3]), np.array([3, 3, 3, -1, 6])
    found = covers(named("icosphere", scale=5.0), Camera((0, 0, -9), (0, 0, 1), 20), 8, 6, x, y)
    assert found.tolist() == [True, False, False, False, False]


def test_a_mesh_around_the_eye_has_no_outline() -> None:
    camera = Camera((0, 0, 0), (0, 0, 1), 70)
    x, y = np.meshgrid(np.arange(8), np.arange(6))
    assert not covers(named("icosphere"), camera, 8, 6, x, y).any()
