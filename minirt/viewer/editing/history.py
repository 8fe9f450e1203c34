"""Undo and redo, by stacks of snapshots."""

from __future__ import annotations

from dataclasses import replace

from minirt.viewer.editing.state import MAX_UNDO, Snapshot, State

MAX_ITEMS = 1_000_000  # of all scenes of the undo stack, about 500 bytes each; edits share them, files read anew do not


def undo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Undo the last change, and restore the selection before it."""
    if not state.undo_stack:
        return state.with_message("nothing to undo")
    return restore(
        state.undo_stack[-1],
        replace(state, undo_stack=state.undo_stack[:-1], redo_stack=(*state.redo_stack, current_snapshot(state))),
    )


def redo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Redo the change that was undone last."""
    if not state.redo_stack:
        return state.with_message("nothing to redo")
    return restore(
        state.redo_stack[-1],
        replace(state, undo_stack=(*state.undo_stack, current_snapshot(state)), redo_stack=state.redo_stack[:-1]),
    )


def current_snapshot(state: State) -> Snapshot:
    """Snapshot of the current scene and selection."""
    return Snapshot(state.scene.drop_caches(), state.selected)


def stack_after_reading(state: State) -> tuple[Snapshot, ...]:
    """Undo stack of a state whose file was read anew. Its oldest entries are dropped where it has too many items."""
    stack = (*state.undo_stack[1 - MAX_UNDO :], current_snapshot(state))
    pages: set[int] = set()
    items = 0
    for number in range(len(stack) - 1, -1, -1):
        new = {id(page): len(page.items) for page in stack[number].scene.pages if id(page) not in pages}
        pages.update(new)
        items += sum(new.values())
        if items > MAX_ITEMS and number < len(stack) - 1:
            return stack[number + 1 :]
    return stack


def restore(snapshot: Snapshot, state: State) -> State:
    """The state with the scene of a snapshot. The active value stays if the selected element stays."""
    value_index = state.value_index if snapshot.selected == state.selected else 0
    return replace(state, scene=snapshot.scene, selected=snapshot.selected, value_index=value_index, last_change=None)
