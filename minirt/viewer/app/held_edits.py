"""Edits by held keys: the first step comes in parts, so that the picture moves at once and never stands still.

Each part replaces the part before. So a tap leaves what one whole step leaves, to the last digit.
"""

from __future__ import annotations

from typing import NamedTuple

from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import State
from minirt.viewer.input.key_repeat import Advance


class FirstStep(NamedTuple):
    """The first step of a held key, of which a part was taken."""

    key: int
    size: float  # of a step when the key was pressed
    before: State  # the state before the key was pressed
    after: State  # the state after the part


class HeldEdits:
    """Applies the progress of held keys to the state of the editor."""

    def __init__(self) -> None:
        self._first: FirstStep | None = None  # of the last pressed key

    def apply(self, state: State, advance: Advance, size: float, now: float) -> State:
        """Return the state after the progress of a key; `size` is that of a step now."""
        if advance.after == advance.before:
            return state
        done, first = advance.before, self._first
        if first and first.key == advance.key and first.after is state:
            done, state, size = 0.0, first.before, first.size
        before = state
        if done < 1:
            state = apply(before, advance.action, (min(advance.after, 1.0) - done) * size, now)
        if advance.after > 1:
            state = apply(state, advance.action, (advance.after - max(done, 1.0)) * size, now)
        self._first = FirstStep(advance.key, size, before, state) if done == 0.0 and advance.after < 1 else None
        return state
