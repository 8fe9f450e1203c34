"""New elements of every kind in the registry, in front of the camera."""

from __future__ import annotations

import pytest

from minirt.element import fields_of
from minirt.fields import Point
from minirt.scene import Camera, Resolution, dump, parse
from minirt.scene.registry import ELEMENTS
from minirt.shapes import KINDS
from minirt.shapes.mesh import Mesh
from minirt.viewer.editing.adding import addable_kinds, default_element
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import State, initial_state
from tests.viewer.fake import TEXT, scene

BARE = "A 0.2 255,255,255\nC 3,1,4 0.6,-0.2,0.7 50 roll:30\n"


def adding(state: State, times: int, action: str = "add") -> State:
    """The state after an action is repeated."""
    for number in range(times):
        state = apply(state, action, now=float(number))
    return state


def test_everything_that_can_be_edited_can_be_added() -> None:
    kinds = addable_kinds(scene(BARE))
    excluded = (Resolution, Camera, ELEMENTS["A"], Mesh)  # the last needs a file
    assert set(kinds) == {kind for kind in ELEMENTS.values() if kind not in excluded}
    assert kinds[: len(KINDS)] == [kind.element for kind in KINDS]
    assert ELEMENTS["L"] not in addable_kinds(scene())


@pytest.mark.parametrize(
    ("text", "kind"), [(text, kind) for text in (TEXT, BARE) for kind in addable_kinds(scene(text))]
)
def test_each_kind_is_made_from_its_fields_and_visible(kind: type, text: str) -> None:
    state = initial_state(scene(text))
    element = default_element(kind, state)
    assert type(element) is kind
    projection = projection_of(state.scene.camera, 640, 360)
    for field in fields_of(kind):
        if isinstance(field, Point):
            x, y = projection.pixel(getattr(element, field.name))
            assert 0 < x < 640
            assert 0 < y < 360
    again = parse(dump(state.scene.edit(0, state.scene.elements[0], element))).scene
    assert again.elements[1] == element


def test_repeated_adding_makes_the_next_kind_and_is_one_undo_step() -> None:
    start = initial_state(scene())
    kinds = addable_kinds(start.scene)
    for times in range(1, len(kinds) + 2):
        state = adding(start, times)
        assert type(state.element) is kinds[(times - 1) % len(kinds)]
        assert len(state.scene.elements) == len(start.scene.elements) + 1
        assert apply(state, "undo").scene.items == start.scene.items
        assert len(state.undo_stack) == 1
    assert type(adding(adding(start, 3), 1, "add previous").element) is kinds[1]


def test_after_an_edit_another_element_of_the_same_kind_is_added() -> None:
    state = adding(initial_state(scene()), 3)
    kind = type(state.element)
    for action in ("right", "grow", "select camera", "undo"):
        other = adding(apply(state, action), 1)
        assert type(other.element) is kind
        if action != "undo":
            assert len(other.scene.elements) == len(state.scene.elements) + 1


def test_undo_restores_the_selection() -> None:
    state = apply(initial_state(scene()), "select light")
    undone = apply(adding(state, 4), "undo")
    assert undone.element == state.element
    assert apply(undone, "redo").element == adding(state, 4).element
