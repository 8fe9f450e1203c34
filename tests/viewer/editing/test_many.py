"""Scenes with many elements: no action visits all of them, and undo keeps no copies of them."""

from __future__ import annotations

from unittest.mock import patch

import pytest

from minirt.scene import Scene, parse
from minirt.scene.pages import PAGE_LENGTH
from minirt.shapes.sphere import Sphere
from minirt.viewer.display.overlay import element_line
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import SAMPLE_SIZE, scene_size
from minirt.viewer.editing.state import State, initial_state

HEAD = "A 0 0,0,0\nC 0,0,0 0,0,1 60\nL 0,0,0 1\n"
EDITS = ("right", "turn left", "grow", "undo", "redo", "duplicate", "delete", "look at", "reset camera", "undo", "undo")
CHOICES = ("select next", "select previous", "select camera", "select light", "next value", "next frame")


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
