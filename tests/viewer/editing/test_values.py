"""Edited numbers are short, and numbers that were not edited keep their digits."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.scene import describe, dump, load
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import index_of, initial_state
from minirt.viewer.editing.values import leading_decimal, nice_number
from tests.paths import ROOT
from tests.viewer.fake import TEXT, played, scene

WILD = "# by hand\nA 0.2 255,255,255\n\tC  0.123456789012345,0,10   0,0,-1 90  # eye\nL 5,5,5 0.5\n\n" + "\n".join(
    f"sp   {i}.000,{i / 3!r},-{i}e0 1.50\t{i},0,0   spc:.50,3e1   mir:0.250\t # no. {i}" for i in range(20)
)
FILES = sorted((*ROOT.glob("scenes/*.rt"), *ROOT.glob("tests/scene/wild/*.rt")))
WILDS = (WILD, WILD.replace("\n", "\r\n"), f"\ufeff{WILD}\n\n\n")


@given(st.floats(1e-11, 1e17))
def test_a_nice_number_is_round_and_at_most_2_5_times_smaller(length):
    nice = nice_number(length)
    assert nice <= length * (1 + 1e-8)
    assert length < nice * 2.5 * (1 + 1e-8)
    assert f"{nice:.0e}" in (f"{digit}e{-leading_decimal(nice):+03d}" for digit in (1, 2, 5))


@pytest.mark.parametrize("action", ["right", "up", "forward", "grow", "turn left"])
def test_steps_there_and_back_return_to_the_start(action):
    back = {"right": "left", "up": "down", "forward": "back", "grow": "shrink", "turn left": "turn right"}[action]
    state = initial_state(scene())
    for start in (state, apply(state, "select next"), apply(apply(state, "select next"), "select next")):
        there = start
        for _ in range(7):
            there = apply(there, action)
        for _ in range(7):
            there = apply(there, back)
        if action == "turn left":
            assert there.element == start.element or describe(there.element) != describe(start.element)
        else:
            assert describe(there.element) == describe(start.element)


def test_edited_numbers_have_at_most_nine_digits():
    actions = ["right", "up", "forward", "grow", "grow", "shrink", "next value", "grow", "next value", "grow"]
    for first in range(6):
        state = initial_state(scene())
        for _ in range(first):
            state = apply(state, "select next")
        for amount in (1.0, 0.1, 0.1333333):
            for action in actions:
                state = apply(state, action, amount)
        for number in re.findall(r"[-.0-9]+", describe(state.element)):
            assert len(number.strip("-").replace(".", "").strip("0")) <= 9, describe(state.element)


@pytest.mark.parametrize("wild", WILDS, ids=["LF", "CRLF", "BOM"])
@pytest.mark.parametrize("drag", ["press d", "hold e 0.31", "wheel up 3", "drag 32,30 40,20", "press V"])
def test_saving_after_an_edit_of_one_element_changes_one_line(tmp_path, drag, wild):
    path = tmp_path / "wild.rt"
    path.write_bytes(wild.encode())
    session = played("press Tab", "press Tab", "press Tab", drag, "press Ctrl+S", text=wild, path=path)
    old, new = wild.split("\n"), path.read_bytes().decode().split("\n")
    different = [(a, b) for a, b in zip(old, new, strict=True) if a != b]
    assert len(different) == (drag != "press V")
    for before, after in different:
        assert before.partition("spc:")[1:] == after.partition("spc:")[1:]  # attributes, comment, carriage return
    assert dump(session.state.scene).encode() == path.read_bytes()


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_moving_a_shape_of_any_scene_changes_one_line(path):
    scene = load(path, lenient=True).scene
    old = path.read_bytes().decode().split("\n")
    for shape in scene.shapes[:: max(1, len(scene.shapes) // 20)]:
        state = apply(initial_state(scene).select(index_of(scene, shape)), "right")
        new = dump(state.scene).split("\n")
        assert sum(a != b for a, b in zip(old, new, strict=True)) == 1


def test_editing_an_attribute_changes_one_word_of_its_line(tmp_path):
    path = tmp_path / "wild.rt"
    path.write_bytes(WILDS[1].encode())
    keys = ["press Tab", "press Tab", "press Tab", *["press V"] * 2, "press +", "press M", "press Shift+M"]
    played(*keys, "press Ctrl+S", text=WILDS[1], path=path)
    old, new = WILDS[1].split("\n"), path.read_bytes().decode().split("\n")
    ((before, after),) = ((a, b) for a, b in zip(old, new, strict=True) if a != b)
    assert before.replace("spc:.50,3e1", "spc:0.55,30") == after


def test_unchanged_coordinates_keep_all_their_digits():
    text = TEXT.replace("sp 0,0,0 2", "sp 0.1234567890123,0.98765432109876,0 2.0000000001")
    state = apply(apply(initial_state(scene(text)), "select next"), "select next")
    while state.frame.name != "X":
        state = apply(state, "next frame")
    x, y, z = apply(state, "right").element.centre
    assert (y, z) == (0.98765432109876, 0)
    assert len(str(x)) < 12
    assert apply(state, "right").element.diameter == 2.0000000001
