"""Key chords and their spelling: `Tab`, `Shift+Tab`, `Ctrl+Z`, `+`, `wheel up`.

Letters and named keys are keys; any other character is typed text, wherever a keyboard has it, and with Ctrl the key
that prints it, with or without Shift: `Ctrl++`. Ctrl means Cmd on macOS.
"""

from __future__ import annotations

import sys
from enum import IntEnum
from typing import NamedTuple

from minirt.mlx import Button, Key, Modifier


class Drag(IntEnum):
    """Drag with a mouse button."""

    LEFT = 0x100 + Button.LEFT
    MIDDLE = 0x100 + Button.MIDDLE
    RIGHT = 0x100 + Button.RIGHT


MOUSE: dict[str, Button | Drag] = {
    "left click": Button.LEFT,
    "right click": Button.RIGHT,
    "left drag": Drag.LEFT,
    "middle drag": Drag.MIDDLE,
    "right drag": Drag.RIGHT,
    "wheel up": Button.WHEEL_UP,
    "wheel down": Button.WHEEL_DOWN,
}
KEYS = {"".join(map(str.capitalize, key.name.split("_"))): key for key in Key}  # PageUp, A, F1
PRINTED = {"+": Key.PLUS, "-": Key.MINUS, "=": Key.EQUAL, "0": Key.DIGIT_0}  # with Ctrl, by what they print
MODIFIERS = {"Ctrl": Modifier.ACCEL, "Shift": Modifier.SHIFT}
PLATFORM_NAMES = {"Ctrl": "Cmd"} if sys.platform == "darwin" else {}


class Chord(NamedTuple):
    """A key with held modifiers, typed text, a mouse button or a drag."""

    code: Key | Button | Drag | str
    modifiers: Modifier = Modifier.NONE


def key_named(name: str) -> Key | None:
    """Return the key with this name (`Tab`, `PageUp`, `a`, `F5`), or None."""
    return KEYS.get(name.upper() if len(name) == 1 else name)


def parse_chord(spelling: str) -> Chord:
    """Parse the spelling of a chord. ValueError with the unknown part as message."""
    before, plus, name = spelling.rpartition("+")
    if plus and not name and before[-1:] in ("", "+"):  # the key itself is +
        before, name = before[:-1], plus
    modifier_names = before.split("+") if before else []
    modifiers = Modifier.NONE
    for word in modifier_names:
        if word not in MODIFIERS:
            raise ValueError(word)
        modifiers |= MODIFIERS[word]
    if name in MOUSE:
        return Chord(MOUSE[name], modifiers)
    key = key_named(name)
    if key is not None:
        return Chord(key, modifiers)
    if len(name) == 1 and not name.isalnum() and not modifier_names:
        return Chord(name)
    if len(name) == 1 and modifiers == Modifier.ACCEL and name in PRINTED:
        return Chord(PRINTED[name], modifiers)
    raise ValueError(name)


def platform_spelling(spelling: str) -> str:
    """Spelling of a chord with the modifier names of this platform."""
    return "+".join(PLATFORM_NAMES.get(word, word) for word in spelling.split("+")) if len(spelling) > 1 else spelling
