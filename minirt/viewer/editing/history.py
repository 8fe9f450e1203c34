"""Undo and redo, by stacks of snapshots."""

from __future__ import annotations

from dataclasses import replace

from minirt.viewer.editing.state import Snapshot, State


def undo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Undo the last change, and restore the selection before it."""
    if not state.past:
        return state.with_message("nothing to undo")
    return restore(
        state.past[-1], replace(state, past=state.past[:-1], future=(*state.future, current_snapshot(state)))
    )


def redo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Redo the change that was undone last."""
    if not state.future:
        return state.with_message("nothing to redo")
    return restore(
        state.future[-1], replace(state, past=(*state.past, current_snapshot(state)), future=state.future[:-1])
    )


def current_snapshot(state: State) -> Snapshot:
    """Snapshot of the current scene and selection."""
    return Snapshot(state.scene.lighten(), state.selected)


def restore(snapshot: Snapshot, state: State) -> State:
    """The state with the scene of a snapshot. The active value stays if the selected element stays."""
    value = state.value if snapshot.selected == state.selected else 0
    return replace(state, scene=snapshot.scene, selected=snapshot.selected, value=value, last_change=None)
