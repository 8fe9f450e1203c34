"""Keys that are held: their actions begin with the press, go on sixty times a second, and end with the release."""

from __future__ import annotations

from minirt.viewer.app.session import Session
from minirt.viewer.bindings import Binding
from minirt.viewer.editing.editor import FIRST_PART, HeldKey


def hold(session: Session, binding: Binding, key: int, is_typed: bool = False) -> None:
    """Begin the action of a key that goes on while the key is held."""
    session.release_button()
    session.held_keys[key] = held = HeldKey(binding.action, session.now, session.step, is_typed)
    session.show(held.advance(session.state, FIRST_PART, session.step, session.now))


def advance(session: Session) -> None:
    """Go on with the actions of all held keys."""
    state, now = session.state, session.now
    for held in session.held_keys.values():
        state = held.advance(state, held.steps(now), session.step, now)
    session.show(state)


def release(session: Session, key: int) -> None:
    """End the action of a key that goes up, if it has one: at least one whole step of it."""
    if held := session.held_keys.pop(key, None):
        steps = max(1.0, held.steps(session.now))
        session.show(held.advance(session.state, steps, session.step, session.now))
