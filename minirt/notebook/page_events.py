"""Events of the page, as calls of a window."""

from __future__ import annotations

from typing import Any

from minirt.mlx.events import Button, Event
from minirt.mlx.window import Window
from minirt.notebook.key_names import code_of, modifiers_of, text_of

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
