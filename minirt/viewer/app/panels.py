"""Panels: typing the active value, choosing an element or an attribute from a list, and the help.

A digit or = begins a value, Enter sets it, Escape leaves it as it was. In a list letters filter, arrows go through it
and Enter takes the choice, which is in the scene at once, so that the picture shows it. Escape takes it out again, and
any key that means nothing to the list leaves it there, as the last change.
"""

from __future__ import annotations

from dataclasses import replace

from minirt.mlx import Button, Key
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import SIGNIFICANT, Binding
from minirt.viewer.display.overlay import Panel
from minirt.viewer.editing import structure
from minirt.viewer.editing.state import State
from minirt.viewer.editing.typed import CHARACTERS, set_typed
from minirt.viewer.language import searchable, translated

ENTER = (Key.RETURN, Key.KEYPAD_ENTER)
TYPE = "type value"  # the action that begins with =
HELP = "toggle help"
TURNS: dict[int, int] = {  # keys and buttons that turn the pages of the help
    **dict.fromkeys((Key.RIGHT, Key.DOWN, Key.PAGE_DOWN, Key.RETURN, Button.WHEEL_DOWN), 1),
    **dict.fromkeys((Key.LEFT, Key.UP, Key.PAGE_UP, Button.WHEEL_UP), -1),
}
MAX_LENGTH = 40  # characters
ADDING = {"add": 1, "add previous": -1}  # actions that open the list of elements, and how they go on in it
LISTS = dict.fromkeys(ADDING, structure.ELEMENT) | {"add attribute": structure.ATTRIBUTE}  # actions that open a list


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
        """Add what was typed, as far as values are made of it; a minus behind a number changes its sign."""
        text = self.text
        if character == "-" and not text.startswith("="):
            text = text.removeprefix("-") if text.startswith("-") else f"-{text}"
        elif character in CHARACTERS:
            text += character
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
        hint = f"{session.state.active.name}: {text}_    Enter: set it    Esc: leave it"
        session.screen.panel = Panel(hint) if text else None
        session.refresh()


def help_takes(session: Session, key: int, pressed: Binding | None) -> bool:
    """Take a key press or button while the help is open; False if it is closed or the key means nothing to it.

    Letters search the help, arrows and the wheel turn its pages; H, Escape and a click close it.
    """
    screen = session.screen
    closes = pressed is not None and pressed.action == HELP and not screen.search
    if not screen.help:
        return False
    if closes or key in (Key.ESCAPE, Button.LEFT, Button.MIDDLE, Button.RIGHT):
        screen.turn_help(0)
    elif key in TURNS:
        screen.turn_help(TURNS[key])
    elif session.modifiers & SIGNIFICANT:
        return False
    elif Key.A <= key <= Key.Z or key == Key.SPACE:
        screen.help, screen.search = 1, screen.search + chr(key)
    elif key == Key.BACKSPACE:
        screen.help, screen.search = 1, screen.search[:-1]
    else:
        return False
    session.refresh()
    return True


class Choosing:
    """The list that is open; it is so as long as its last choice is the last change of the scene."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._letters = ""
        self._choices: list[State] = []  # with the last change in place of the last choice
        self._group = structure.ELEMENT
        self._before: State | None = None

    @property
    def is_open(self) -> bool:
        last = self.session.state.last_change
        return self._before is not None and last is not None and last[0] == self._group

    def begin(self, action: str, state: State) -> None:
        """Add the first choice of an action of LISTS, or an element of the kind that was added last; show the list."""
        self._letters, self._group, self._before = "", LISTS[action], state
        self._choices = list(structure.choices(state, self._group))
        if self._choices:
            again = (each for each in self._choices if type(each.element) is state.added_kind)
            self.choose(self._choices[0] if self._group == structure.ATTRIBUTE else next(again, self._choices[0]))
        else:
            self.session.show(state.with_message(f"{state.element.title} has no attribute that can be added"))

    def end(self) -> None:
        """Close the list; what it added stays."""
        if self._before is not None:
            self._before = None
            self.show()

    def takes(self, key: int, pressed: Binding | None) -> bool:
        """Take a key press; False if the list is closed or the key means nothing to it."""
        if not self.is_open:
            return False
        rows, action = self.rows(), pressed.action if pressed and not self._letters else ""
        if LISTS.get(action) == self._group:  # again: the next choice
            self.choose(rows[(self.chosen(rows) + ADDING.get(action, 1)) % len(rows)])
        elif action in LISTS or self.session.modifiers & SIGNIFICANT:
            return False
        elif key in ENTER:
            self.session.state = self.session.state.end_merging()
            self.end()
        elif key == Key.ESCAPE:
            assert self._before
            before, self._before = self._before, None
            self.session.screen.panel = None
            self.session.show(replace(before, aim=None, message=""))
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

    def choose(self, choice: State) -> None:
        """Replace the last choice in the scene by another one."""
        self.session.state = choice
        self.show()
        self.session.show(choice)

    def title(self, choice: State) -> str:
        """What a choice is called in the list."""
        is_attribute = self._group == structure.ATTRIBUTE
        return translated(choice.active.field.title if is_attribute else choice.element.title)

    def rows(self) -> list[State]:
        """The choices that contain the letters: first those that begin with them, then those of which a word does."""
        letters = self._letters
        titles = [(searchable(self.title(choice)), choice) for choice in self._choices]
        found = [(title, choice) for title, choice in titles if letters in title]
        if letters:
            found.sort(key=lambda row: (not row[0].startswith(letters), f" {letters}" not in row[0]))
        return [choice for _, choice in found]

    def chosen(self, rows: list[State]) -> int:
        """Index of the last choice in `rows`, or 0."""
        element = self.session.state.element
        return next((index for index, row in enumerate(rows) if row.element == element), 0)

    def show(self) -> None:
        """Show the list, or nothing if it is closed."""
        screen = self.session.screen
        screen.panel = None
        if self.is_open:
            rows = self.rows()
            noun = "element" if self._group == structure.ELEMENT else "attribute"
            hint = "" if rows else "    nothing is called so"
            title = f"{noun}: {self._letters}_{hint}    type, arrows, Enter    Esc: none"
            screen.panel = Panel(title, tuple(map(self.title, rows)), self.chosen(rows))
        self.session.refresh()
