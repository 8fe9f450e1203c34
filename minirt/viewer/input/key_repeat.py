"""Held keys: how far what they do has gone at a moment, whatever the number of pictures until then."""

from __future__ import annotations

from dataclasses import dataclass

RATE = 8.0  # steps a second


@dataclass
class Hold:
    """One key that is down."""

    action: str
    since: float  # seconds
    given: float = 1.0  # steps done so far: the first comes with the press


class KeyRepeat:
    """The keys that are down and do something for as long as they are.

    After t seconds a key has done max(1, RATE t) steps: one with the press, and no jump when it goes on.
    """

    def __init__(self) -> None:
        self._holds: dict[int, Hold] = {}  # by key code

    def __bool__(self) -> bool:
        return bool(self._holds)

    def press(self, key: int, action: str, now: float) -> None:
        """The key goes down; its first step is the caller's."""
        self._holds[key] = Hold(action, now)

    def release(self, key: int, now: float) -> list[tuple[str, float]]:
        """The key goes up; the steps that it still has to do."""
        hold = self._holds.pop(key, None)
        return [advance(hold, now)] if hold else []

    def advance(self, now: float) -> list[tuple[str, float]]:
        """The actions of all held keys, and by how many steps each goes on."""
        return [advance(hold, now) for hold in self._holds.values()]


def advance(hold: Hold, now: float) -> tuple[str, float]:
    """The action and the steps since the last call."""
    due = max(hold.given, RATE * (now - hold.since))
    amount, hold.given = due - hold.given, due
    return hold.action, amount
