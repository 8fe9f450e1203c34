"""Keys as browsers name them have the codes, the modifiers and the text that the window's keys have."""

from __future__ import annotations

from typing import Any

import pytest

from minirt.mlx.events import Key, Modifier
from minirt.notebook.page_events import code_of, modifiers_of, text_of


def event(key: str, code: str = "", location: int = 0, **held: bool) -> dict[str, Any]:
    modifiers = dict.fromkeys(("shift", "ctrl", "alt", "command"), False) | held
    return {"key": key, "code": code, "location": location, **modifiers}


@pytest.mark.parametrize(
    ("pressed", "code", "text"),
    [
        (event("a", "KeyA"), Key.A, "a"),
        (event("A", "KeyA", shift=True), Key.A, "A"),
        (event("q", "KeyA"), Key.Q, "q"),  # of a French keyboard
        (event("ф", "KeyA"), Key.A, "ф"),  # of a Russian one
        (event("+", "Equal", shift=True), Key.PLUS, "+"),
        (event("z", "KeyZ", ctrl=True), Key.Z, ""),
        (event("z", "KeyZ", command=True), Key.Z, ""),
        (event("{", "Digit7", ctrl=True, alt=True), ord("{"), "{"),  # AltGr of a German keyboard on Windows
        (event("ArrowLeft", "ArrowLeft"), Key.LEFT, ""),
        (event("ArrowLeft", "Numpad4", 3), Key.KEYPAD_LEFT, ""),
        (event("4", "Numpad4", 3), Key.DIGIT_4, "4"),
        (event("Enter", "Enter"), Key.RETURN, ""),
        (event("Enter", "NumpadEnter", 3), Key.KEYPAD_ENTER, ""),
        (event("Delete", "Delete"), Key.DELETE, ""),
        (event("PageUp", "PageUp"), Key.PAGE_UP, ""),
        (event("F1", "F1"), Key.F1, ""),
        (event(" ", "Space"), Key.SPACE, " "),
        (event("Shift", "ShiftRight", 2, shift=True), Key.SHIFT_R, ""),
        (event("Dead", "BracketLeft"), None, ""),
        (event("AudioVolumeUp", "AudioVolumeUp"), None, ""),
    ],
)
def test_codes_and_text(pressed: dict[str, Any], code: int | None, text: str) -> None:
    assert (code_of(pressed), text_of(pressed)) == (code, text)


def test_command_is_the_modifier_of_shortcuts() -> None:
    assert modifiers_of(event("z", command=True)) == Modifier.ACCEL
    assert modifiers_of(event("z", shift=True, alt=True)) == Modifier.SHIFT | Modifier.ALT
    assert modifiers_of(event("z")) == Modifier.NONE
