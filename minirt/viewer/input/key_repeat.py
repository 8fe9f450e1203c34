"""Key repeat: steps of the actions of held keys, proportional to time and independent of the frame rate."""

from __future__ import annotations

from dataclasses import dataclass

RATE = 8.0  # steps a second


@dataclass
class HeldKey:
    """A key that is held down."""

    action: str
    since: float  # seconds
    done: float = 1.0  # steps until now; the first one comes with the press


class KeyRepeat:
    """The held keys whose actions repeat.

    After t seconds a key has taken max(1, RATE t) steps: one with the press, then without a jump at a constant rate.
    """

    def __init__(self) -> None:
        self._held: dict[int, HeldKey] = {}  # by key code

    def __bool__(self) -> bool:
        return bool(self._held)

    def press(self, key: int, action: str, now: float) -> None:
        """Note that a key goes down. The caller takes its first step."""
        self._held[key] = HeldKey(action, now)

    def release(self, key: int, now: float) -> list[tuple[str, float]]:
        """Note that a key goes up. Returns its action and remaining steps, or nothing for an unknown key."""
        held = self._held.pop(key, None)
        return [advance(held, now)] if held else []

    def advance(self, now: float) -> list[tuple[str, float]]:
        """Return the actions of all held keys, each with its steps since the last call."""
        return [advance(held, now) for held in self._held.values()]


def advance(held: HeldKey, now: float) -> tuple[str, float]:
    """Return the action of a key and its steps since the last call."""
    due = max(held.done, RATE * (now - held.since))
    amount, held.done = due - held.done, due
    return held.action, amount
