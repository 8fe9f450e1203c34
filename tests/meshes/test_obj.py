"""What is read of .obj files, in both ways of reading them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from minirt.meshes import Triangles, diagnosing, fast, obj
from minirt.meshes.block import Block, Counts

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
Read = Callable[[str], Triangles]


@pytest.fixture(params=["plain", "careful"])
def read(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Read:
    """Reads a file in one way, and in that alone."""
    if request.param == "careful":
        monkeypatch.setattr(fast, "read", lambda *_: None)
    else:
        monkeypatch.setattr(diagnosing, "read", None)
    return lambda text: obj.parse(text.encode())


def careful_only(text: str) -> Triangles:
    """The triangles of a file that is read line by line."""
    assert fast.read(text.encode().splitlines(keepends=True), Counts()) is None
    return obj.parse(text.encode())


def corners(made: Triangles) -> list[list[list[float]]]:
    return made.points[made.corners].tolist()


def test_a_triangle(read: Read) -> None:
    made = read("# one\no thing\nv 0 0 0\nv 1e0 0 0.5\nv -1 +2. .25\n\nusemtl red\ns 1\nf 1 2 3\n")
    assert corners(made) == [[[0, 0, 0], [1, 0, 0.5], [-1, 2, 0.25]]]
    assert made.normals is None
    assert made.uvs is None


def test_a_face_of_many_corners_is_a_fan(read: Read) -> None:
    made = read("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\nf 3 2 1\n")
    assert made.corners.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 1, 0]]


def test_numbers_below_zero_count_backwards(read: Read) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 0\nv 6 5 0\nv 6 6 0\nf -3 -2 -1\nf 1 -5 -4\n"
    assert read(text).corners.tolist() == [[0, 1, 2], [3, 4, 5], [0, 1, 2]]


def test_a_face_may_name_what_comes_behind_it(read: Read) -> None:
    assert len(read("f 1 2 3\n" + SQUARE)) == 1


@pytest.mark.parametrize("form", ["{0}/{0}/{0}", "{0}//{0}", "{0}/{0}"])
def test_normals_and_places_of_pictures(read: Read, form: str) -> None:
    face = "f " + " ".join(form.format(i) for i in (1, 2, 3)) + "\n"
    made = read(SQUARE + "vt 0 0\nvt 1 0\nvt 1 .5\nvn 0 0 1\nvn 3 0 4\nvn 0 0 1e-200\n" + face)
    if form.count("{0}") == 3 or "//" not in form:
        assert made.uvs is not None
        assert made.uvs.tolist() == [[[0, 0], [1, 0], [1, 0.5]]]
    else:
        assert made.uvs is None
    if form.endswith("{0}/{0}") and form.count("{0}") == 2:
        assert made.normals is None
    else:
        assert made.normals is not None
        assert made.normals[0, :2].tolist() == [[0, 0, 1], [0.6, 0, 0.8]]


def test_corners_without_what_others_have() -> None:
    made = careful_only(SQUARE + "vt 1 1\nvn 0 1 0\nf 1/1/1 2 3//1\nf 1 3 4\n")
    assert made.uvs is not None
    assert made.uvs.tolist() == [[[1, 1], [0, 0], [0, 0]], [[0, 0]] * 3]
    assert made.normals is not None
    assert made.normals.tolist() == [[[0, 1, 0], [0, 0, 1], [0, 1, 0]], [[0, 0, 1]] * 3]


def test_a_normal_of_no_length_is_that_of_the_triangle(read: Read) -> None:
    made = read(SQUARE + "vn 0 0 0\nvn 0 3 4\nf 1//1 2//2 3//1\n")
    assert made.normals is not None
    assert made.normals.tolist() == [[[0, 0, 1], [0, 0.6, 0.8], [0, 0, 1]]]


def test_further_numbers_of_a_point_are_left_out(read: Read) -> None:
    made = read("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0.5 0 1\nvt 0 0 0\nf 1 2 3\n")
    assert corners(made) == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]


def test_a_line_may_go_on_in_the_next_and_end_in_a_comment() -> None:
    made = careful_only("v 0 0 0 # zero\nv 1 \\\n 0 0\nv 0 1 0\nf 1 \\\r\n 2 \\\n 3 # all\r\nf 3 2 1 \\")
    assert made.corners.tolist() == [[0, 1, 2], [2, 1, 0]]


def test_windows_line_ends_tabs_and_a_byte_order_mark(read: Read) -> None:
    assert len(read("\ufeff" + SQUARE.replace("\n", "\r\n").replace(" ", "\t") + "f 1\t2 3 ")) == 1


def test_what_is_no_more_than_a_line_is_dropped(read: Read) -> None:
    made = read(SQUARE + "v 2 0 0\nv 1 0 0\nf 1 2 5\nf 2 6 3\nf 1 1 2\nf 1 2 3\n")
    assert made.corners.tolist() == [[0, 1, 2]]


def test_a_sliver_is_kept(read: Read) -> None:
    made = read("v 0 0 0\nv 1 0 0\nv 0.5 1e-12 0\nf 1 2 3\n")
    assert made.flat_normals.tolist() == [[0, 0, 1]]


def test_the_normals_of_a_file_say_where_outside_is(read: Read) -> None:
    made = read(SQUARE + "vn 0 0 -1\nf 1//1 2//1 3//1\nf 3//1 2//1 1//1\n")
    assert made.flat_normals.tolist() == [[0, 0, -1], [0, 0, -1]]


def test_blocks_are_one_file(monkeypatch: pytest.MonkeyPatch, read: Read) -> None:
    lines = [f"v {i} {i * i} 0\nf -1 -2 -3\n" if i > 1 else f"v {i} {i * i} 0\n" for i in range(50)]
    whole = read("".join(lines))
    assert len(whole) == 48
    monkeypatch.setattr(obj, "BLOCK_BYTES", 40)
    assert np.array_equal(read("".join(lines)).corners, whole.corners)


def test_a_line_that_goes_on_is_not_cut_by_a_block(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj, "BLOCK_BYTES", 1)
    assert len(careful_only(SQUARE + "f 1 \\\n2 \\\n3\n")) == 1


def test_both_ways_read_the_same() -> None:
    random = np.random.default_rng(1)
    for forms in ("{}", "{}/{}", "{}//{}", "{}/{}/{}"):
        lines = [
            f"{key} {x!r} {y!r} {z!r}" for key in ("v", "vt", "vn") for x, y, z in random.normal(size=(20, 3)).tolist()
        ]
        for _ in range(30):
            numbers = random.integers(1, 21, (random.integers(3, 7), 3)) * random.choice([-1, 1], (1, 3))
            lines.append("f " + " ".join(forms.format(*row) for row in numbers.tolist()))
        data = [line.encode() + b"\n" for line in lines]
        quick, slow = fast.read(data, Counts(3, 4, 5, 6)), diagnosing.read(data, Counts(3, 4, 5, 6))
        assert quick is not None
        assert all(np.array_equal(one, other) for one, other in zip(quick, slow, strict=True)), forms
        assert isinstance(slow, Block)
