"""Scenes of many things: no key press looks at them one by one, and undo keeps no copies of them."""

from __future__ import annotations

from unittest.mock import patch

import pytest

from minirt.scene import Scene, parse
from minirt.scene.pages import PAGE_LENGTH
from minirt.shapes.sphere import Sphere
from minirt.viewer.display.overlay import line
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.measure import SAMPLE, size_of
from minirt.viewer.editing.state import State, opened

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
def test_an_action_asks_few_spheres_for_anything(many: Scene, action: str, selected: str) -> None:
    asked: set[int] = set()

    def ask(sphere: Sphere, name: str) -> object:
        asked.add(id(sphere))
        return object.__getattribute__(sphere, name)

    state = apply(apply(opened(many), selected), "right")
    with patch.object(Sphere, "__getattribute__", ask):
        line(apply(state, action))
        assert len(asked) <= 2 * PAGE_LENGTH


def test_undo_shares_all_but_a_page_of_each_scene(many: Scene) -> None:
    state = apply(apply(opened(many), "select next"), "select next")
    assert state.element is many.spheres[0]
    for step in range(21):
        state.scene.shapes  # noqa: B018 - as the renderer does, which leaves them in the scene
        state = apply(state, ("right", "grow", "duplicate")[step % 3], now=float(step))
    pages = {id(page) for moment in state.past for page in moment.scene.pages}
    assert len(state.past) == 21
    assert len(pages) <= len(many.pages) + len(state.past)
    assert not any("shapes" in vars(moment.scene) for moment in state.past)


def test_the_size_is_that_of_a_sample(many: Scene) -> None:
    measured: list[Sphere] = []

    def bounds(sphere: Sphere) -> object:
        measured.append(sphere)
        return known(sphere)

    known = Sphere.bounds
    with patch.object(Sphere, "bounds", bounds):
        size = size_of(many)
    assert SAMPLE / 2 < len({id(sphere) for sphere in measured}) <= SAMPLE
    assert size == pytest.approx(50, rel=0.05)


def test_the_last_of_many_is_found(many: Scene) -> None:
    state: State = apply(opened(many), "select previous")
    state = apply(apply(apply(state, "select camera"), "select light"), "select light")
    assert state.element is many.elements[-1]
    assert apply(state, "select light").element is many.lights[0]
    assert apply(state, "select previous").element is many.shapes[-1]
