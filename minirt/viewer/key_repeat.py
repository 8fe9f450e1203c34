"""Key repeat: steps of the actions of held keys, proportional to time and independent of the frame rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

RATE = 8.0  # steps a second, at first
PATIENCE = 1.0  # seconds after which the steps of a held key begin to grow
GROWTH = 2.0  # of the rate in each further second, as a multiple of the first rate
FIRST_PART = 0.5  # of the first step, which comes with the press


@dataclass
class HeldKey:
    """A key that is held down."""

    action: str
    since: float  # seconds
    done: float = 0.0  # steps until now


class Advance(NamedTuple):
    """Progress of a held key: its steps since the press, before and after."""

    key: int
    action: str
    before: float
    after: float


class KeyRepeat:
    """The held keys whose actions repeat.

    A part of the first step comes with the press, the rest follows until it is time for the second one: nothing stands
    still meanwhile. A key that was held for t seconds, at most PATIENCE, has taken max(1, RATE t) steps when it is
    released; after that its rate grows with time.
    """

    def __init__(self) -> None:
        self._held: dict[int, HeldKey] = {}  # by key code

    def __bool__(self) -> bool:
        return bool(self._held)

    def holds(self, key: int) -> bool:
        """Whether a key is held and repeats."""
        return key in self._held

    def press(self, key: int, action: str, now: float) -> list[Advance]:
        """Note that a key goes down. Returns the part of its first step that comes at once."""
        self._held[key] = HeldKey(action, now)
        return [self._advance(key, FIRST_PART)]

    def release(self, key: int, now: float) -> list[Advance]:
        """Note that a key goes up. Returns its remaining steps, or nothing for an unknown key."""
        if key not in self._held:
            return []
        last = self._advance(key, max(1.0, self._steps(key, now)))
        del self._held[key]
        return [last]

    def advance(self, now: float) -> list[Advance]:
        """Return the progress of all held keys since the last call."""
        return [self._advance(key, self._steps(key, now)) for key in self._held]

    def _steps(self, key: int, now: float) -> float:
        """Return the steps of a held key until now."""
        seconds = now - self._held[key].since
        steps = RATE * (seconds + GROWTH / 2 * max(0.0, seconds - PATIENCE) ** 2)
        return max(FIRST_PART + (1 - FIRST_PART) * steps, steps)

    def _advance(self, key: int, steps: float) -> Advance:
        """Note that a key has taken so many steps; it never takes any back."""
        held = self._held[key]
        before, held.done = held.done, max(held.done, steps)
        return Advance(key, held.action, before, held.done)
