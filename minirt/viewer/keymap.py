"""From what was pressed to the row of the table, for a keyboard's layout."""

from __future__ import annotations

import locale
from typing import Final

from minirt.mlx import Key, Modifier
from minirt.viewer.bindings import BINDINGS, Binding
from minirt.viewer.chords import Chord, chord

LAYOUTS: Final = ("auto", "qwerty", "azerty", "qwertz")
FRENCH = ("fr_FR", "fr_BE", "French_France", "French_Belgium")  # where AZERTY is usual
CONSIDERED = Modifier.ACCEL | Modifier.SHIFT


def detect(layout: str) -> str:
    """The layout that `auto` means here."""
    if layout != "auto":
        return layout
    return "azerty" if locale.getlocale()[0] in FRENCH else "qwerty"


def spellings(binding: Binding, layout: str) -> tuple[str, ...]:
    """The keys of a row on a keyboard of that layout; QWERTZ has the same letters as QWERTY where they matter."""
    if layout == "azerty" and binding.azerty:
        return (binding.azerty, *binding.keys[1:])
    return binding.keys


def chords(binding: Binding, layout: str) -> list[Chord]:
    """All that the handler answers to with this row."""
    plain = [chord(spelling) for spelling in spellings(binding, layout)]
    shifted = [Chord(each.code, each.modifiers | Modifier.SHIFT) for each in plain if not isinstance(each.code, str)]
    return plain + shifted if binding.fine else plain


class Keymap:
    """The table, turned for looking keys up."""

    def __init__(self, layout: str = "qwerty") -> None:
        self.layout = detect(layout)
        self._rows = {each: binding for binding in BINDINGS for each in chords(binding, self.layout)}

    def find(self, code: int | str, modifiers: Modifier = Modifier.NONE) -> Binding | None:
        """The row of a key (or button, or typed character) with these modifiers, None where there is none."""
        if code == Key.ESCAPE:
            modifiers = Modifier.NONE  # always
        if modifiers & ~CONSIDERED:
            return None
        # Equal integers are one key of a dictionary, whatever their enumeration; buttons and keys do not meet.
        return self._rows.get(Chord(code, modifiers))  # type: ignore[arg-type]
