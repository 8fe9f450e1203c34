"""The keys of one window: which are held, with which modifiers, and when a held one repeats."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.events import Event
from minirt.mlx.keys import MODIFIER_KEYS, Modifier

if TYPE_CHECKING:
    from collections.abc import Callable

REPEAT_DELAY = 0.5  # seconds until a held key repeats
REPEAT_INTERVAL = 0.04


class Keyboard:
    """Turns what a platform says about keys into presses and releases that always come in pairs.

    Platforms lose releases: when the focus leaves, when Cmd is held on macOS, and when a symbol changes under the
    finger (Shift and = is +; with Shift let go first, what is released is =). Such keys are released here.
    """

    def __init__(self, report: Callable[[Event, int], None]) -> None:
        self._report = report
        self.held: list[int] = []  # oldest first
        self.modifiers = Modifier.NONE
        self._repeating: int | None = None  # the newest key, while it is held
        self._repeat_at = 0.0

    def press(self, key: int, now: float, modifiers: Modifier | None = None) -> None:
        """`modifiers`: what the platform says was held; None takes it from the keys held."""
        self._see(modifiers)
        self.modifiers |= MODIFIER_KEYS.get(key, Modifier.NONE)
        if key not in self.held:
            self.held.append(key)
            if key not in MODIFIER_KEYS:
                self._repeating, self._repeat_at = key, now + REPEAT_DELAY
            self._report(Event.KEY_PRESS, key)

    def release(self, key: int, modifiers: Modifier | None = None) -> list[int]:
        """Returns the keys that were released: this one, and those that a modifier takes with it."""
        modifier = MODIFIER_KEYS.get(key, Modifier.NONE)
        released = [key] if key in self.held else []
        if modifier:
            released += [other for other in self.held if other != key and _lost_with(modifier, other)]
        self.held = [other for other in self.held if other not in released]
        self._see(modifiers)
        self.modifiers &= ~modifier
        self.modifiers |= self._held_modifiers()
        for lost in released:
            self._report(Event.KEY_RELEASE, lost)
        return released

    def release_all(self) -> None:
        """The focus is lost: no release will come."""
        released, self.held = self.held, []
        self.modifiers = Modifier.NONE
        for key in released:
            self._report(Event.KEY_RELEASE, key)

    @property
    def repeating(self) -> bool:
        """Whether the newest key is still held; modifiers do not repeat."""
        return self._repeating in self.held

    def repeat(self, now: float) -> None:
        """Report the newest key once more when its time has come: a release and a press, as X11 does."""
        if self._repeating in self.held and now >= self._repeat_at:
            self._repeat_at = max(self._repeat_at + REPEAT_INTERVAL, now)
            self._report(Event.KEY_RELEASE, self._repeating)
            self._report(Event.KEY_PRESS, self._repeating)

    def _see(self, modifiers: Modifier | None) -> None:
        self.modifiers = self._held_modifiers() if modifiers is None else modifiers

    def _held_modifiers(self) -> Modifier:
        modifiers = Modifier.NONE
        for key in self.held:
            modifiers |= MODIFIER_KEYS.get(key, Modifier.NONE)
        return modifiers


def _lost_with(modifier: Modifier, key: int) -> bool:
    """Whether letting `modifier` go may hide the release of `key`: printed symbols change with it, letters do not."""
    if key in MODIFIER_KEYS:
        return False
    if modifier is Modifier.COMMAND:
        return True
    return 0x20 < key < 0xFF00 and not 0x61 <= key <= 0x7A
