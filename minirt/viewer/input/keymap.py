"""Keymap: look up the binding of a chord, for a keyboard layout."""

from __future__ import annotations

from minirt.mlx import Key, Modifier
from minirt.viewer.input.bindings import BINDINGS, Binding
from minirt.viewer.input.chords import PRINTED, Chord, parse_chord
from minirt.viewer.input.layouts import resolve_layout

SIGNIFICANT = Modifier.ACCEL | Modifier.SHIFT


def chords_of(binding: Binding, layout: str) -> list[Chord]:
    """All chords that trigger a binding."""
    plain = [parse_chord(spelling) for spelling in binding.spellings(layout)]
    shifted = [Chord(each.code, each.modifiers | Modifier.SHIFT) for each in plain if not isinstance(each.code, str)]
    return plain + shifted if binding.fine else plain


class Keymap:
    """The table of bindings, indexed by chord."""

    def __init__(self, layout: str = "qwerty") -> None:
        self.layout = resolve_layout(layout)
        self._bindings = {each: binding for binding in BINDINGS for each in chords_of(binding, self.layout)}

    def find(self, code: int | str, modifiers: Modifier = Modifier.NONE) -> Binding | None:
        """Return the binding of a key, button or typed character with these modifiers, or None."""
        if code == Key.ESCAPE:
            modifiers = Modifier.NONE  # with any modifiers
        if Modifier.ACCEL in modifiers and code in PRINTED.values():
            modifiers &= ~Modifier.SHIFT  # some keyboards print the symbol only with Shift
        if modifiers & ~SIGNIFICANT:
            return None
        # Equal integers are one dictionary key, whatever their enumeration; codes of buttons and keys do not overlap.
        return self._bindings.get(Chord(code, modifiers))  # type: ignore[arg-type]
