"""Triangles of meshes: the element, its rows, its formulas."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.errors import ElementError, FieldError, FileError
from minirt.fields import MeshFile
from minirt.kernel.scene_arrays import read, row_type
from minirt.lanes import Vec
from minirt.meshes import Triangles
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import MESH, Mesh, Triangle, smooth_triangle
from tests.meshes.examples import GREY, ball, named, soup
from tests.shapes.execution_modes import U
from tests.shapes.regimes import random_directions, unit


def test_a_row_is_a_packed_triangle() -> None:
    made = named("knot", (1, 2, 3), 0.5)
    rows = made.rows().view(row_type(MESH))[:, 0]
    packed = made.pack()
    for i in (0, 7, made.parts - 1):
        one = read(rows, i)
        for name in one._fields:
            part, whole = getattr(one, name), getattr(packed, name)
            if isinstance(part, Vec):
                assert (part.x, part.y, part.z) == (whole.x[i], whole.y[i], whole.z[i])
            else:
                assert part == whole[i]


def test_a_mesh_is_its_triangles() -> None:
    """Verdicts, hits and normals of every triangle are those of a triangle shape with these corners."""
    random = np.random.default_rng(1)
    made = soup(random, 40).replace(position=(1.0, -2.0, 0.5), scale=3.0)
    rows = made.rows()
    origins, directions = random.normal(size=(200, 3)) * 9, random_directions(random, 200)
    for i, row in enumerate(rows):
        single = Triangle(*map(tuple, row[:9].reshape(3, 3).tolist()), GREY).pack()
        one = read(rows.view(row_type(MESH))[:, 0], i)
        for name in ("a", "b", "c"):
            assert repr(getattr(one, name)) == repr(getattr(single, name))
        normals = (np.array([v.x, v.y, v.z]) for v in (one.normal, single.normal))
        assert np.allclose(*normals, atol=1e-14, rtol=0)
        rays = Vec(*origins.T), Vec(*directions.T)
        with np.errstate(all="ignore"):
            hits = [MESH.intersect(one, *rays), MESH.intersect(single, *rays)]
        assert np.array_equal(hits[0][0], hits[1][0])
        slope = np.abs(directions @ row[9:12])
        away = np.linalg.norm(origins - row[:3], axis=1)
        assert (np.abs(hits[0][1] - hits[1][1]) <= 8 * U * away / slope)[hits[0][0]].all()


def test_balls_and_boxes_are_around_the_triangles() -> None:
    made = named("pot", (4, 5, 6), 2.0)
    arrays = ShapeArrays()
    arrays.update((made, made))
    corners = made.rows()[:, :9].reshape(-1, 3, 3)
    assert arrays.balls[:, :3].tolist() == 2 * [list(centre) for centre, _ in made.balls()]
    boxes, extents = arrays.primitive_boxes()
    assert np.array_equal(boxes[made.parts :, 0], corners.min(axis=1))
    assert np.array_equal(boxes[made.parts :, 1], corners.max(axis=1))
    assert np.array_equal(extents[made.parts :], np.abs(corners).max(axis=(1, 2)))
    low, high = np.array(made.bounds())
    assert np.array_equal(arrays.boxes, [[low, high]] * 2)
    assert np.array_equal(low, corners.min(axis=(0, 1)))
    assert np.array_equal(high, corners.max(axis=(0, 1)))
    hull = np.array([centre for centre, radius in made.balls() if radius == 0])
    assert np.array_equal([hull.min(axis=0), hull.max(axis=0)], [low, high])


def test_equal_corners_of_the_file_are_equal_in_the_scene() -> None:
    made = named("icosphere", (1e3, 1 / 3, -7e5), 0.1)
    corners = made.rows()[:, :9].reshape(-1, 3)
    which = made.triangles.corners.ravel()
    assert len(np.unique(corners, axis=0)) == len(np.unique(which))


def test_interpolated_normals_of_a_mesh_of_a_sphere_are_nearly_those_of_the_sphere() -> None:
    """On a chord of angle e the mean of the normals at both ends is that of the sphere in the middle, and off by less
    than e^3 / 16 elsewhere; on a triangle the error is at most that of its longest edge."""
    random = np.random.default_rng(2)
    triangles = ball(3)
    shape = Mesh(MeshFile("ball.obj", triangles), (3, 4, 5), 2.0, GREY)
    shares = random.dirichlet((1, 1, 1), triangles.corners.shape[0])
    corners = shape.rows()[:, :9].reshape(-1, 3, 3)
    points = np.einsum("ij,ijk->ik", shares, corners)
    packed = shape.pack()
    normals = smooth_triangle.shading(packed, Vec(*points.T), packed.normal)
    found = np.stack([normals.x, normals.y, normals.z], axis=1)
    outward = unit(points - np.array([3, 4, 5]))
    assert np.abs(np.linalg.norm(found, axis=1) - 1).max() < 1e-15
    assert np.linalg.norm(found - outward, axis=1).max() < 1e-13  # as the mean of the corners is the point
    flat = np.stack([packed.normal.x, packed.normal.y, packed.normal.z], axis=1)
    assert np.linalg.norm(flat - outward, axis=1).max() > 0.05


def test_barycentric_coordinates_are_those_of_the_point() -> None:
    random = np.random.default_rng(3)
    made = soup(random, 100)
    wanted = random.dirichlet((1, 1, 1), 100)
    points = np.einsum("ij,ijk->ik", wanted, made.rows()[:, :9].reshape(-1, 3, 3))
    assert np.allclose(
        np.stack(smooth_triangle.barycentric_coordinates(made.pack(), Vec(*points.T)), axis=1), wanted, atol=1e-12
    )


def test_barycentric_coordinates_stay_within_0_and_1_outside_the_triangle() -> None:
    random = np.random.default_rng(4)
    far = 100 * random.normal(size=(100, 3))
    with np.errstate(all="ignore"):
        for made in (soup(random, 100), soup(random, 100, 0.0)):
            found = np.stack(smooth_triangle.barycentric_coordinates(made.pack(), Vec(*far.T)), axis=1)
            assert (found >= 0).all()
            assert (found[:, 1:] == 0).any(axis=0).all()
            assert np.abs(found.sum(axis=1) - 1).max() < 1e-15


def test_corner_normals_that_cancel_give_the_normal_of_the_triangle() -> None:
    points, up = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([0.0, 0, 1])
    triangles = Triangles(points, np.array([[0, 1, 2]]), np.array([[[1.0, 0, 0], [-1, 0, 0], up]]))
    packed = Mesh(MeshFile("x.obj", triangles), (0, 0, 0), 1.0, GREY).pack()
    found = smooth_triangle.shading(packed, Vec(np.array([0.5]), np.array([0.0]), np.array([0.0])), packed.normal)
    assert [found.x, found.y, found.z] == [0, 0, 1]


def test_it_is_made_with_a_name_in_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    monkeypatch.chdir(tmp_path)
    for name in ("one.obj", Path("one.obj")):
        made = Mesh(name, (1, 2, 3), 2, GREY)
        assert made.bounds() == ((1, 2, 3), (3, 4, 3))
        assert made.file.name == "one.obj"
    monkeypatch.chdir("/")
    assert made.replace(scale=1).bounds() == ((1, 2, 3), (2, 3, 3))
    with pytest.raises(FileError, match=r"two\.obj: cannot be read"):
        Mesh("two.obj", (0, 0, 0), 1, GREY)
    for wrong in (3, ""):
        with pytest.raises((FieldError, ValueError), match="must be the name of a mesh file"):
            Mesh(wrong, (0, 0, 0), 1, GREY)
    assert minirt.Mesh is Mesh


def test_a_mesh_must_not_reach_too_far() -> None:
    assert named("icosahedron", scale=1e15).bounds()[1][0] == pytest.approx(0.85065e15)
    with pytest.raises(ElementError, match="position must not be so far out that the mesh reaches beyond 1e"):
        named("icosahedron", scale=1e15, position=(9e14, 0, 0))
    with pytest.raises(ElementError, match="scale must not be so large that the mesh reaches beyond 1e"):
        Mesh.from_arrays([[0, 0, 0], [2, 0, 0], [0, 2, 0]], [[0, 1, 2]], scale=1e15, position=(-9e14, 0, 0))


def surface_mapping(
    packed: smooth_triangle.PackedMeshTriangle, points: np.ndarray, normals: np.ndarray
) -> list[np.ndarray]:
    u, v, along_u, along_v = smooth_triangle.mapping(packed, Vec(*points.T), Vec(*normals.T))
    return [u, v, *(np.stack([each.x, each.y, each.z], axis=1) for each in (along_u, along_v))]


def test_texture_coordinates_are_those_of_the_file_and_tangents_their_derivatives() -> None:
    random = np.random.default_rng(5)
    made = named("knot", (1, 2, 3), 2.0)
    shares = random.dirichlet((2, 2, 2), made.parts)
    rows = made.rows()
    points = np.einsum("ij,ijk->ik", shares, rows[:, :9].reshape(-1, 3, 3))
    u, v, along_u, along_v = surface_mapping(made.pack(), points, rows[:, 9:12])
    assert np.allclose(np.stack([u, v], axis=1), np.einsum("ij,ijk->ik", shares, made.triangles.uvs), atol=1e-12)
    for step in (1e-4, -1e-4):  # a step along a tangent changes its own coordinate and not the other
        for along, change in ((along_u, (step, 0)), (along_v, (0, step))):
            later = surface_mapping(made.pack(), points + step * along, rows[:, 9:12])
            inside = np.minimum(*np.sort(shares, axis=1).T[:2]) > 0.02
            assert np.abs(later[0] - u - change[0])[inside].max() < 1e-9
            assert np.abs(later[1] - v - change[1])[inside].max() < 1e-9


def test_tangents_are_perpendicular_to_the_interpolated_normal() -> None:
    made = named("knot")
    packed, rows = made.pack(), made.rows()
    points = rows[:, :9].reshape(-1, 3, 3).mean(axis=1)
    smooth = smooth_triangle.shading(packed, Vec(*points.T), packed.normal)
    normals = np.stack([smooth.x, smooth.y, smooth.z], axis=1)
    _, _, along_u, along_v = surface_mapping(packed, points, normals)
    out = unit(np.cross(along_u, along_v))
    assert np.abs(np.abs(np.einsum("ij,ij->i", out, normals)) - 1).max() < 1e-12
    assert np.abs(np.einsum("ij,ij->i", out, rows[:, 9:12])).min() < 1 - 1e-5


def test_tangents_without_texture_coordinates_in_the_file() -> None:
    made = named("icosahedron")
    rows = made.rows()
    points = rows[:, :9].reshape(-1, 3, 3).mean(axis=1)
    with np.errstate(all="raise"):
        found = surface_mapping(made.pack(), points, rows[:, 9:12])
    assert all(np.isfinite(each).all() for each in found)
    assert np.allclose(found[:2], 1 / 3)  # half a picture on each triangle
    a, b, c = rows[:, :9].reshape(-1, 3, 3).swapaxes(0, 1)
    assert np.allclose(found[2], b - a)
    assert np.allclose(found[3], c - a)


def test_skewed_and_constant_texture_coordinates() -> None:
    random = np.random.default_rng(7)
    made = soup(random, 50)
    rows, packed = made.rows(), made.pack()
    points = rows[:, :9].reshape(-1, 3, 3).mean(axis=1)
    skew = packed._replace(**dict(zip(packed._fields[7:], random.uniform(-1, 1, (6, 50)), strict=True)))
    before = surface_mapping(skew, points, rows[:, 9:12])
    for i, along in enumerate(before[2:]):
        step = 1e-3 / (1 + np.linalg.norm(along, axis=1, keepdims=True))
        later = surface_mapping(skew, points + step * along, rows[:, 9:12])
        assert np.abs(later[i] - before[i] - step[:, 0]).max() < 1e-9
        assert np.abs(later[1 - i] - before[1 - i]).max() < 1e-9
    one = packed._replace(**dict.fromkeys(packed._fields[7:], np.full(50, 0.3)))
    for flat in (one, one._replace(u_b=skew.u_b), one._replace(v_c=skew.v_c)):
        assert not np.any(surface_mapping(flat, points, rows[:, 9:12])[2:])


def test_points_are_projected_onto_the_plane_of_the_triangle() -> None:
    made = named("knot", (1, 2, 3), 2.0)
    rows, random = made.rows(), np.random.default_rng(6)
    points = np.einsum("ij,ijk->ik", random.dirichlet((1, 1, 1), made.parts), rows[:, :9].reshape(-1, 3, 3))
    beside = points + random.normal(size=(made.parts, 1)) * rows[:, 9:12]
    on, normal = smooth_triangle.surface(made.pack(), Vec(*beside.T))
    assert np.abs(np.stack([on.x, on.y, on.z], axis=1) - points).max() < 1e-14
    assert np.array_equal(np.stack([normal.x, normal.y, normal.z], axis=1), rows[:, 9:12])
