"""Several selected elements: what is added and removed, and edits of all of them as one step."""

from __future__ import annotations

from dataclasses import replace
from math import dist

import pytest

from minirt.scene import dump
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.editing.structure import rename
from tests.viewer.fake import TEXT, played, scene

CAMERA, LIGHT, SPHERE, PLANE, CYLINDER = range(1, 6)  # indices of elements
SEVERAL = TEXT + "c 9,9,9 0,0,-1 60\nco 3,2,0 0,1,0 1 2 1,2,3\n"
CONE = 7


def chosen(*indices: int, text: str = SEVERAL) -> State:
    """A state with several selected elements, of which the last is the primary one."""
    state = initial_state(scene(text)).select(indices[0])
    for index in indices[1:]:
        state = state.add_or_remove(index)
    return state


def test_elements_are_added_and_removed_and_the_camera_in_view_is_alone() -> None:
    state = chosen(CAMERA, SPHERE, CONE, CYLINDER)
    assert (state.selected, state.others) == (CYLINDER, {SPHERE, CONE})
    state = state.add_or_remove(CYLINDER)
    assert (state.selected, state.others) == (CONE, {SPHERE})
    state = state.add_or_remove(SPHERE)
    assert (state.selected, state.others) == (CONE, set())
    assert state.add_or_remove(CONE).chosen == {CONE}
    assert chosen(SPHERE, CONE).add_or_remove(CAMERA).chosen == {CAMERA}
    assert (chosen(SPHERE, CONE).make_primary(SPHERE).selected, chosen(SPHERE, CONE).make_primary(SPHERE).others) == (
        SPHERE,
        {CONE},
    )
    for action in ("select next", "select camera", "select light"):
        assert apply(chosen(SPHERE, CONE), action).others == set()


@pytest.mark.parametrize("action", ["right", "up", "turn left", "roll right", "duplicate", "delete", "drop"])
@pytest.mark.parametrize("indices", [(SPHERE, CYLINDER, CONE), (LIGHT, PLANE, SPHERE)])
def test_an_edit_of_several_is_one_step_which_undo_takes_back_with_the_selection(indices, action) -> None:
    start = chosen(*indices)
    state = apply(start, action)
    assert len(state.undo_stack) == 1
    assert dump(state.scene) != SEVERAL
    undone = apply(state, "undo")
    assert dump(undone.scene) == SEVERAL
    assert (undone.selected, undone.others) == (start.selected, start.others)
    again = apply(undone, "redo")
    assert (again.scene.items, again.selected, again.others) == (state.scene.items, state.selected, state.others)


@pytest.mark.parametrize("action", ["left", "up", "forward", "turn left", "turn up", "roll right"])
def test_several_keep_their_distances_when_they_move_and_turn(action: str) -> None:
    state = chosen(SPHERE, CYLINDER, CONE)
    for step in range(7):
        state = apply(state, action, now=step)
    places = [
        (each.spheres[0].centre, each.cylinders[0].centre, each.cones[0].apex) for each in (scene(SEVERAL), state.scene)
    ]
    for one, other in ((0, 1), (1, 2), (0, 2)):
        before, after = (dist(each[one], each[other]) for each in places)
        assert after == pytest.approx(before, abs=1e-4)
    assert state.scene.spheres[0] == scene(SEVERAL).spheres[0].replace(centre=places[1][0])
    turned = state.scene.cylinders[0].axis, state.scene.cones[0].axis
    assert turned[0] == pytest.approx(turned[1], abs=1e-6)
    assert (places[0][2] == places[1][2]) == action.startswith(("turn", "roll"))  # about the primary one


def test_a_value_is_changed_of_the_primary_element_alone() -> None:
    state = apply(chosen(SPHERE, CYLINDER), "grow")
    assert state.scene.cylinders[0].diameter > 1
    assert state.scene.spheres[0].diameter == 2


def test_copies_are_selected_and_what_is_needed_is_neither_copied_nor_deleted() -> None:
    state = apply(chosen(SPHERE, CYLINDER), "duplicate")
    assert [state.scene.elements[index].title for index in sorted(state.chosen)] == ["sphere", "cylinder"]
    assert state.element is state.scene.cylinders[1]
    assert state.message == "a copy of 2 elements, beside the original"
    ambient = chosen(0, SPHERE)
    for action in ("duplicate", "delete"):
        after = apply(ambient, action)
        assert (after.scene, after.chosen) == (ambient.scene, ambient.chosen)
        assert after.message in ("a scene has one ambient light", "a scene needs its ambient light")


def test_hidden_elements_stay_hidden_when_several_are_deleted() -> None:
    state = apply(replace(chosen(LIGHT, SPHERE), hidden=frozenset([CYLINDER])), "delete")
    assert [state.scene.elements[index].title for index in state.hidden] == ["cylinder"]


# In the window of 64x48 pixels the sphere is at 32,24 and the cylinder at 40,24; the plane is below.

BOTH = ("click 32,24", "down Shift", "click 40,24", "up Shift")


def test_a_click_with_shift_selects_when_it_is_released_and_a_drag_with_it_turns() -> None:
    state = played(*BOTH).state
    assert (state.element.title, state.others) == ("cylinder", {SPHERE})
    assert played(*BOTH, "down Shift", "click 32,24", "up Shift").state.chosen == {CYLINDER}
    assert played(*BOTH, "click 32,24").state.chosen == {SPHERE}
    assert played(*BOTH, "press Tab").state.others == set()
    turned = played("click 32,24", "down Shift", "drag 40,24 48,36", "up Shift").state
    assert (turned.chosen, len(turned.undo_stack)) == ({CYLINDER}, 1)


@pytest.mark.parametrize("drag", ["drag 32,24 20,18", "drag 40,24 52,30", "down Ctrl, drag 32,24 20,40, up Ctrl"])
def test_a_drag_of_one_moves_all(drag: str) -> None:
    state = played(*BOTH, *drag.split(", ")).state
    sphere, cylinder = state.scene.spheres[0].centre, state.scene.cylinders[0].centre
    assert [b - a for a, b in zip(sphere, cylinder, strict=True)] == pytest.approx([3, 0, 0], abs=1e-4)
    assert sphere != (0, 0, 0)
    assert len(state.undo_stack) == 1
    assert dump(apply(state, "undo").scene) == TEXT


def test_a_drag_with_shift_turns_all_about_the_one_under_the_pointer() -> None:
    state = played(*BOTH, "down Shift", "drag 32,24 48,24", "up Shift").state
    assert state.scene.spheres[0].centre == (0, 0, 0)
    assert dist(state.scene.cylinders[0].centre, (0, 0, 0)) == pytest.approx(3, abs=1e-4)
    assert state.scene.cylinders[0].centre[2] != 0


# Names.


def test_a_name_is_typed_and_written_into_the_line(tmp_path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(TEXT)
    named = ("click 32,24", "press F2", "text head", "press Return")
    session = played(*named, "press Ctrl+S", path=path)
    assert path.read_text() == TEXT.replace("sp 0,0,0 2 255,0,0", "sp 0,0,0 2 255,0,0 # head")
    assert session.screen.list_box is None
    again = played(*named, "press F2", "text x", "press Return")
    assert "255,0,0 # x\n" in dump(again.state.scene)
    assert dump(played(*named, "press F2", "text x", "press Escape").state.scene) == path.read_text()
    assert dump(played(*named, "press F2", "press Backspace", "press Return").state.scene) == TEXT
    assert dump(played(*named, "press F2", "press Return", "press Ctrl+Z").state.scene) == TEXT


def test_a_name_is_an_unsaved_change_and_looking_around_none() -> None:
    from minirt.viewer.files import contents_differ

    state = initial_state(scene())
    named = rename(state.select(SPHERE), "head")
    assert contents_differ(named.scene, state.scene)
    assert contents_differ(rename(state, "eye").scene, state.scene)
    assert not contents_differ(apply(state, "left").scene, state.scene)
    assert not contents_differ(apply(named, "undo").scene, state.scene)
    assert rename(named, "head") is named


def test_a_new_element_below_a_named_block_is_apart_from_it() -> None:
    text = TEXT + "# arms\ncy 9,0,0 0,1,0 1 4 0,0,255\n"
    session = played("press N", "press Return", text=text)
    line = dump(session.state.scene).removeprefix(text)
    assert line.startswith("\nsp ")
    assert dump(played("press N", "press Return").state.scene).startswith(TEXT + "sp ")
