"""Broken .obj files are refused with a message that names the line."""

from __future__ import annotations

import pytest

from minirt.meshes import obj, polygons
from minirt.meshes.obj_lines import ObjError

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n"

MISSING = "a point that is not there: there are 4"
BROKEN = {
    "": "has no faces",
    "\n# nothing\n": "has no faces",
    SQUARE: "has no faces",
    SQUARE + "f 1 1 2\n": "has no triangle that is more than a line",
    "v 0 0 0\nv 1e-310 0 0\nv 0 1e-99 0\nf 1 2 3\n": "has no triangle that is more than a line, or larger than 1e-75",
    SQUARE + "f 1 2\n": "line 6: a face has at least 3 corners, got 2",
    SQUARE + "f\n": "line 6: a face has at least 3 corners, got 0",
    SQUARE + "f 1 2 0\n": f"line 6, column 7: a corner names {MISSING}",
    SQUARE + "f 1 2 5\n": f"line 6, column 7: a corner names {MISSING}",
    SQUARE + "\n\nf 1 2 3\nf 1 2 -5\n": f"line 9, column 7: a corner names {MISSING}",
    "v 0 0 0\nf 1 2 3\n": "line 2, column 5: a corner names a point that is not there: there is 1",
    SQUARE + "f 1 2 3 4\nf 1 \\\n 2 9\n": f"line 7, column 9: a corner names {MISSING}",
    SQUARE + f"f 1 2 {10**30}\n": f"line 6, column 7: a corner names {MISSING}",
    SQUARE + "f /1 /2 /3\n": "line 6, column 3: a corner is v, v/vt, v//vn or v/vt/vn",
    SQUARE + "f 1/1/1/1 2 3\n": "line 6, column 3: a corner is v, v/vt, v//vn or v/vt/vn",
    SQUARE + "f 1 2 x\n": "line 6, column 7: the point of a corner must be a whole number",
    SQUARE + "f 1 2 3.0\n": "line 6, column 7: the point of a corner must be a whole number",
    SQUARE + "f 1/x 2 3\n": "line 6, column 3: the vt of a corner must be a whole number",
    SQUARE + "f 1//1_0 2 3\n": "line 6, column 3: the vn of a corner must be a whole number",
    SQUARE + "f 1 2 1_0\n": "line 6, column 7: the point of a corner must be a whole number",
    "v 0 0\n": "line 1: v has x y z, got 2 numbers",
    "v 0 0 0 1 1 1 1 1\n": "line 1: v has x y z, got 8 numbers",
    "v 0 0 nan\nf 1 1 1\n": "line 1, column 7: v must be a number",
    "v 0 0 0\nv 1 inf 0\nf 1 1 2\n": "line 2, column 5: v must be a number",
    "v 1e400 0 0\n": "line 1, column 3: v must be a number that a float64 can hold",
    "v 0 -2e15 0\n": "line 1, column 5: v must be in [-1e+15, 1e+15]",
    "v 0 1_0 0\n": "line 1, column 5: v must be a number",
    "v 0 0 0x1\n": "line 1, column 7: v must be a number",
    "v 0,0,0\n": "line 1: v has x y z, got 1 number",
    "vt\n": "line 1: vt has u v, got 0 numbers",
    "vn 0 1\n": "line 1: vn has x y z, got 2 numbers",
    "v 0 0 0\nsp 0,0,0 1 255,0,0\n": "has no faces",
    "V 0 0 0\n": "has no faces",
    "curv 0 1 2\n": "has no faces",
    "\x89PNG\n": "has no faces",
    "v 0 0 \\\n0 \\\n# x\nv 1 2\n": "line 4: v has x y z, got 2 numbers",
}


@pytest.mark.parametrize(("text", "message"), BROKEN.items(), ids=range(len(BROKEN)))
def test_a_broken_file_is_refused(text: str, message: str) -> None:
    with pytest.raises(ObjError) as caught:
        obj.parse(text.encode())
    assert str(caught.value) == message


NOT_FINITE = ("has points that no face names with a coordinate that is no number: they are skipped",)
WORDS = "nan", "NaN", "-nan", "inf", "-Infinity", "\\\n+INF"


@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("place", range(3))
def test_a_point_that_is_no_number_counts_only_if_a_face_names_it(
    monkeypatch: pytest.MonkeyPatch, word: str, place: int
) -> None:
    monkeypatch.setattr(obj, "BLOCK_BYTES", 20)
    coordinates = ["0", "1e3", "2"]
    coordinates[place] = word
    line = f"v {' '.join(coordinates)}\n"
    for before, after in ((SQUARE, ""), ("", SQUARE)):
        first = 2 if after else 1
        text = f"{before}{line}{after}f {first} {first + 1} {first + 2}\n"
        mesh = obj.parse(text.encode())
        assert (mesh.points.tolist(), mesh.notices) == ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], NOT_FINITE)
        number = 1 if after else 6
        with pytest.raises(ObjError, match=rf"^line {number}, column [0-9]+: v must be a number$"):
            obj.parse((text + f"f 2 3 {1 if after else 5}\n").encode())


@pytest.mark.parametrize("line", ["v 0 0 0 nan 0 0", "vt nan 0", "vn 0 0 inf", "v nano 0 0", "v nan_ 0 0", "v -x 0 0"])
def test_other_words_are_no_numbers(line: str) -> None:
    with pytest.raises(ObjError, match=r"^line 6, column [0-9]+: vt? must be a number$|: vn must be a number$"):
        obj.parse((SQUARE + line + "\nf 1 2 3\n").encode())


@pytest.mark.parametrize("code", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_text_in_utf16_is_named(code: str) -> None:
    with pytest.raises(ObjError, match=r"^is UTF-16: save it as UTF-8$"):
        obj.parse((SQUARE + "f 1 2 3\n").encode(code))
    assert len(obj.parse((SQUARE + "f 1 2 3\n").encode("utf-8-sig"))) == 1


def test_binary_data_is_refused() -> None:
    with pytest.raises(ObjError, match=r"^has no faces$"):
        obj.parse(bytes(range(256)))


def test_a_file_with_too_many_triangles_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj, "MAX_TRIANGLES", 3)
    assert len(obj.parse((SQUARE + "f 1 2 3 4 -4\n").encode())) == 2  # one of three is degenerate
    with pytest.raises(ObjError, match=r"^has more than 3 triangles$"):
        obj.parse((SQUARE + 4 * "f 1 2 3\n").encode())


@pytest.mark.parametrize(
    ("text", "line"),
    [("f 1 2 3 1 2 3 1 2 3 1\n", 6), ("f 1 2 3 \\\n1 2 \\\n3 1 2 3 1 2 \\\n3\n", 8), ("f" + " \\\n" * 99, 12)],
)
def test_a_long_line_is_refused_before_all_of_it_is_read(monkeypatch: pytest.MonkeyPatch, text: str, line: int) -> None:
    monkeypatch.setattr(obj, "BLOCK_BYTES", 1)
    monkeypatch.setattr(obj, "LONGEST_LINE", 20)
    with pytest.raises(ObjError, match=rf"^line {line}: longer than 0 MiB$"):
        obj.parse((SQUARE + text).encode())
    monkeypatch.setattr(obj, "LONGEST_LINE", 30)
    assert len(obj.parse((SQUARE + "f 1 2 3 1 2 3 1 2 3 1\n").encode())) > 0


def test_a_face_that_takes_too_long_to_cut_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    comb = "".join(f"v {x} {y} 0\n" for x in range(50) for y in (x % 2, 9))  # its corners are not in order
    text = (comb + "f 1 2 3\nf " + " ".join(map(str, range(1, 101))) + "\n").encode()
    whole = len(obj.parse(text))
    assert whole > 50
    monkeypatch.setattr(polygons, "MOST_LOOKS", 100)
    with pytest.raises(ObjError, match=r"^line 102: a face of 100 corners takes too long to cut into triangles$"):
        obj.parse(text)


def test_a_file_of_too_many_lines_is_refused_before_they_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj, "MAX_LINES", 100)
    triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    assert len(obj.parse((triangle + "#\n" * 96).encode()).corners) == 1
    monkeypatch.setattr(obj, "end_of_block", None)
    with pytest.raises(ObjError, match=r"^has 101 lines, more than 100$"):
        obj.parse((triangle + "#\n" * 97).encode())


def test_a_number_that_is_too_long_is_refused_whatever_its_value() -> None:
    number = b"0." + b"1" * 300
    with pytest.raises(ObjError, match=r"^line 5, column 7: v must be a number$"):
        obj.parse(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 0 0 " + number + b"\n")
