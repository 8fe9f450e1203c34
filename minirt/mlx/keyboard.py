"""Keyboard state of one window: held keys, modifiers and key repeat."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.events import Event
from minirt.mlx.keys import MODIFIER_KEYS, Modifier

if TYPE_CHECKING:
    from collections.abc import Callable

    from minirt.mlx.options import Options

REPEAT_DELAY = 0.5  # seconds until a held key repeats
REPEAT_INTERVAL = 0.04  # seconds


class Keyboard:
    """Pairs every press of a key with a release, although platforms lose releases.

    Releases are lost when the window loses the focus, when Cmd is held on macOS, and, if keys are reported as symbols,
    when the symbol of a held key changes (Shift and = is +; with Shift released first, the platform reports the
    release of =). This class releases the keys concerned.
    """

    def __init__(self, report: Callable[[Event, int], None], options: Options) -> None:
        self._report = report
        self._options = options
        self.held: list[int] = []  # oldest first
        self.modifiers = Modifier.NONE
        self._repeating: int | None = None  # the newest key, while it is held
        self._repeat_at = 0.0

    def press(self, key: int, now: float, modifiers: Modifier | None = None) -> None:
        """Hold a key down. `modifiers`: the held modifiers by the platform; None derives them from the held keys."""
        self._update_modifiers(modifiers)
        self.modifiers |= MODIFIER_KEYS.get(key, Modifier.NONE)
        if key not in self.held:
            self.held.append(key)
            if key not in MODIFIER_KEYS:
                self._repeating, self._repeat_at = key, now + REPEAT_DELAY
            self._report(Event.KEY_PRESS, key)

    def release(self, key: int, modifiers: Modifier | None = None) -> list[int]:
        """Release a key. Returns the released keys: this key, and the keys whose releases a modifier hides."""
        modifier = MODIFIER_KEYS.get(key, Modifier.NONE)
        released = [key] if key in self.held else []
        if modifier:
            released += [other for other in self.held if other != key and self._hides_release(modifier, other)]
        self.held = [other for other in self.held if other not in released]
        self._update_modifiers(modifiers)
        self.modifiers &= ~modifier
        self.modifiers |= self._held_modifiers()
        for lost in released:
            self._report(Event.KEY_RELEASE, lost)
        return released

    def release_all(self) -> None:
        """Release all keys, when the focus is lost and no release will come."""
        released, self.held = self.held, []
        self.modifiers = Modifier.NONE
        for key in released:
            self._report(Event.KEY_RELEASE, key)

    @property
    def repeating(self) -> bool:
        """Whether the newest key is still held; modifiers do not repeat."""
        return self._repeating in self.held

    def repeat(self, now: float) -> None:
        """Report a release and a press of the newest key, as X11 does, when its repeat is due."""
        if self._repeating in self.held and now >= self._repeat_at:
            self._repeat_at = max(self._repeat_at + REPEAT_INTERVAL, now)
            self._report(Event.KEY_RELEASE, self._repeating)
            self._report(Event.KEY_PRESS, self._repeating)

    def _hides_release(self, modifier: Modifier, key: int) -> bool:
        """Whether releasing `modifier` may hide the release of `key`: symbols change with it, letters do not."""
        if key in MODIFIER_KEYS:
            return False
        if modifier is Modifier.COMMAND:
            return True
        return self._options.symbols and 0x20 < key < 0xFF00 and not 0x61 <= key <= 0x7A

    def _update_modifiers(self, modifiers: Modifier | None) -> None:
        self.modifiers = self._held_modifiers() if modifiers is None else modifiers

    def _held_modifiers(self) -> Modifier:
        modifiers = Modifier.NONE
        for key in self.held:
            modifiers |= MODIFIER_KEYS.get(key, Modifier.NONE)
        return modifiers
