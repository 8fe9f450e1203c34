"""Meshes of arrays and of trimesh are those of files, and saving a scene writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.meshes import load_mesh
from minirt.meshes.from_arrays import obj_text, triangles_of
from minirt.rendering.settings import identity
from tests.meshes.examples import FOLDER

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
NORMALS, UVS = [[0, 0, -2], [0, 0, -1], [0, 1, -1], [0, 0, 0]], [[0, 0], [1, 0], [1, 1], [0.25, 1 / 3]]
LIT = "A 0.3 255,255,255\nC 0.5,0.5,-3 0,0,1 60\nL 0,3,-5 0.7\n"
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.uint16), [(0, 1, 2), (0, 2, 3)], [[0, 1, 2, 3]]


@pytest.mark.parametrize("faces", FACES, ids=["array", "triangles", "a square"])
def test_faces_are_an_array_or_lists_of_any_lengths(faces: Any) -> None:
    mesh = minirt.Mesh.from_arrays(SQUARE, faces, position=(1, 2, 3), scale=2, colour=(9, 8, 7), mirror=0.5)
    assert mesh.triangles.corners.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (mesh.position, mesh.scale, mesh.colour, mesh.mirror) == ((1, 2, 3), 2, (9, 8, 7), minirt.Mirror(0.5))


def test_a_hollow_face_is_cut_into_its_ears() -> None:
    arrow = [[0, 0, 0], [2, 2, 0], [0, 1, 0], [-2, 2, 0]]  # a fan around the last corner would cover too much
    mesh = minirt.Mesh.from_arrays(arrow, [[3, 0, 1, 2]])
    assert {frozenset(each) for each in mesh.triangles.corners.tolist()} == {frozenset({0, 1, 2}), frozenset({0, 2, 3})}


@pytest.mark.parametrize("normals", [None, NORMALS], ids=["flat", "smooth"])
@pytest.mark.parametrize("uvs", [None, UVS], ids=["plain", "mapped"])
def test_the_written_file_reads_as_the_same(tmp_path: Path, normals: Any, uvs: Any) -> None:
    given = triangles_of(np.array(SQUARE) / 3, [[0, 1, 2], [0, 2, 3]], normals, uvs)
    (tmp_path / "a.obj").write_bytes(obj_text(given))
    read = load_mesh(tmp_path / "a.obj")
    assert np.array_equal(read.points, given.points)
    assert np.array_equal(read.corners, given.corners)
    assert (read.uvs is None) == (uvs is None)
    assert (read.normals is None) == (normals is None)
    if read.uvs is not None:
        assert np.array_equal(read.uvs, np.array(UVS)[given.corners])
    if read.normals is not None:
        assert np.abs(read.normals - given.normals).max() <= 2.0**-53
        s = 0.5**0.5
        assert np.allclose(given.normals[0], [[0, 0, -1], [0, 0, -1], [0, s, -s]])
        assert np.abs(given.normals[1, 2]).tolist() == [0, 0, 1], "a normal of length 0 is that of the triangle"


@pytest.mark.parametrize("name", ["knot", "icosphere"])
def test_the_picture_is_that_of_the_file(name: str) -> None:
    file = load_mesh(FOLDER / f"{name}.obj")
    how: dict[str, Any] = {"position": (0.5, 0.5, 3), "scale": 0.6, "colour": (200, 90, 30)}
    of_arrays = minirt.Mesh.from_arrays(file.points, file.corners, **how)
    of_file = minirt.Mesh(minirt.MeshFile("flat.obj", type(file)(file.points, file.corners)), **how)
    one, other = (minirt.render(minirt.loads(LIT).add(each), 64, 48).array for each in (of_file, of_arrays))
    assert np.array_equal(one, other)
    assert len(np.unique(one)) > 50


def test_saving_a_scene_writes_its_meshes(tmp_path: Path) -> None:
    scene = minirt.loads(LIT).add(
        minirt.Mesh.from_arrays(SQUARE, [[0, 1, 2]], uvs=UVS),
        minirt.Mesh.from_arrays(SQUARE, [[0, 2, 3]], file="my half.obj"),
    )
    path = tmp_path / "scene.rt"
    for _ in range(2):  # the second time the files are there
        scene.save(path)
    assert sorted(each.suffix for each in tmp_path.iterdir()) == [".obj", ".obj", ".rt"]
    read = minirt.load(path)
    assert np.array_equal(minirt.render(read, 40, 30).array, minirt.render(scene, 40, 30).array)
    assert minirt.dumps(read) == minirt.dumps(scene)
    (tmp_path / "my half.obj").write_text("another")
    before = path.read_bytes()
    with pytest.raises(minirt.SceneError, match=r"my half.obj: is another file: give the mesh another name"):
        scene.remove(scene.meshes[0]).save(path)
    assert (path.read_bytes(), (tmp_path / "my half.obj").read_text()) == (before, "another")


def test_work_on_meshes_of_arrays_is_told_apart_by_their_contents() -> None:
    meshes = (minirt.Mesh.from_arrays(SQUARE, faces, file="a.obj") for faces in ([[0, 1, 2]], [[0, 2, 3]]))
    one, other = map(minirt.loads(LIT).add, meshes)
    assert minirt.dumps(one) == minirt.dumps(other)
    assert identity(one, "") == identity(one, "") != identity(other, "")


WRONG: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    r"vertices must be an array \(n, 3\) of numbers, got \(1, 2\)": ([[0, 0]], [[0, 0, 0]], {}),
    r"vertices must be an array \(n, 3\) of numbers, got \(0,\)": ("abc", [[0, 1, 2]], {}),
    r"vertices must be numbers of at most 1e\+15": ([[0, 0, np.nan]] * 3, [[0, 1, 2]], {}),
    r"faces must be indices of vertices, from 0 to 3, got 4": (SQUARE, [[0, 1, 4]], {}),
    r"faces must be indices of vertices, from 0 to 3, got -1": (SQUARE, [[0, 1, 2], [0, 1, -1]], {}),
    r"faces have no triangle that is more than a line": (SQUARE, [[0, 1, 1]], {}),
    r"normals must be an array \(4, 3\) of numbers, got \(1, 3\)": (SQUARE, [[0, 1, 2]], {"normals": [[0, 0, 1]]}),
    r"uvs must be an array \(4, 2\) of numbers, got \(4, 3\)": (SQUARE, [[0, 1, 2]], {"uvs": SQUARE}),
}
NO_FACES = (
    [],
    5,
    None,
    [[0, 1]],
    [[0.0, 1.0, 2.0]],
    [[0, 1, 2], "abc"],
    [[[0, 1, 2]]],
    np.zeros((2, 3, 3), int),
    [["a"] * 3],
)


@pytest.mark.parametrize("message", WRONG)
def test_wrong_arrays_are_named(message: str) -> None:
    vertices, faces, how = WRONG[message]
    with pytest.raises(minirt.ElementError, match=f"^mesh {message}"):
        minirt.Mesh.from_arrays(vertices, faces, **how)


@pytest.mark.parametrize("faces", NO_FACES, ids=str)
def test_what_is_no_list_of_faces_is_refused(faces: Any) -> None:
    with pytest.raises(
        minirt.ElementError, match=r"^mesh faces must be an array \(m, 3\) of indices of vertices, or a"
    ):
        minirt.Mesh.from_arrays(SQUARE, faces)


def test_a_mesh_of_trimesh() -> None:
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere()
    mesh = minirt.Mesh.from_trimesh(ball, position=(0, 0, 5))
    assert np.array_equal(mesh.triangles.points, ball.vertices)
    assert np.array_equal(mesh.triangles.corners, ball.faces)
    assert (mesh.smooth, mesh.position, mesh.triangles.closed) == (False, (0, 0, 5), True)
    smooth = minirt.Mesh.from_trimesh(ball, smooth=True)
    assert np.allclose(smooth.triangles.normals, ball.vertices[ball.faces], atol=1e-2)
    ball.visual = trimesh.visual.TextureVisuals(ball.vertices[:, :2])
    assert np.allclose(minirt.Mesh.from_trimesh(ball).triangles.uvs, ball.vertices[ball.faces][..., :2])
    with pytest.raises(TypeError, match=r"^from_trimesh takes a trimesh.Trimesh, got <trimesh.Scene.*\.to_mesh\(\)$"):
        minirt.Mesh.from_trimesh(trimesh.Scene())
