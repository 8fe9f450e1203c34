"""Wrong lines and files are refused with one error; it is shown with line, column, message, text and a caret."""

from __future__ import annotations

import pytest

from minirt.errors import Problem, excerpt, quoted
from minirt.scene import dialects
from minirt.scene.lines import MAX_ERRORS, MAX_ERRORS_OF_LINE, line_from
from minirt.scene.registry import nearest_element
from tests.scene.bad_lines import BACKGROUNDS, BLANKS, COUNTS, IDENTIFIERS, LIGHTS, NUMBERS, RANGES, SHAPES, VECTORS
from tests.scene.examples import AMBIENT, CAMERA, CYLINDER, LIGHT, PLANE, SPHERE, problems, scene_with


@pytest.mark.parametrize(("line", "column", "message"), SHAPES + LIGHTS + BACKGROUNDS)
def test_a_wrong_attribute_light_or_background_has_one_error_with_this_message(
    line: str, column: int, message: str
) -> None:
    (problem,) = problems(scene_with(line))
    assert (problem.line, problem.column, problem.message) == (3, column, message)


@pytest.mark.parametrize(("line", "column", "message"), IDENTIFIERS + COUNTS + VECTORS + NUMBERS + RANGES + BLANKS)
def test_a_bad_line_has_one_error_at_its_place(line: str, column: int, message: str) -> None:
    (problem,) = problems(scene_with(line))
    assert message in problem.message
    assert (problem.file, problem.line, problem.column) == ("test.rt", 3, column)
    assert problem.text == line.removesuffix("\r")


TOLERATED = ("//", ", ", " ,", " 0,2 ", " 1,000 ")  # by a lenient reader, or reported differently


@pytest.mark.parametrize(
    ("line", "column", "message"), [case for case in NUMBERS if not any(each in case[0] for each in TOLERATED)]
)
def test_lenient_accepts_no_bad_number(line: str, column: int, message: str) -> None:
    (problem,) = problems(scene_with(line), lenient=True)
    assert (problem.line, problem.column) == (3, column)
    assert message in problem.message


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        (
            f"{AMBIENT}\n{SPHERE}\n",
            2,
            1,
            "no camera: a scene needs one line 'C x,y,z dx,dy,dz fov', such as 'C 0,0,",
        ),
        (f"{CAMERA}\n{SPHERE}\n# end\n", 3, 1, "no ambient light: a scene needs one line 'A brightness R,G,B'"),
        (f"{AMBIENT}\n{CAMERA}\n{AMBIENT}\n", 3, 1, "a second ambient light: the first is in line 1"),
        (f"{AMBIENT}\n{CAMERA}\n\n  {CAMERA}\n", 4, 3, "a second camera: the first is in line 2"),
        (f"{AMBIENT}\n{CAMERA}\n{LIGHT}\n{LIGHT}\n", 4, 1, "a second light: the first is in line 3"),
        (f"{AMBIENT} {CAMERA}\n{CAMERA}\n", 1, 19, "ambient light has no further field 'C' (one element a line)"),
        (f"{CAMERA}\nA 1.5 255,255,255\n", 2, 3, "ambient light brightness must be in [0, 1], got 1.5"),
        (f"{CAMERA}\nA 0.2\n", 2, 6, "ambient light colour is missing: expected 'A brightness R,G,B'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 181\n", 2, 15, "camera fov must be in [0, 180], got 181"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 tone:sRGB\n", 2, 23, "camera tone must be plain, srgb or filmic, got 'sRGB'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 lens:0\n", 2, 23, "camera lens must be > 0, got 0"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:5 roll:5\n", 2, 25, "camera has 'roll' twice"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:\n", 2, 23, "camera roll must be a number, got ''"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 Roll:5\n", 2, 18, "unknown attribute 'Roll', did you mean 'roll'?"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:5 6\n", 2, 25, "only attributes 'name:value' follow an attribute"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 roll:5 70\n", 2, 14, "camera fov is missing"),
        (f"\ufeff{AMBIENT}x\n{CAMERA}\n", 1, 15, "ambient light colour B must be a whole number, got '255x'"),
    ],
)
def test_a_bad_file_has_one_error_at_its_place(text: str, line: int, column: int, message: str) -> None:
    (problem,) = problems(text)
    assert message in problem.message
    assert (problem.line, problem.column) == (line, column)


def test_an_element_split_over_two_lines_is_an_error_in_both() -> None:
    first, second = problems(scene_with("cy 0,0,20 0,1,0", "2 5 255,200,0"))
    assert (first.line, first.column) == (3, 16)
    assert "cylinder diameter and height and colour are missing" in first.message
    assert (second.line, second.column) == (4, 1)
    assert "a line begins with one of" in second.message


def test_one_run_reports_all_errors_of_a_file_in_order() -> None:
    errors = problems("A 2 255,0,0\nC 0,0,0 0,0,2 200 rol:1\nsp 0,nan,20 -1 1,2,3,4\nspp\n\nL 0,0,0 0.5\nL 0,0,0 0.5\n")
    assert [(each.line, each.column) for each in errors] == [
        *((1, 3), (2, 13), (2, 15), (2, 19)),
        *((3, 6), (3, 13), (3, 22), (4, 1), (7, 1)),
    ]


def test_a_wrong_line_is_not_also_reported_as_missing() -> None:
    assert len(problems("a 0.2 1,2,3\nc 0,0,0 0,0,1 70\n")) == 2
    assert len(problems("A0.2 1,2,3\nC 0, 0, 0 0,0,1 70\n")) == 2


def test_reading_stops_after_1000_errors() -> None:
    errors = problems("x\n" * 100_000)
    assert len(errors) == 1001
    assert (errors[-1].line, errors[-1].column) == (1000, 2)
    assert errors[-1].message == "too many errors: the rest of the file is not read"


@pytest.mark.parametrize("line", [SPHERE, PLANE, CYLINDER, LIGHT], ids=["sp", "pl", "cy", "L"])
def test_no_field_but_the_colour_of_a_light_may_be_left_out_or_doubled(line: str) -> None:
    words = line.split()
    for index in range(1, len(words)):
        shorter, longer = words[:index] + words[index + 1 :], words[:index] + words[index : index + 1] + words[index:]
        if shorter != ["L", "-40,0,30", "0.7"]:
            assert problems(scene_with(" ".join(shorter)))[0].line == 3
        assert problems(scene_with(" ".join(longer)))[0].line == 3


def test_a_line_has_at_most_20_errors() -> None:
    found = problems(scene_with(f"{SPHERE}{' mirror:0.5' * 90}"))
    assert [each.line for each in found] == [3] * MAX_ERRORS_OF_LINE
    assert found[-1].message == "too many errors in this line: further ones are left out"
    assert {each.line for each in problems(scene_with("sp x", "sp y"))} == {3, 4}


@pytest.mark.parametrize("line", ["x x x", "sp 0,0,zz 1 2,3,4", "A 0.2 255,255,255 mat"])
def test_a_lenient_reader_gives_up_a_file_of_many_lines_without_meaning(
    line: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that names its sort of line in each of them is no scene: 256 KiB of them took half a minute."""
    read: list[int] = []
    original = dialects.read_line
    monkeypatch.setattr(dialects, "read_line", lambda line, *more: read.append(line.number) or original(line, *more))
    found = problems("\n".join([AMBIENT, CAMERA, *[line] * 5000]), lenient=True)
    assert found[-1].message == "too many errors: the rest of the file is not read"
    assert max(read) <= MAX_ERRORS + 3


@pytest.mark.parametrize(
    "text", ["sp (" + "1," * 2**17, f"{SPHERE} " + "x " * 2**17, "sp " + "x," * 2**17], ids=["frame", "words", "commas"]
)
def test_a_long_line_is_refused_in_a_time_in_proportion_to_its_length(text: str) -> None:
    """The frame of a dialect took hours, its words a minute."""
    for lenient in (False, True):
        assert {each.line for each in problems(scene_with(text), lenient=lenient)} == {3}
    assert dialects.translated(line_from(3, text), {}, None) is None or "," in text


def test_a_problem_is_shown_with_its_line_and_a_caret() -> None:
    (problem,) = problems(scene_with("sp 0,0,20 -3.5 10,0,255 # red"))
    assert str(problem).splitlines() == [
        "test.rt:3:11: sphere diameter must be > 0, got -3.5",
        "    sp 0,0,20 -3.5 10,0,255 # red",
        "              ^~~~",
    ]


def test_the_caret_stands_under_the_component_also_behind_tabs_and_a_byte_order_mark() -> None:
    (problem,) = problems("\ufeffA\t0.2\t1,2000,3\nC 0,0,0 0,0,1 70\n")
    _, line, caret = str(problem).splitlines()
    assert line == "    A 0.2 1,2000,3"
    assert line[caret.index("^") : len(caret)] == "2000"


@pytest.mark.parametrize("column", [1, 40, 51, 500, 950, 1000, 1001])
def test_the_excerpt_of_a_long_line_is_the_part_around_the_column(column: int) -> None:
    text = "".join(chr(ord("a") + index % 26) for index in range(1000))
    line, caret = excerpt(text, column, 300).split("\n")
    assert len(line) <= 104
    assert len(caret) <= 104
    assert (line + " ")[caret.index("^")] == (text + " ")[column - 1]


def test_quoted_text_is_short_and_printable() -> None:
    assert quoted("a") == "'a'"
    assert quoted("\x1b\n") == r"'\x1b\n'"
    assert quoted("x" * 1000) == "'" + "x" * 39 + "…'"


def test_a_problem_of_the_whole_file_names_no_line() -> None:
    assert str(Problem("a.rt", 0, 0, "", "is empty")) == "a.rt: is empty"


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("spp", "sp"),
        ("SP", "sp"),
        ("p1", "pl"),
        ("cyy", "cy"),
        ("Sphere", "sp"),
        ("planes", "pl"),
        ("qqq", ""),
        ("", ""),
    ],
)
def test_a_misspelled_identifier_or_a_name_suggests_an_element(word: str, meant: str) -> None:
    assert nearest_element(word) == meant
