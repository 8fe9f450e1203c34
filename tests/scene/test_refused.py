"""Wrong lines and files are refused with one error, whose line, column and message are given."""

from __future__ import annotations

import pytest

from tests.scene.bad_lines import BLANKS, COUNTS, IDENTIFIERS, NUMBERS, RANGES, VECTORS
from tests.scene.examples import (
    AMBIENT,
    CAMERA,
    CYLINDER,
    LIGHT,
    PLANE,
    SPHERE,
    problems,
    scene_with,
)


@pytest.mark.parametrize(("line", "column", "message"), IDENTIFIERS + COUNTS + VECTORS + NUMBERS + RANGES + BLANKS)
def test_a_bad_line_has_one_error_at_its_place(line: str, column: int, message: str) -> None:
    (problem,) = problems(scene_with(line))
    assert message in problem.message
    assert (problem.file, problem.line, problem.column) == ("test.rt", 3, column)
    assert problem.text == line.removesuffix("\r")


TOLERATED = ("//", ", ", " ,")  # by a lenient reader, or reported differently


@pytest.mark.parametrize(
    ("line", "column", "message"),
    [case for case in IDENTIFIERS + COUNTS + NUMBERS if not any(each in case[0] for each in TOLERATED)],
)
def test_lenient_accepts_no_bad_number_identifier_or_count(line: str, column: int, message: str) -> None:
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
            "no camera: a scene needs one line 'C x,y,z dx,dy,dz fov [roll:degree] [tone:word] [exposure:EV] "
            "[lens:diameter] [focus:distance]'",
        ),
        (f"{AMBIENT}\n{SPHERE}", 2, 1, "no camera"),
        (f"{CAMERA}\n{SPHERE}\n# end\n", 3, 1, "no ambient light: a scene needs one line 'A brightness R,G,B'"),
        (f"{AMBIENT}\n{CAMERA}\n{AMBIENT}\n", 3, 1, "a second ambient light: the first is in line 1"),
        (f"{AMBIENT}\n{CAMERA}\n\n  {CAMERA}\n", 4, 3, "a second camera: the first is in line 2"),
        (f"{AMBIENT}\n{CAMERA}\n{LIGHT}\n{LIGHT}\n", 4, 1, "a second light: the first is in line 3"),
        (f"{AMBIENT}\n{CAMERA}\nR 640 480\nR 640 480\n", 4, 1, "a second resolution: the first is in line 3"),
        (f"{AMBIENT} {CAMERA}\n{CAMERA}\n", 1, 19, "ambient light has no further field 'C' (one element a line)"),
        (f"{CAMERA}\nA 1.5 255,255,255\n", 2, 3, "ambient light brightness must be in [0, 1], got 1.5"),
        (f"{CAMERA}\nA 0.2 255,255\n", 2, 7, "ambient light colour must be R,G,B"),
        (f"{CAMERA}\nA 0.2\n", 2, 6, "ambient light colour is missing: expected 'A brightness R,G,B'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 181\n", 2, 15, "camera fov must be in [0, 180], got 181"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 -1\n", 2, 15, "camera fov must be in [0, 180], got -1"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 tone:sRGB\n", 2, 23, "camera tone must be plain, srgb or filmic, got 'sRGB'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 exposure:21\n", 2, 27, "camera exposure must be in [-20, 20], got 21"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 lens:0\n", 2, 23, "camera lens must be > 0, got 0"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 lens:x\n", 2, 23, "camera lens must be a number, got 'x'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 lens:1 focus:-5\n", 2, 31, "camera focus must be > 0, got -5"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1\n", 2, 14, "camera fov is missing"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:5 roll:5\n", 2, 25, "camera has 'roll' twice"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:400\n", 2, 23, "camera roll must be in [-360, 360], got 400"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:\n", 2, 23, "camera roll must be a number, got ''"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 Roll:5\n", 2, 18, "unknown attribute 'Roll', did you mean 'roll'?"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll\n", 2, 18, "camera has no further field 'roll'"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:5 6\n", 2, 25, "only attributes 'name:value' follow an attribute"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 roll:5 70\n", 2, 14, "camera fov is missing"),
        (f"{AMBIENT}\nC 0,0,0 0,0,1 70 5\n", 2, 18, "camera has no further field '5'"),
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
    assert (errors[-1].line, errors[-1].column) == (1000, 1)
    assert errors[-1].message == "too many errors: the rest of the file is not read"


@pytest.mark.parametrize("line", [SPHERE, PLANE, CYLINDER, LIGHT], ids=["sp", "pl", "cy", "L"])
def test_no_field_but_the_colour_of_a_light_may_be_left_out_or_doubled(line: str) -> None:
    words = line.split()
    for index in range(1, len(words)):
        shorter, longer = words[:index] + words[index + 1 :], words[:index] + words[index : index + 1] + words[index:]
        if shorter != ["L", "-40,0,30", "0.7"]:
            assert problems(scene_with(" ".join(shorter)))[0].line == 3
        assert problems(scene_with(" ".join(longer)))[0].line == 3
