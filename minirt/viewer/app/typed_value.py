"""Typing the active value, which a digit or = begins, or a name, which F2 begins: Enter sets it, Escape leaves it.

Tab sets it, too, and begins the next value of the line on top; with Shift the one before.
"""

from __future__ import annotations

from collections.abc import Callable

from minirt.element import Element
from minirt.fields import Three
from minirt.mlx import Key, Modifier
from minirt.scene.names import LONGEST, element_name, own_name
from minirt.viewer.app.session import Session
from minirt.viewer.display.lists import ListBox
from minirt.viewer.display.words import next_in_line
from minirt.viewer.editing.colours import colours_of
from minirt.viewer.editing.structure import rename
from minirt.viewer.editing.typed import CHARACTERS, set_typed, three_words, value_for
from minirt.viewer.editing.values import part_names

ENTER = (Key.RETURN, Key.KEYPAD_ENTER)
SETTING = "Enter: set it    Tab: and the next    Esc: leave it"
EMPTY = "="  # begins a value of which nothing is typed
NAME = "# "  # begins a name that is typed, as it does in the file
BEGUN: dict[str, Callable[[Element], str]] = {  # what actions begin with; the first character replaces an old name
    "type value": lambda _: EMPTY,
    "rename": lambda element: NAME + own_name(element),
}
MAX_LENGTH = LONGEST  # characters


class Typing:
    """Characters of a value that were typed; empty while no value is typed."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.text = ""
        self._begun = ""  # as it was at the beginning

    @property
    def is_colour(self) -> bool:
        """Whether a value is typed that is the own colour of the element: a letter begins its word."""
        state = self.session.state
        is_value = bool(self.text) and not self.text.startswith(NAME)
        return is_value and colours_of(state.element)[:1] == [state.active]

    def begin(self, character: str) -> None:
        """Begin with a digit, =, or NAME and a name."""
        self.session.release_button()
        self.session.say("")
        self._begun = character
        self.show(character)

    def end(self) -> None:
        """Leave what was typed."""
        if self.text:
            self.show("")

    def on_text(self, character: str) -> None:
        """Add what was typed, as far as values are made of it; the = that began one goes."""
        text = self.text
        if text.startswith(NAME):
            text = (NAME if text == self._begun else text) + character
        elif character in f"{CHARACTERS} ":
            text = text.removeprefix(EMPTY) + character
        self.show(text[:MAX_LENGTH])

    def takes(self, key: int) -> bool:
        """Take a press of a key that ends or corrects what is typed; return whether the press is taken.

        While a name is typed, all other keys without Ctrl are taken, too: their characters follow as typed text.
        """
        session, text, is_name = self.session, self.text, self.text.startswith(NAME)
        if not text or key not in (*ENTER, Key.TAB, Key.ESCAPE, Key.BACKSPACE):
            return is_name and Modifier.ACCEL not in session.modifiers
        if key == Key.BACKSPACE and is_name:
            self.show(NAME if text == self._begun else NAME + text[len(NAME) : -1])
            return True
        self.show(text[:-1] if key == Key.BACKSPACE else "")
        if key in (*ENTER, Key.TAB):
            self.set(text)
            if key == Key.TAB and not session.state.message:
                self.go_on(whole=bool(three_words(text)))
        return True

    def go_on(self, whole: bool) -> None:
        """Begin the next value of the line on top, with Shift the one before. `whole`: all parts of it are set now."""
        session = self.session
        step = -1 if Modifier.SHIFT in session.modifiers else 1
        session.show(session.state.with_active(next_in_line(session.state, step, whole=whole)))
        self.begin(EMPTY)

    def set(self, text: str) -> None:
        """Set the name or the value that was typed; a message says what is wrong with it."""
        session = self.session
        session.say("")
        if text.startswith(NAME):
            session.show(rename(session.state, text.removeprefix(NAME)))
        elif text != EMPTY:
            session.show(set_typed(session.state, value_for(session.state, text), text, session.now))

    def show(self, text: str) -> None:
        """Make `text` what is typed, and show it with hints on its keys; nothing if it is empty."""
        session = self.session
        self.text = text
        hint = self.hint_on_value(text)
        if session.state.others:
            hint = f"{len(session.state.chosen)} elements selected    {hint}"
        if text.startswith(NAME):
            name = element_name(session.state.scene, session.state.selected)
            hint = f"name of {name}: {text.removeprefix(NAME)}_    Enter: set it    Esc: leave it"
        session.screen.list_box = ListBox(hint) if text else None
        session.refresh()

    def hint_on_value(self, text: str) -> str:
        """Return the name of the value that is typed, its present numbers, the text, and what else can be typed."""
        active, element = value_for(self.session.state, text), self.session.state.element
        names = " ".join(part_names(active.leaf)[: Three.width])
        also = f"or all three: {names}" if isinstance(active.get(element), tuple) else "+= -= *= /=: relative"
        if self.is_colour:
            also += "    or its word"
        present = active.current(element)
        parts = present if isinstance(present, tuple) else (present,)
        are_numbers = all(isinstance(part, int | float) and not isinstance(part, bool) for part in parts)
        now = ", now " + " ".join(f"{part:.6g}" for part in parts) if are_numbers else ""
        return f"{active.name}{now}: {'' if text == EMPTY else text}_    {SETTING}    {also}"
