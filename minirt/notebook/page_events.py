"""Events of the page, as calls of a window; keys by the names of browsers (https://www.w3.org/TR/uievents-key)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from minirt.mlx.events import KEYS, Button, Event, Modifier
from minirt.mlx.window import Window

Message = dict[str, Any]
BUTTONS = (Button.LEFT, Button.MIDDLE, Button.RIGHT, Button.BACK, Button.FORWARD)  # by their numbers in JavaScript


def deliver(window: Window, message: Message, now: float) -> None:
    """Report an event of the page to the window; events of an unknown kind are ignored."""
    match message.get("kind"):
        case "key down":
            press(window, message, now)
        case "key up":
            if code := code_of(message):
                window.keyboard.release(code, modifiers_of(message))
        case "button down" | "button up":
            window.keyboard.modifiers = modifiers_of(message)
            event = Event.BUTTON_PRESS if message["kind"] == "button down" else Event.BUTTON_RELEASE
            if 0 <= message["button"] < len(BUTTONS):
                window.on_button(event, BUTTONS[message["button"]], *point(window, message))
        case "motion":
            window.keyboard.modifiers = modifiers_of(message)
            window.on_motion(*point(window, message))
        case "wheel":
            window.keyboard.modifiers = modifiers_of(message)
            window.on_scroll(int(message["right"]), int(message["up"]), *point(window, message))
        case "enter" | "leave":
            window.deliver(Event.ENTER_NOTIFY if message["kind"] == "enter" else Event.LEAVE_NOTIFY)
        case "focus" | "blur":
            window.on_focus(message["kind"] == "focus")


def press(window: Window, message: Message, now: float) -> None:
    """Report a key that went down, and the text that it types."""
    if code := code_of(message):
        window.keyboard.press(code, now, modifiers_of(message))
    if text := text_of(message):
        window.on_text(text)


def point(window: Window, message: Message) -> tuple[int, int]:
    """Return the pixel of a point, which the page gives as shares of width and height."""
    return int(message["x"] * window.width), int(message["y"] * window.height)


KEYPAD: Final = 3  # the location of keys on the keypad
MODIFIERS: Final = {  # Command is the modifier of shortcuts, wherever the kernel runs
    "shift": Modifier.SHIFT,
    "ctrl": Modifier.CTRL,
    "alt": Modifier.ALT,
    "command": Modifier.ACCEL,
}


# A key that went down or up in the page: what it prints or its name (`key`), its place on an American keyboard
# (`code`), its `location`, and the modifiers `shift`, `ctrl`, `alt` and `command`, the Command key of a Mac.
KeyEvent = Mapping[str, Any]


def code_of(event: KeyEvent) -> int | None:
    """Return the code of the symbol that a key prints, lower case for letters; None for a key without a code.

    A key that prints no Latin letter stands for the letter that American keyboards have in its place.
    """
    key: str = event["key"]
    code: str = event["code"]
    side = code.replace("Left", "L").replace("Right", "R")  # ShiftL, which is the name of a key of ours
    if side != code and side in KEYS:
        return KEYS[side]
    if len(key) != 1:
        name = key.removeprefix("Arrow")
        usual = KEYS.get("Return" if name == "Enter" else name)
        return KEYS.get(f"Keypad{name}", usual) if event["location"] == KEYPAD else usual
    if not key.isascii() and code.startswith("Key") and len(code) == 4:
        return ord(code[3].lower())
    return ord(key.lower())


def modifiers_of(event: KeyEvent) -> Modifier:
    """Return the modifiers that are held."""
    return Modifier(sum({modifier for name, modifier in MODIFIERS.items() if event[name]}))


def text_of(event: KeyEvent) -> str:
    """Return the text that a key types, an empty string for none. AltGr, which types symbols, is Ctrl and Alt."""
    is_shortcut = event["command"] or event["ctrl"] != event["alt"]
    key: str = event["key"]
    return key if len(key) == 1 and not is_shortcut else ""
