"""A file that is no scene is refused before its lines are read, and nothing hangs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from minirt.element import pattern
from minirt.errors import Problem, SceneError
from minirt.scene import files, load, loads, parse
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from tests.guards import must_end
from tests.scene.examples import AMBIENT, CAMERA, SPHERE, WHOLE, problems, scene_with


def refusal(path: Path | str) -> Problem:
    """Load a file; return its one problem."""
    with pytest.raises(SceneError) as caught:
        load(path)
    (problem,) = caught.value.problems
    assert problem.file == str(path)
    return problem


def test_a_scene_knows_its_file(tmp_path: Path) -> None:
    path = tmp_path / "a scene.rt"
    path.write_text(WHOLE)
    assert load(path).scene == parse(WHOLE, path).scene
    assert load(str(path)).scene.file == path
    assert parse(WHOLE).scene.file is None


def test_readers_are_strict_and_right_handed_by_default(tmp_path: Path) -> None:
    path, text = tmp_path / "scene.rt", scene_with("sp 0, 0,20 5 1,2,3")
    path.write_text(text)
    for read in (lambda: load(path), lambda: parse(text), lambda: loads(text)):
        with pytest.raises(SceneError, match="comma"):
            read()
    assert loads(text, lenient=True).spheres == load(path, lenient=True).scene.spheres
    assert not load(path, lenient=True).scene.camera.left_handed
    assert load(path, lenient=True, left_handed=True).scene.camera.left_handed


@pytest.mark.parametrize(
    "name", [".rt", "scene", "scene.RT", "scene.rt.txt", "scene.rtx", "scenert", "rt", "scene.rt "]
)
def test_the_name_must_end_in_rt(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_text(WHOLE)
    assert str(refusal(path)) == f"{path}: the name of a scene file ends in '.rt'"


@pytest.mark.parametrize("name", ["a.b.rt", "-.rt", "..rt", "größe 球.rt", "x" * 200 + ".rt"])
def test_any_name_that_ends_in_rt_is_read(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(WHOLE)
    assert load(tmp_path / name).scene.spheres


def test_a_folder_and_no_name_at_all_are_refused(tmp_path: Path) -> None:
    assert refusal(tmp_path).message == "is a folder"
    assert "ends in '.rt'" in refusal("").message


def test_a_file_of_64_mib_is_read(tmp_path: Path) -> None:
    path = tmp_path / "large.rt"
    with path.open("wb") as file:
        file.write(WHOLE.encode())
        file.truncate(64 * 2**20)
    problem = refusal(path)
    assert (problem.line, problem.column) == (WHOLE.count("\n") + 1, 1)
    assert problem.message == "must be text, got a NUL byte"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("\n", "holds only blanks and comments"),
        (" \t\r\n\n", "holds only blanks and comments"),
        ("# a comment\n# another", "holds only blanks and comments"),
        ("\ufeff", "holds only blanks and comments"),
    ],
)
def test_a_file_without_elements_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "empty.rt"
    path.write_text(text, newline="")
    problem = refusal(path)
    assert problem.message == message
    assert str(problem) == f"{path}: {message}"


@pytest.mark.parametrize(
    ("data", "line", "column", "message"),
    [
        (b"A 0.2 1,2,3\n\0", 2, 1, "must be text, got a NUL byte"),
        (b"# a\0comment", 1, 4, "must be text, got a NUL byte"),
        (b"A 0.2 1,2,3\n# caf\xe9\n", 2, 6, "must be UTF-8, got the byte 0xe9"),
        ("# é\n# éé".encode() + b"\xff\n", 2, 5, "must be UTF-8, got the byte 0xff"),
        (b"\xef\xbb\xbf# \x80", 1, 3, "must be UTF-8, got the byte 0x80"),
        (b"A \xc0\xb0.2 1,2,3", 1, 3, "must be UTF-8, got the byte 0xc0"),  # an overlong 0
        (b"# \xed\xa0\x80", 1, 3, "must be UTF-8, got the byte 0xed"),  # a surrogate
        (b"# \xe2\x82", 1, 3, "must be UTF-8, got the byte 0xe2"),  # cut off
        (WHOLE.encode("utf-16"), 1, 1, "must be UTF-8, got UTF-16"),
        (WHOLE.encode("utf-16-le"), 1, 2, "must be text, got a NUL byte"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 3, 1, "must be text, got a NUL byte"),
        (b"\x7fELF\x02\x01\x01\0\0", 1, 8, "must be text, got a NUL byte"),
        (b"\xff\xd8\xff\xe0JFIF", 1, 1, "must be UTF-8, got the byte 0xff"),
    ],
)
def test_a_file_that_is_not_utf8_text_is_refused_at_its_first_wrong_byte(
    data: bytes, line: int, column: int, message: str
) -> None:
    (problem,) = problems(data)
    assert (problem.line, problem.column, problem.message) == (line, column, message)


def test_a_byte_order_mark_is_no_part_of_the_line_that_is_quoted() -> None:
    (problem,) = problems(b"\xef\xbb\xbf# a\x80")
    assert (problem.text, problem.column) == ("# a\ufffd", 4)


def test_a_lone_surrogate_is_not_text() -> None:
    (problem,) = problems("# é\ud800\n")
    assert (problem.line, problem.column) == (1, 4)


@pytest.mark.parametrize(
    ("line", "column", "message"),
    [
        ("sp 0,0,20 " + "9" * 2**20 + " 1,2,3", 11, "sphere diameter must be a number, got 1048576 characters: '999"),
        ("sp 0,0,20 5 1" + "," * 2**20, 17, "sphere colour must be R,G,B"),
        ("sp 0,0,20 5 1,2,3" + " 1" * 2**19, 19, "sphere has no further field '1'"),
        ("sp 0,0,20 " + "x" * 2**20 + ":5 5", 10, "sphere diameter and colour are missing"),
        ("sp 0,0,20 5 1,2,3 " + "x" * 2**20 + ":5", 19, "unknown attribute 'xxx"),
        ("sp 0,0,20 5" + " " * 2**20 + "1,2,x", 2**20 + 16, "sphere colour B must be a whole number, got 'x'"),
        ("/" * 2**20, 1, "a comment begins with '#'"),
        ("sp 0,0,20 5 1,2,3" + "\v" * 2**20, 18, "got U+000B"),
    ],
    ids=range(8),
)
def test_a_line_of_a_megabyte_is_refused_with_a_short_message(line: str, column: int, message: str) -> None:
    with must_end():
        problem, *_ = problems(scene_with(line))
    assert (problem.line, problem.column) == (3, column)
    assert message in problem.message
    assert len(str(problem)) < 600


@pytest.mark.parametrize("line", ["", "#", "\r", SPHERE])
def test_a_file_of_too_many_lines_is_refused_before_its_lines_are_read(line: str) -> None:
    text = WHOLE + f"{line}\n" * (files.MAX_LINES + 1 - WHOLE.count("\n"))
    with pytest.raises(SceneError, match=r"has 4,194,305 lines, more than 4,194,304$"):
        files.decode(text.encode(), "scene.rt")


def test_a_file_of_as_many_lines_as_allowed_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "MAX_LINES", 200)
    text = WHOLE + "#\n" * (200 - WHOLE.count("\n"))
    assert len(parse(text).scene.items) == 201
    with pytest.raises(SceneError, match="201 lines"):
        parse(text + "\n")


@pytest.mark.parametrize("kind", [kind for kind in ELEMENTS.values() if issubclass(kind, Shape)])
def test_a_file_of_shapes_has_fewer_lines_than_allowed(kind: type[Shape]) -> None:
    values = pattern(kind).split(" [")[0].removeprefix(kind.code)
    shortest = kind.code + re.sub("[A-Za-z]+", "1", values) + "\n"
    assert len(shortest) > files.MAX_BYTES / files.MAX_LINES


def test_messages_cannot_act_on_a_terminal() -> None:
    text = f"{AMBIENT}\n{CAMERA}\nsp 0,0,20 \x1b[2J\x07 5\n\x1b]0;title\x07 {SPHERE}\n"
    with pytest.raises(SceneError) as caught:
        parse(text, "evil\x1b[31m\n.rt")
    assert all(line.isprintable() for line in str(caught.value).split("\n"))
    assert str(caught.value).startswith("evil [31m .rt:3:11: ")
