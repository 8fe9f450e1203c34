"""The fast path reads plain lines, both readers agree on all lines, and a disagreement is found.

`conftest` lets both readers read every text of this folder.
"""

from __future__ import annotations

import gc
from contextlib import suppress
from math import inf
from typing import Any
from unittest.mock import patch

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from minirt.errors import SceneError
from minirt.fields import Direction, Field, Three
from minirt.fields.scalars import FARTHEST, LONGEST, NUMBER, Scalar
from minirt.kernel import plain_lines
from minirt.kernel.machine_code.library import LIBRARY
from minirt.scene import describe, fast, line_reader, parse
from minirt.scene.lines import Log, line_from
from minirt.scene.parser import read_lines
from tests.scene.conftest import exact, no_plain_lines, read_by_both
from tests.scene.examples import CYLINDER, PLANE, SPHERE, problems, scene_with
from tests.scene.strategies import ANY

MANY = fast.MANY_LINES  # of a file, so that the fast path reads it
COMPONENTS = [
    "0",
    "-0",
    "1",
    ".5",
    "5.",
    "-1e-3",
    "0.70710678",
    "1e400",
    "1e-400",
    "1e15",
    "1.1e15",
    "-2",
    "256",
    "nan",
]
COMPONENTS += ["255", "1_0", "+7", "--1", "", "e", "0x1", "٣", "1" * LONGEST, "1" * (LONGEST + 1), "0" * LONGEST + "1"]
COMPONENTS += ["0" * LONGEST]


@pytest.mark.parametrize(
    "line",
    [
        *(SPHERE, PLANE, CYLINDER, "l 0,0,0 0.5 1,2,3", "\tsp  0,0,20\t \t12.6 10,0,255 \t", SPHERE + "\r"),
        *(
            SPHERE + " # a ball",
            SPHERE + "#a , // é \t\r",
            "sp +1,-.5,1e3 1.e-2 007,-0,+255",
            "pl 0,0,0 0,0.9995,0 1,2,3",
        ),
        *(f"{SPHERE} mirror:0.25", f"{SPHERE} \tspecular:0.5,30\t mirror:0.1 \r", f"{SPHERE} glow:1# a: b \r"),
        *(f"{SPHERE} glass:1.5 tint:9,9,9,2 fresnel:1", "l 0,0,0 0.5 1,2,3 size:2", f"{SPHERE} # mirror:2"),
    ],
)
def test_the_fast_path_reads_plain_lines(line: str) -> None:
    (element,) = fast.read([line], MANY)
    log = Log("test.rt", lenient=False)
    diagnosed = line_reader.read_line(line_from(1, line), {}, log)
    assert element is not None
    assert diagnosed is not None
    assert exact(element) == exact(diagnosed)
    assert not log.errors + log.notices


@pytest.mark.parametrize("line", ["", "\r", " \t", "#", "\t#\r", f" # {SPHERE} // é\x85\v"])
def test_the_fast_path_reads_comments_and_blank_lines(line: str) -> None:
    log = Log("test.rt", lenient=False)
    assert (
        list(fast.read([SPHERE, line, SPHERE], MANY))[1] == line == line_reader.read_line(line_from(2, line), {}, log)
    )
    assert not log.errors + log.notices


def test_the_fast_path_reads_no_lines_with_line_feeds() -> None:
    assert fast.read([SPHERE, f"{SPHERE} #\n", SPHERE], MANY) == [None] * 3


COMPONENT = st.sampled_from(COMPONENTS)
WORD = st.one_of(COMPONENT, st.lists(COMPONENT, min_size=2, max_size=4).map(",".join))
TRIPLE = st.lists(COMPONENT, min_size=3, max_size=3).map(",".join)
LINES = st.lists(
    st.one_of(
        st.tuples(st.just("sp"), TRIPLE, COMPONENT, TRIPLE),
        st.tuples(st.just("pl"), TRIPLE, TRIPLE, TRIPLE),
        st.tuples(st.sampled_from(["sp", "pl", "cy", "l"]), st.lists(WORD, max_size=6)).map(lambda x: (x[0], *x[1])),
    ).map(" ".join),
    max_size=8,
)


@given(LINES, st.booleans())
@settings(max_examples=300, deadline=None)
def test_both_readers_agree_on_mixed_good_and_bad_fields(lines: list[str], lenient: bool) -> None:
    with suppress(SceneError):
        parse(scene_with(*lines), lenient=lenient)


WORDS = ["mirror:0.5", "mirror:0", "mirror:2", "mirror:", "mirror", "tint:1,2,3", "fresnel", "glass:1.5", "uv:2,2", "#"]
WORDS += [
    "mir:0.5",
    "specular:0.5,30,",
    ",9",
    "\r",
    "x:1",
    "roll:9",
    "texture:a.png",
    "pattern:wood,1,2,3,4",
    "//",
    "a#b",
]
WORDS += ["\x0b", "\xa0glow:1", "glow:1", "fresnel:1", "size:1", "checker:1,2,3,0.5", 'mirror:"0.5"', "mirror=0.5"]


START = st.sampled_from([SPHERE, PLANE, CYLINDER, "", "l 0,0,0 1 9,9,9"])
END = st.lists(st.tuples(st.sampled_from([" ", "\t", "  ", ""]), st.sampled_from(WORDS)).map("".join), max_size=4)


@given(st.lists(st.tuples(START, END), max_size=4), st.booleans())
@example([("", [" ", "mirror:0.5"])], False)
@example([(SPHERE, [" mirror:0.5", " #", " \r", " mirror:0.5"])], False)
@settings(max_examples=500, deadline=None)
def test_both_readers_agree_on_attributes(lines: list[tuple[str, list[str]]], lenient: bool) -> None:
    with suppress(SceneError):
        parse(scene_with(*("".join([start, *end]) for start, end in lines)), lenient=lenient)


@given(st.lists(st.one_of(ANY), max_size=30))
@settings(max_examples=100, deadline=None)
def test_the_description_of_an_element_is_plain(elements: list[Any]) -> None:
    """With attributes too, but for words without a value, and files, which somebody has to try."""
    lines = [describe(element) for element in elements]
    for line, read, each in zip(lines, fast.read(lines, MANY), elements, strict=True):
        is_plain = type(each) in fast.forms()[0]
        assert read == each if is_plain and ":" not in line else read in (None, is_plain and each)


TEXT = st.text("+-.0123456789eE", min_size=1) | st.floats().map(repr) | st.from_regex(NUMBER, fullmatch=True)
EDGES = ["1e5", "1.", "E", "-0", "9007199254740993", "1e23", "-0e99", "123456789012345678901", "1e-22", "5e-324"]


@given(st.lists(TEXT, max_size=9))
@example(EDGES)
def test_numbers_are_those_of_float(texts: list[str]) -> None:
    lines = [f"sp {text},0,0 1 1,2,3" for text in texts]
    for read in (fast.read([*lines, SPHERE], MANY), interpreted_read([*lines, SPHERE])):
        for text, element in zip(texts, read, strict=False):
            is_number = NUMBER.fullmatch(text) and abs(float(text)) <= FARTHEST
            assert (element and repr(element.centre[0])) == (repr(float(text) + 0.0) if is_number else None)


def interpreted_read(lines: list[str]) -> Any:
    """Read lines without compiled code."""
    with patch.object(LIBRARY, "get", lambda _: plain_lines.read_lines):
        return fast.read(lines, MANY)


@pytest.mark.parametrize(
    ("cls", "name", "wrong", "line"),
    [
        (Scalar, "fits", lambda _field, numbers: numbers[:, 0] < inf, "sp 0,0,0 -1 1,2,3"),
        (Scalar, "fits", lambda _field, numbers: numbers[:, 0] < inf, "sp 0,0,0 1 1,2,300"),
        (Three, "values", lambda _field, numbers: list(map(tuple, numbers.tolist())), "sp 0,0,0 1 1,2,3"),
        (Direction, "values", Three.values, "pl 0,0,0 0,0.9995,0 1,2,3"),
        (Direction, "fits", Three.fits, "pl 0,0,0 0,0.5,0 1,2,3"),
    ],
)
def test_a_disagreement_of_the_readers_is_found(cls: type[Field], name: str, wrong: Any, line: str) -> None:
    sources = scene_with(line).split("\n")
    read_by_both(sources, Log("test.rt", lenient=False))
    with patch.object(cls, name, wrong), pytest.raises(AssertionError):
        read_by_both(sources, Log("test.rt", lenient=False))


def test_plain_lines_skip_the_diagnosing_reader() -> None:
    lines = [f"sp {index},0,20 1 255,0,{index % 256}" for index in range(10_000)]
    lines[1000:2000] = [f"{line} mirror:0.{index}" for index, line in enumerate(lines[1000:2000])]
    lines[7000] = "sp 0,0,20 -1 1,2,3"
    sources = scene_with(*lines).split("\n")
    seen: list[int] = []

    def split_line(line: Any, log: Log) -> Any:
        seen.append(line.number)
        return original(line, log)

    original = line_reader.split_line
    with patch.object(line_reader, "split_line", split_line):
        read_lines(sources, Log("test.rt", lenient=False))
    assert seen == [1, 2, 7003]  # the last line is blank
    with patch.object(line_reader, "split_line", split_line), patch.object(fast, "read", no_plain_lines):
        seen.clear()
        read_lines(sources, Log("test.rt", lenient=False))
    assert len(seen) == 10_003


def test_garbage_collection_is_left_as_it_was() -> None:
    assert gc.isenabled()
    parse(scene_with())
    assert gc.isenabled()
    problems("nonsense")
    assert gc.isenabled()
    gc.disable()
    try:
        parse(scene_with())
        assert not gc.isenabled()
    finally:
        gc.enable()
