"""Panels: typing the active value, and choosing an element or an attribute from a list.

A digit or = begins a value, Enter sets it, Escape leaves it as it was. In a list letters filter, arrows go through it
and Enter takes the choice, which is in the scene at once, so that the picture shows it. Escape takes it out again, and
any key that means nothing to the list leaves it there, as the last change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from minirt.mlx import Key
from minirt.viewer.app.session import Session
from minirt.viewer.display.overlay import Panel
from minirt.viewer.editing import structure
from minirt.viewer.editing.adding import addable_kinds
from minirt.viewer.editing.editor import CHARACTERS, set_typed
from minirt.viewer.editing.state import State

ENTER = (Key.RETURN, Key.KEYPAD_ENTER)
TYPE = "type value"  # the action that begins with =
MAX_LENGTH = 40  # characters
ADDING = ("add", "add previous")  # actions that open the list of elements
LISTS = (*ADDING, "add attribute")  # actions that open a list


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


class Choice(NamedTuple):
    """A row of a list."""

    title: str
    key: int | str  # number of a kind of element, or name of an attribute
    make: Callable[[float], State]  # adds it at a time


class Choosing:
    """The list that is open; it is so as long as its last choice is the last change of the scene."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._letters = ""
        self._choices: list[Choice] = []
        self._of_elements = True
        self._before: State | None = None

    @property
    def is_open(self) -> bool:
        """Whether the list is open."""
        kind = structure.ELEMENT if self._of_elements else structure.ATTRIBUTE
        return self._before is not None and structure.is_adding(self.session.state, kind)

    @property
    def is_filtered(self) -> bool:
        """Whether letters were typed into the open list."""
        return self.is_open and bool(self._letters)

    def begin(self, action: str, before: State) -> None:
        """Show the list after an action of LISTS has added the first choice, or the next one, to `before`."""
        if not self.is_open or self._of_elements != (action in ADDING):
            self._letters = ""
            self._of_elements = action in ADDING
            self._before = before
            self._choices = element_choices(before) if self._of_elements else attribute_choices(before)
        self.show()

    def end(self) -> None:
        """Close the list; what it added stays."""
        if self._before is not None:
            self._before = None
            self.show()

    def on_key(self, key: int) -> bool:
        """Take a key press; False if the key means nothing to the list."""
        rows = self.rows()
        if key in ENTER:
            self.session.state = self.session.state.end_merging()
            self.end()
        elif key == Key.ESCAPE:
            self.cancel()
        elif key in (Key.UP, Key.DOWN):
            if rows:
                self.choose(rows[(self.chosen(rows) + (1 if key == Key.DOWN else -1)) % len(rows)])
        elif key == Key.BACKSPACE and self._letters:
            self.filter(self._letters[:-1])
        elif Key.A <= key <= Key.Z or (key == Key.SPACE and self._letters):
            self.filter(self._letters + chr(key))
        else:
            return False
        return True

    def filter(self, letters: str) -> None:
        """Show the choices that contain some letters, and choose the first of them."""
        self._letters = letters
        rows = self.rows()
        if rows and letters:
            self.choose(rows[0])
        else:
            self.show()

    def choose(self, choice: Choice) -> None:
        """Replace the last choice in the scene by another one."""
        session = self.session
        session.state = choice.make(session.now)
        self.show()
        session.show(session.state)

    def cancel(self) -> None:
        """Take the last choice out of the scene again, and close the list."""
        before, self._before = self._before, None
        assert before
        self.session.screen.panel = None
        self.session.show(replace(before, aim=None).with_message(""))

    def rows(self) -> list[Choice]:
        """The choices that contain the letters: first those that begin with them, then those of which a word does."""
        letters = self._letters
        if not letters:
            return self._choices
        found = [choice for choice in self._choices if letters in choice.title]
        return sorted(
            found, key=lambda choice: (not choice.title.startswith(letters), f" {letters}" not in choice.title)
        )

    def chosen(self, rows: list[Choice]) -> int:
        """Index of the last choice in `rows`, or 0."""
        state = self.session.state
        active = state.active.field.name if state.active else ""
        key = state.kind_index if self._of_elements else active
        return next((index for index, row in enumerate(rows) if row.key == key), 0)

    def show(self) -> None:
        """Show the list, or nothing if it is closed."""
        screen = self.session.screen
        if not self.is_open:
            screen.panel = None
        else:
            rows = self.rows()
            noun = "element" if self._of_elements else "attribute"
            hint = "" if rows else "    nothing is called so"
            title = f"{noun}: {self._letters}_{hint}    type, arrows, Enter    Esc: none"
            screen.panel = Panel(title, tuple(row.title for row in rows), self.chosen(rows))
        self.session.refresh()


def element_choices(state: State) -> list[Choice]:
    """The kinds of elements that can be added to a scene."""
    before = structure.before_adding(state, structure.ELEMENT)
    kinds = addable_kinds(before.scene)
    made = structure.default_elements(kinds, range(len(kinds)), before)
    return [Choice(kinds[number].title, number, partial(structure.added, before, number, new)) for number, new in made]


def attribute_choices(state: State) -> list[Choice]:
    """The attributes that the selected element lacks."""
    before = structure.before_adding(state, structure.ATTRIBUTE)
    missing = structure.missing_attributes(before.element, before)
    return [
        Choice(field.title, field.name, partial(structure.with_attribute, before, field.name, value))
        for field, value in missing
    ]
