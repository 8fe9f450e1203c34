"""Typing of the active value: a digit or = begins it, Enter sets it, Escape leaves the value as it was."""

from __future__ import annotations

from minirt.mlx import Key
from minirt.viewer.app.session import Session
from minirt.viewer.display.panel import Panel
from minirt.viewer.editing.typed_value import CHARACTERS, set_typed

ENTER = (Key.RETURN, Key.KEYPAD_ENTER)
TYPE = "type value"  # the action that begins with =
MAX_LENGTH = 40  # characters


class Typing:
    """Characters of a value that were typed; empty while no value is typed."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.text = ""

    def begin(self, character: str) -> None:
        """Begin with a digit or =."""
        self.session.release_button()
        self.session.state = self.session.state.with_message("")
        self.show(character)

    def on_text(self, characters: str) -> None:
        """Add what was typed, as far as values are made of it; a minus behind a number changes its sign."""
        text = self.text
        for character in characters:
            if character == "-" and not text.startswith("="):
                text = text.removeprefix("-") if text.startswith("-") else f"-{text}"
            elif character in CHARACTERS:
                text += character
        self.show(text[:MAX_LENGTH])

    def on_key(self, key: int) -> bool:
        """Take a key press; False if the key is not one of those that end or correct what is typed."""
        if key in ENTER:
            session = self.session
            text, self.text = self.text, ""
            self.show("")
            session.show(set_typed(session.state.with_message(""), text, session.now))
        elif key == Key.ESCAPE:
            self.show("")
        elif key == Key.BACKSPACE:
            self.show(self.text[:-1])
        else:
            return False
        return True

    def show(self, text: str) -> None:
        """Show what is typed; nothing if it is empty."""
        session = self.session
        self.text = text
        active = session.state.active
        name = active.name if active else "no value"
        session.screen.panel = Panel(f"{name}: {text}_    Enter: set it    Esc: leave it") if text else None
        session.refresh()
