"""Undo and redo."""

from __future__ import annotations

from dataclasses import replace

from minirt.viewer.editing.state import Moment, State


def undo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Back to before the last change, and to what was selected then."""
    if not state.past:
        return state.say("nothing to undo")
    return back_to(state.past[-1], replace(state, past=state.past[:-1], future=(*state.future, here(state))))


def redo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Do again what was undone last."""
    if not state.future:
        return state.say("nothing to redo")
    return back_to(state.future[-1], replace(state, past=(*state.past, here(state)), future=state.future[:-1]))


def here(state: State) -> Moment:
    return Moment(state.scene.drop_caches(), state.selected)


def back_to(moment: Moment, state: State) -> State:
    """The state with that scene; the value stays active where the same element is selected."""
    value = state.value if moment.selected == state.selected else 0
    return replace(state, scene=moment.scene, selected=moment.selected, value=value, recent=None)
