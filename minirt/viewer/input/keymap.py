"""From what was pressed to the row of the table, for a keyboard's layout."""

from __future__ import annotations

from minirt.mlx import Key, Modifier
from minirt.viewer.input.bindings import BINDINGS, Binding
from minirt.viewer.input.chords import Chord, chord
from minirt.viewer.input.layouts import detect

CONSIDERED = Modifier.ACCEL | Modifier.SHIFT


def chords(binding: Binding, layout: str) -> list[Chord]:
    """All that the handler answers to with this row."""
    plain = [chord(spelling) for spelling in binding.spellings(layout)]
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
