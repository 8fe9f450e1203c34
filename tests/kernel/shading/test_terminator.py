"""The shadow terminator: smooth meshes follow the surface that they stand for, and bumps end without an edge."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.fields import MeshFile
from minirt.kernel.shading.shade import bump_fading
from minirt.lanes import Vec
from minirt.materials import Bump
from minirt.meshes import Triangles
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Mesh, Sphere, smooth_triangle
from tests.meshes.examples import ball, named
from tests.shapes.regimes import random_directions, unit

WHITE = (255, 255, 255)
EYE = Camera((0, 0, -9), (0, 0, 1), 40)
SIDE = Light((9, 4, -1), 1.0, WHITE)


def split(triangles: Triangles) -> Triangles:
    """Split each triangle of a mesh of the unit sphere into four."""
    corners = triangles.points[triangles.corners]
    middles = unit((corners + np.roll(corners, -1, axis=1)).reshape(-1, 3)).reshape(-1, 3, 3)
    (a, b, c), (ab, bc, ca) = corners.swapaxes(0, 1), middles.swapaxes(0, 1)
    points = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    numbers = np.arange(len(points)).reshape(-1, 3)
    return Triangles(points, numbers, points[numbers])


def smooth_ball(splits: int) -> Mesh:
    """Return a mesh of a sphere of radius 2, with its normals: an icosahedron, split several times."""
    triangles = ball(0)
    for _ in range(splits):
        triangles = split(triangles)
    return Mesh(MeshFile("ball.obj", triangles), (0, 0, 0), 2.0, WHITE)


def stacked(v: Vec) -> np.ndarray:
    return np.stack([v.x, v.y, v.z], axis=1)


def test_smooth_points_lie_above_the_sphere_by_no_more_than_the_facets_lie_below() -> None:
    random = np.random.default_rng(1)
    heights = []
    for splits in range(5):
        shape = smooth_ball(splits)
        rows = shape.rows().repeat(9, axis=0)
        packed = smooth_triangle.PackedMeshTriangle._make(
            [*(Vec(*rows.T[i : i + 3]) for i in range(0, 21, 3)), *rows.T[21:]]
        )
        corners = rows[:, :9].reshape(-1, 3, 3)
        points = np.einsum("ij,ijk->ik", random.dirichlet((1, 1, 1), len(corners)), corners)
        for side in (1.0, -1.0):
            facing = Vec(side * packed.normal.x, side * packed.normal.y, side * packed.normal.z)
            found = stacked(smooth_triangle.smooth_point(packed, Vec(*points.T), facing))
            if side < 0:
                assert np.array_equal(found, points)  # from within, the facets lie before the sphere
            else:
                above, below = np.linalg.norm(found, axis=1) - 2, 2 - np.linalg.norm(points, axis=1)
                assert (above >= -1e-15).all()
                assert (above <= below).all()
                heights.append(above.max())
    assert all(finer < coarser / 3 for coarser, finer in pairwise(heights[1:]))


def lit_pixels(shape: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Render a ball in light from the side; return which pixels are lit, and which should be by their normals."""
    scene = Scene((EYE, SIDE, shape))
    seen = minirt.render(scene, 200, 200).linear[..., 0].ravel()
    x, y = (each.ravel() for each in np.meshgrid(np.arange(200) + 0.5, np.arange(200) + 0.5))
    half = np.tan(np.radians(20))
    directions = unit(np.stack([(1 - x / 100) * half, (1 - y / 100) * half, np.ones_like(x)], axis=1))
    hits = minirt.trace(scene, np.broadcast_to(np.array(EYE.position), directions.shape), directions)
    on = hits.owner == 0
    normals = unit(hits.point[on])
    cosine = np.einsum("ij,ij->i", normals, unit(np.array(SIDE.position) - hits.point[on]))
    sure = np.abs(cosine) > 1e-9
    return seen[on][sure] > 0, cosine[sure] > 0


@pytest.mark.parametrize("splits", [1, 2, 3])
def test_the_edge_of_light_on_a_smooth_ball_is_that_of_the_sphere(splits: int) -> None:
    lit, right = lit_pixels(smooth_ball(splits))
    assert 2000 < right.sum() < len(right) - 2000
    assert not (lit & ~right).any()
    assert (right & ~lit).sum() <= 1e-3 * len(right)


def test_a_smooth_closed_mesh_that_is_lit_from_within_is_dark_outside() -> None:
    shape = named("knot", scale=2.0)
    row = shape.rows()[1000]
    within = row[:9].reshape(3, 3).mean(axis=0) - 0.2 * row[9:12]
    for closed, light in ((shape, within), (smooth_ball(1), (0.5, 0.3, -0.4)), (smooth_ball(2), (0.0, 0.0, 0.0))):
        scene = Scene((EYE, Light(tuple(light), 1.0, WHITE), closed))
        assert not minirt.render(scene, 200, 150).linear.any()
        inside = Scene((Camera((0, 0, 0), (0, 0, 1), 60), SIDE, closed))
        assert closed is shape or not minirt.render(inside, 200, 150).linear.any()


def test_light_of_bumps_fades_as_the_tangents_say() -> None:
    random = np.random.default_rng(2)
    base, bumped, light = (random_directions(random, 5000) for _ in range(3))
    bumped = unit(base + 0.7 * random.random((5000, 1)) * bumped)
    light = np.where((light * base).sum(axis=1)[:, None] < 0, -light, light)
    found = bump_fading(*(Vec(*each.T) for each in (base, bumped, light)))

    def squared_tangent(other: np.ndarray) -> np.ndarray:
        return (np.cross(base, other) ** 2).sum(axis=1) / (base * other).sum(axis=1) ** 2

    rough = np.minimum(squared_tangent(bumped) / 8, 1)
    assert np.allclose(found, 2 / (1 + np.sqrt(1 + rough * squared_tangent(light))), rtol=1e-12)
    assert found.min() < 0.3


def test_light_of_bumps_ends_continuously_where_the_light_sets() -> None:
    up, leaning = Vec(0.0, 0.0, 1.0), Vec(0.6, 0.0, 0.8)
    height = np.array([-0.5, -1e-9, 0.0, 1e-9, 1e-3, 0.1, 0.5, 1.0])
    light = Vec(np.sqrt(1 - height**2), 0 * height, height)
    found = bump_fading(up, leaning, light)
    assert not found[:3].any()
    assert 0 < found[3] < 1e-8
    assert (np.diff(found[2:]) > 0).all()
    assert found[-1] == 1.0
    assert (bump_fading(up, up, light)[3:] == 1.0).all()
    assert (bump_fading(up, Vec(1.0, 0.0, 0.0), light) <= 1.0).all()


def test_flat_bumps_leave_the_picture_as_it_is(tmp_path: Path) -> None:
    pillow.fromarray(np.full((8, 8), 90, np.uint8)).save(tmp_path / "flat.png")
    smooth = Sphere((0, 0, 0), 5, WHITE), named("knot", (0, 0, -3))
    bumped = [shape.replace(bump=Bump(str(tmp_path / "flat.png"), 0.1)) for shape in smooth]
    one, other = (
        minirt.render(Scene((Ambient(0.1, WHITE), EYE, SIDE, *shapes)), 160, 120).array for shapes in (smooth, bumped)
    )
    assert np.array_equal(one, other)
