"""Messages show the file, line, column, text and a caret of a problem."""

from __future__ import annotations

import pytest

from minirt.errors import Problem, excerpt, quoted
from minirt.scene.registry import nearest_element, nearest_word
from tests.scene.examples import problems, scene_with


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


def test_no_known_words_give_no_suggestion() -> None:
    assert nearest_word("roll", []) == ""
