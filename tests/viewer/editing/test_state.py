"""Undo, redo, the merging of changes, and the spelling of edited numbers."""

from __future__ import annotations

import re
from dataclasses import replace
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.scene import Scene, describe, dump, parse
from minirt.scene.pages import PAGE_LENGTH
from minirt.shapes.sphere import Sphere
from minirt.viewer.display.overlay import element_line
from minirt.viewer.editing import state as state_module
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import SAMPLE_SIZE, scene_size
from minirt.viewer.editing.state import MAX_UNDO, Snapshot, State, initial_state, stack_after_reading
from minirt.viewer.editing.values import leading_decimal, nice_number
from tests.viewer.fake import played, scene

HEAD = "A 0 0,0,0\nC 0,0,0 0,0,1 60\nL 0,0,0 1\n"
EDITS = ("right", "turn left", "grow", "undo", "redo", "duplicate", "delete", "look at", "reset camera", "undo", "undo")
PAUSES = {"moment": 0.4, "pause": 0.6}  # seconds
CHOICES = ("select next", "select previous", "select camera", "select light", "next value", "next frame")


@pytest.mark.parametrize(
    ("actions", "fov", "moves", "message"),
    [
        ("grow, moment, grow, moment, grow, moment, grow, undo", 90, False, ""),
        ("grow, moment, grow, moment, grow, moment, grow, undo, redo", 98, False, ""),
        ("grow, pause, grow, undo", 92, False, ""),
        ("grow, right, grow, turn left, undo, undo, undo", 92, False, ""),
        ("grow, right, grow, turn left, undo, undo, undo, undo", 90, False, ""),
        ("grow, select next, select camera, grow, undo", 92, False, ""),
        ("grow, next value, next value, next value, next value, grow, undo", 92, False, ""),
        ("grow, right, undo, undo, redo, redo, redo", 92, True, "nothing to redo"),
        ("grow, undo, right, redo", 90, True, "nothing to redo"),
        ("undo", 90, False, "nothing to undo"),
    ],
)
def test_undo_and_redo_go_through_the_changes_of_which_quick_ones_of_one_kind_are_one(actions, fov, moves, message):
    state, now = initial_state(scene()), 0.0
    for action in actions.split(", "):
        if action in PAUSES:
            now += PAUSES[action]
        else:
            state = apply(state, action, now=now)
    camera = state.scene.camera
    assert (camera.fov, camera.position != scene().camera.position, state.message) == (fov, moves, message)


def test_undo_selects_the_changed_element():
    state = initial_state(scene())
    while state.element.title != "sphere":
        state = apply(state, "select next")
    state = apply(apply(apply(state, "grow"), "select camera"), "undo")
    assert (state.element.title, state.element.diameter) == ("sphere", 2)


@pytest.mark.parametrize(("limit", "expected"), [(99, 10), (90, 10), (89, 9), (18, 2), (17, 1), (1, 1)])
def test_scenes_of_files_that_were_read_are_kept_up_to_a_number_of_items(limit, expected, monkeypatch):
    monkeypatch.setattr(state_module, "MAX_ITEMS", limit)
    scenes = [scene() for _ in range(10)]
    assert {len(each.items) for each in scenes} == {9}
    state = initial_state(scenes[0])
    for newer in scenes[1:]:
        stack = stack_after_reading(state)
        state = replace(initial_state(newer), undo_stack=stack)
    kept = stack_after_reading(state)
    assert len(kept) == expected
    assert [each.scene for each in kept] == scenes[-expected:]


def test_edits_share_items_and_are_all_kept(monkeypatch):
    monkeypatch.setattr(state_module, "MAX_ITEMS", 9)
    shown = scene()
    state = replace(initial_state(shown), undo_stack=(Snapshot(shown, 0),) * (MAX_UNDO + 5))
    assert len(stack_after_reading(state)) == MAX_UNDO


# Scenes with many elements: no action visits all of them, and undo keeps no copies of them.


@pytest.fixture(scope="module")
def many() -> Scene:
    """A scene of many pages."""
    spheres = "\n".join(f"sp 0,0,{1 + index % 100} 0.5 1,2,3" for index in range(30 * PAGE_LENGTH))
    return parse(HEAD + spheres + "\nl 0,0,0 1\n").scene


@pytest.mark.parametrize("action", [*EDITS, *CHOICES])
@pytest.mark.parametrize("selected", ["select camera", "select next"])
def test_an_action_reads_few_elements(many: Scene, action: str, selected: str) -> None:
    visited: set[int] = set()

    def visit(sphere: Sphere, name: str) -> object:
        visited.add(id(sphere))
        return object.__getattribute__(sphere, name)

    state = apply(apply(initial_state(many), selected), "right")
    with patch.object(Sphere, "__getattribute__", visit):
        element_line(apply(state, action))
        assert len(visited) <= 2 * PAGE_LENGTH


def test_undo_shares_all_but_a_page_of_each_scene(many: Scene) -> None:
    state = apply(apply(initial_state(many), "select next"), "select next")
    assert state.element is many.spheres[0]
    for step in range(21):
        state.scene.shapes  # noqa: B018 - the renderer reads them, which caches them in the scene
        state = apply(state, ("right", "grow", "duplicate")[step % 3], now=float(step))
    pages = {id(page) for snapshot in state.undo_stack for page in snapshot.scene.pages}
    assert len(state.undo_stack) == 21
    assert len(pages) <= len(many.pages) + len(state.undo_stack)
    assert not any("shapes" in vars(snapshot.scene) for snapshot in state.undo_stack)


def test_the_size_of_a_scene_is_estimated_from_a_sample(many: Scene) -> None:
    measured: list[Sphere] = []

    def bounds(sphere: Sphere) -> object:
        measured.append(sphere)
        return original(sphere)

    original = Sphere.bounds
    with patch.object(Sphere, "bounds", bounds):
        size = scene_size(many)
    assert SAMPLE_SIZE / 2 < len({id(sphere) for sphere in measured}) <= SAMPLE_SIZE
    assert size == pytest.approx(50, rel=0.05)


def test_the_last_of_many_elements_is_selected(many: Scene) -> None:
    state: State = apply(initial_state(many), "select previous")
    state = apply(apply(apply(state, "select camera"), "select light"), "select light")
    assert state.element is many.elements[-1]
    assert apply(state, "select light").element is many.lights[0]
    assert apply(state, "select previous").element is many.shapes[-1]


# Edited numbers are short, and numbers that were not edited keep their digits.

WILD = "# by hand\nA 0.2 255,255,255\n\tC  0.123456789012345,0,10   0,0,-1 90  # eye\nL 5,5,5 0.5\n\n" + "\n".join(
    f"sp   {i}.000,{i / 3!r},-{i}e0 1.50\t{i},0,0   spc:.50,3e1   mir:0.250\t # no. {i}" for i in range(20)
)
WILDS = (WILD, WILD.replace("\n", "\r\n"), f"\ufeff{WILD}\n\n\n")  # LF, CRLF, with a byte order mark


@given(st.floats(1e-11, 1e17))
def test_a_nice_number_is_round_and_at_most_2_5_times_smaller(length):
    nice = nice_number(length)
    assert nice <= length * (1 + 1e-8)
    assert length < nice * 2.5 * (1 + 1e-8)
    assert f"{nice:.0e}" in (f"{digit}e{-leading_decimal(nice):+03d}" for digit in (1, 2, 5))


@pytest.mark.parametrize("action", ["right", "up", "forward", "grow"])
def test_steps_there_and_back_return_to_the_start(action):
    back = {"right": "left", "up": "down", "forward": "back", "grow": "shrink"}[action]
    state = initial_state(scene())
    for start in (state, apply(state, "select next"), apply(apply(state, "select next"), "select next")):
        there = start
        for _ in range(7):
            there = apply(there, action)
        for _ in range(7):
            there = apply(there, back)
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


@pytest.mark.parametrize(
    ("drag", "number"), [("press d", 0), ("hold e 0.31", 1), ("press +", 2), ("drag 32,30 40,20", 1), ("press V", 0)]
)
def test_saving_after_an_edit_of_one_element_changes_one_line(tmp_path, drag, number):
    wild = WILDS[number]
    path = tmp_path / "wild.rt"
    path.write_bytes(wild.encode())
    session = played("press Tab", "press Tab", "press Tab", drag, "press Ctrl+S", text=wild, path=path)
    old, new = wild.split("\n"), path.read_bytes().decode().split("\n")
    different = [(a, b) for a, b in zip(old, new, strict=True) if a != b]
    assert len(different) == (drag != "press V")
    for before, after in different:
        assert before.partition("spc:")[1:] == after.partition("spc:")[1:]  # attributes, comment, carriage return
    assert dump(session.state.scene).encode() == path.read_bytes()


def test_editing_an_attribute_changes_one_word_of_its_line(tmp_path):
    path = tmp_path / "wild.rt"
    path.write_bytes(WILDS[1].encode())
    keys = ["press Tab", "press Tab", "press Tab", *["press V"] * 2, "press +", "press M", "press Shift+M"]
    played(*keys, "press Ctrl+S", text=WILDS[1], path=path)
    old, new = WILDS[1].split("\n"), path.read_bytes().decode().split("\n")
    ((before, after),) = ((a, b) for a, b in zip(old, new, strict=True) if a != b)
    assert before.replace("spc:.50,3e1", "spc:0.55,30") == after
