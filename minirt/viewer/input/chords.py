"""How a key, a character or a part of the mouse is spelled: `Tab`, `Shift+Tab`, `Ctrl+Z`, `+`, `wheel up`.

Letters and named keys are keys; every other character is typed text, wherever a keyboard has it. Ctrl stands for Cmd
on macOS.
"""

from __future__ import annotations

import sys
from enum import IntEnum
from typing import NamedTuple

from minirt.mlx import Button, Key, Modifier


class Drag(IntEnum):
    """A button that is held while the pointer moves."""

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
MODIFIERS = {"Ctrl": Modifier.ACCEL, "Shift": Modifier.SHIFT}
SHOWN = {"Ctrl": "Cmd"} if sys.platform == "darwin" else {}


class Chord(NamedTuple):
    """A key with the modifiers that are held with it, typed text, or a button of the mouse."""

    code: Key | Button | Drag | str
    modifiers: Modifier = Modifier.NONE


def key_named(name: str) -> Key | None:
    """The key of that name: `Tab`, `PageUp`, `a`, `F5`; None where there is none."""
    return KEYS.get(name.upper() if len(name) == 1 else name)


def chord(spelling: str) -> Chord:
    """What a spelling means; ValueError with the part that is unknown."""
    *held, name = spelling.split("+") if len(spelling) > 1 else [spelling]
    modifiers = Modifier.NONE
    for word in held:
        if word not in MODIFIERS:
            raise ValueError(word)
        modifiers |= MODIFIERS[word]
    if name in MOUSE:
        return Chord(MOUSE[name], modifiers)
    key = key_named(name)
    if key is not None:
        return Chord(key, modifiers)
    if len(name) == 1 and not name.isalnum() and not held:
        return Chord(name)
    raise ValueError(name)


def shown(spelling: str) -> str:
    """The spelling as this platform's keyboards have it."""
    return "+".join(SHOWN.get(word, word) for word in spelling.split("+")) if len(spelling) > 1 else spelling
