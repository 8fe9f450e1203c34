"""The reader of .obj files gives the right triangles; Newell's teapot is closed."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.meshes import Triangles, load_mesh, obj
from tests.paths import ROOT, SCENES

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(text: str) -> Triangles:
    """Parse the text of a file."""
    return obj.parse(text.encode())


def corners(triangles: Triangles) -> list[list[list[float]]]:
    """Return the coordinates of the corners of triangles."""
    return triangles.points[triangles.corners].tolist()


def test_points_and_faces_are_read_and_other_lines_skipped() -> None:
    mesh = read("# one\no thing\nv 0 0 0\nv 1e0 0 0.5\nv -1 +2. .25\n\nusemtl red\ns 1\nf 1 2 3\n")
    assert corners(mesh) == [[[0, 0, 0], [1, 0, 0.5], [-1, 2, 0.25]]]
    assert mesh.normals is None
    assert mesh.uvs is None


def test_a_face_of_many_corners_is_a_fan() -> None:
    mesh = read("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\nf 3 2 1\n")
    assert mesh.corners.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 1, 0]]


def test_negative_numbers_count_backwards() -> None:
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 0\nv 6 5 0\nv 6 6 0\nf -3 -2 -1\nf 1 -5 -4\n"
    assert read(text).corners.tolist() == [[0, 1, 2], [3, 4, 5], [0, 1, 2]]


def test_a_face_may_name_later_points() -> None:
    assert len(read("f 1 2 3\n" + SQUARE)) == 1


@pytest.mark.parametrize("form", ["{0}/{0}/{0}", "{0}//{0}", "{0}/{0}"])
def test_normals_and_texture_coordinates_are_read(form: str) -> None:
    face = "f " + " ".join(form.format(i) for i in (1, 2, 3)) + "\n"
    mesh = read(SQUARE + "vt 0 0\nvt 1 0\nvt 1 .5\nvn 0 0 1\nvn 3 0 4\nvn 0 0 1e-200\n" + face)
    if form.count("{0}") == 3 or "//" not in form:
        assert mesh.uvs is not None
        assert mesh.uvs.tolist() == [[[0, 0], [1, 0], [1, 0.5]]]
    else:
        assert mesh.uvs is None
    if form.endswith("{0}/{0}") and form.count("{0}") == 2:
        assert mesh.normals is None
    else:
        assert mesh.normals is not None
        assert mesh.normals[0, :2].tolist() == [[0, 0, 1], [0.6, 0, 0.8]]


def test_missing_normals_and_texture_coordinates_of_some_corners_get_defaults() -> None:
    mesh = read(SQUARE + "vt 1 1\nvn 0 1 0\nf 1/1/1 2 3//1\nf 1 3 4\n")
    assert mesh.uvs is not None
    assert mesh.uvs.tolist() == [[[1, 1], [0, 0], [0, 0]], [[0, 0]] * 3]
    assert mesh.normals is not None
    assert mesh.normals.tolist() == [[[0, 1, 0], [0, 0, 1], [0, 1, 0]], [[0, 0, 1]] * 3]


def test_a_zero_normal_becomes_that_of_the_triangle() -> None:
    mesh = read(SQUARE + "vn 0 0 0\nvn 0 3 4\nf 1//1 2//2 3//1\n")
    assert mesh.normals is not None
    assert mesh.normals.tolist() == [[[0, 0, 1], [0, 0.6, 0.8], [0, 0, 1]]]


def test_each_triangle_has_the_mean_colour_of_its_corners() -> None:
    text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 {} 0 1\nvt 0 0 0\nf 1 2 3\n"
    mesh = read(text.format(0.4))
    assert corners(mesh) == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
    assert mesh.colours is not None
    assert mesh.colours.tolist() == [[204, 0, 85]]  # thirds of 255 times 2.4, 0 and 1
    assert mesh.notices == ("has colours of points: each triangle has the mean of those of its corners",)
    assert read("v 2 2 2\n" + text.format(0.4)).colours is None  # one point has none


def test_corners_may_name_texture_coordinates_and_normals_that_are_not_there() -> None:
    mesh = read(SQUARE + "vn 0 3 4\nf 1/2/1 2/0/-2 3//\nf 1/ 2/-1 4//1\n")
    assert mesh.corners.tolist() == [[0, 1, 2], [0, 1, 3]]
    assert mesh.uvs is None
    assert mesh.normals is not None
    assert mesh.normals[0].tolist() == [[0, 0.6, 0.8], [0, 0, 1], [0, 0, 1]]
    assert mesh.notices == (
        "has corners that name a vt that is not there (the first in line 6)",
        "has corners that name a vn that is not there (the first in line 6)",
    )


def test_lines_of_unknown_words_are_skipped_with_a_notice() -> None:
    mesh = read(SQUARE + "curv 0 1\nV 1 2 3\nf 1 2 3\n")
    assert len(mesh) == 1
    assert mesh.notices == ("has lines that begin with no word of .obj: they are skipped (the first is 5)",)


def test_a_backslash_continues_a_line_and_a_comment_ends_it() -> None:
    mesh = read("v 0 0 0 # zero\nv 1 \\\n 0 0\nv 0 1 0\nf 1 \\\r\n 2 \\\n 3 # all\r\nf 3 2 1 \\")
    assert mesh.corners.tolist() == [[0, 1, 2], [2, 1, 0]]


def test_windows_line_ends_tabs_and_a_byte_order_mark_are_read() -> None:
    assert len(read("\ufeff" + SQUARE.replace("\n", "\r\n").replace(" ", "\t") + "f 1\t2 3 ")) == 1


def test_degenerate_triangles_are_dropped() -> None:
    mesh = read(SQUARE + "v 2 0 0\nv 1 0 0\nf 1 2 5\nf 2 6 3\nf 1 1 2\nf 1 2 3\n")
    assert mesh.corners.tolist() == [[0, 1, 2]]


def test_a_sliver_is_kept() -> None:
    mesh = read("v 0 0 0\nv 1 0 0\nv 0.5 1e-12 0\nf 1 2 3\n")
    assert mesh.flat_normals.tolist() == [[0, 0, 1]]


def test_the_normals_of_a_file_orient_its_triangles() -> None:
    mesh = read(SQUARE + "vn 0 0 -1\nf 1//1 2//1 3//1\nf 3//1 2//1 1//1\n")
    assert mesh.flat_normals.tolist() == [[0, 0, -1], [0, 0, -1]]


def test_blocks_are_assembled_to_one_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [f"v {i} {i * i} 0\nf -1 -2 -3\n" if i > 1 else f"v {i} {i * i} 0\n" for i in range(50)]
    whole = read("".join(lines))
    assert len(whole) == 48
    monkeypatch.setattr(obj, "BLOCK_BYTES", 40)
    assert np.array_equal(read("".join(lines)).corners, whole.corners)


def test_a_continued_line_is_not_split_between_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj, "BLOCK_BYTES", 1)
    assert len(read(SQUARE + "f 1 \\\n2 \\\n3\n")) == 1


TEAPOT = SCENES / "meshes" / "teapot.obj"


def teapot() -> tuple[np.ndarray, list[list[int]]]:
    """Points and faces of the file."""
    lines = TEAPOT.read_text().splitlines()
    points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
    faces = [[int(each.split("/")[0]) - 1 for each in line.split()[1:]] for line in lines if line.startswith("f ")]
    return points, faces


def test_the_teapot_is_closed_and_its_normals_point_outwards() -> None:
    mesh = load_mesh(TEAPOT)
    assert mesh.closed
    assert not mesh.some(np.arange(1, len(mesh))).closed
    assert mesh.normals is not None
    a, b, c = np.moveaxis(np.asarray(mesh.points)[mesh.corners], 1, 0)
    flat = np.cross(b - a, c - a)
    agree = np.einsum("ij,ikj->ik", flat / np.linalg.norm(flat, axis=1)[:, None], np.asarray(mesh.normals))
    assert agree.min() > 0
    assert np.median(agree) > 0.99


def test_the_script_writes_the_teapot(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "assets"))
    import newell_teapot  # type: ignore[import-not-found]

    points, _, faces = newell_teapot.teapot()
    stored, stored_faces = teapot()
    assert np.abs(points - stored).max() < 6e-4
    assert [face[:, 0].tolist() for face in faces] == stored_faces
