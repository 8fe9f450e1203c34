"""Undo, redo, and the merging of changes."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

import pytest

from minirt.scene import Scene, parse
from minirt.scene.pages import PAGE_LENGTH
from minirt.shapes.sphere import Sphere
from minirt.viewer.display.overlay import element_line
from minirt.viewer.editing import state as state_module
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import SAMPLE_SIZE, scene_size
from minirt.viewer.editing.state import MAX_UNDO, Snapshot, State, initial_state, stack_after_reading
from tests.viewer.fake import scene

HEAD = "A 0 0,0,0\nC 0,0,0 0,0,1 60\nL 0,0,0 1\n"
EDITS = ("right", "turn left", "grow", "undo", "redo", "duplicate", "delete", "look at", "reset camera", "undo", "undo")
CHOICES = ("select next", "select previous", "select camera", "select light", "next value", "next frame")


def fov(state: State) -> float:
    """Field of view of the camera, in degrees."""
    return state.scene.camera.fov


def test_changes_within_half_a_second_are_undone_together():
    state = initial_state(scene())
    for now in (0.0, 0.4, 0.9, 1.3):
        state = apply(state, "grow", now=now)
    assert fov(state) == 98
    assert fov(apply(state, "undo")) == 90
    assert fov(apply(apply(state, "undo"), "redo")) == 98


def test_redo_stops_at_the_last_change():
    state = apply(apply(initial_state(scene()), "grow"), "right")
    for action in ("undo", "undo", "redo", "redo"):
        state = apply(state, action)
    assert (fov(state), state.scene.camera.position[0] > 0) == (92, True)
    assert apply(state, "redo").message == "nothing to redo"
    assert apply(state, "redo").scene is state.scene


def test_a_pause_separates_changes():
    state = apply(apply(initial_state(scene()), "grow", now=0.0), "grow", now=0.6)
    assert fov(apply(state, "undo")) == 92


def test_changes_of_different_kinds_are_undone_separately():
    state = initial_state(scene())
    for action in ("grow", "right", "grow", "turn left"):
        state = apply(state, action, now=0.0)
    assert fov(state) == 94
    positions = []
    for _ in range(4):
        state = apply(state, "undo")
        positions.append((fov(state), state.scene.camera.position != (0, 0, 10)))
    assert positions == [(94, True), (92, True), (92, False), (90, False)]


def test_another_selection_or_value_separates_changes():
    for between in (["select next", "select camera"], ["next value"] * 4):
        state = initial_state(scene())
        for action in ("grow", *between, "grow"):
            state = apply(state, action, now=0.0)
        assert fov(state) == 94
        assert fov(apply(state, "undo")) == 92


def test_a_change_clears_the_redo_stack():
    state = apply(apply(apply(initial_state(scene()), "grow"), "undo"), "right")
    assert apply(state, "redo").message == "nothing to redo"
    assert apply(initial_state(scene()), "undo").message == "nothing to undo"


def test_undo_selects_the_changed_element():
    state = initial_state(scene())
    while state.element.title != "sphere":
        state = apply(state, "select next")
    state = apply(apply(apply(state, "grow"), "select camera"), "undo")
    assert (state.element.title, state.element.diameter) == ("sphere", 2)


def test_undoing_everything_restores_the_scene_of_the_file():
    start = initial_state(scene())
    state = start
    for step, action in enumerate(("right", "turn up", "duplicate", "select next", "grow", "delete", "look at") * 5):
        state = apply(state, action, now=float(step))
    while state.undo_stack:
        state = apply(state, "undo")
    assert state.scene is start.scene


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
