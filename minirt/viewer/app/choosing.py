"""Choosing an element or an attribute from a list.

Letters filter, arrows go through the list and Enter takes the choice, which is in the scene at once, so that the
picture shows it. Escape takes it out again, and any key that means nothing to the list leaves it there, as the last
change.
"""

from __future__ import annotations

from dataclasses import replace

from minirt.mlx import Key
from minirt.viewer.app.session import Session
from minirt.viewer.app.typed_value import ENTER
from minirt.viewer.bindings import SIGNIFICANT, Binding
from minirt.viewer.display.overlay import Panel
from minirt.viewer.editing import structure
from minirt.viewer.editing.state import State
from minirt.viewer.language import searchable, translated

ADDING = {"add": 1, "add previous": -1}  # actions that open the list of elements, and how they go on in it
LISTS = dict.fromkeys(ADDING, structure.ELEMENT) | {"add attribute": structure.ATTRIBUTE}  # actions that open a list


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
