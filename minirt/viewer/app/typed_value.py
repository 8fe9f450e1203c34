"""Typing the active value: a digit or = begins it, Enter sets it, Escape leaves it as it was."""

from __future__ import annotations

from minirt.mlx import Key
from minirt.viewer.app.session import Session
from minirt.viewer.display.lists import ListBox
from minirt.viewer.editing.typed import CHARACTERS, set_typed

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
        self.session.say("")
        self.show(character)

    def end(self) -> None:
        """Leave what was typed."""
        if self.text:
            self.show("")

    def on_text(self, character: str) -> None:
        """Add what was typed, as far as values are made of it; the = that began it goes."""
        text = f"{self.text.removeprefix('=')}{character}" if character in CHARACTERS else self.text
        self.show(text[:MAX_LENGTH])

    def takes(self, key: int) -> bool:
        """Take a key press; False if the key is not one of those that end or correct what is typed."""
        if not self.text or key not in (*ENTER, Key.ESCAPE, Key.BACKSPACE):
            return False
        text = self.text
        self.show(text[:-1] if key == Key.BACKSPACE else "")
        if key in ENTER:
            self.session.say("")
            self.session.show(set_typed(self.session.state, self.session.state.active, text, self.session.now))
        return True

    def show(self, text: str) -> None:
        """Show what is typed; nothing if it is empty."""
        session = self.session
        self.text = text
        hint = f"{session.state.active.name}: {text}_    Enter: set it    Esc: leave it    += -= *= /=: relative"
        session.screen.list_box = ListBox(hint) if text else None
        session.refresh()
