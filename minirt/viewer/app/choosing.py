"""Choosing from a list: an element or attribute to add, a colour, or what to do with what is under the pointer.

Letters filter, arrows, the wheel and the pointer go through the list, Enter and a click take a row. An element,
attribute or colour is in the scene as soon as it is chosen by a key, so that the picture shows it. Escape takes it out
again, and any key that means nothing to the list leaves it there, as the last change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from minirt.fields import Triple
from minirt.mlx import Button, Key
from minirt.scene.names import element_name
from minirt.viewer.app.menu import MENU, menu_of
from minirt.viewer.app.session import Session
from minirt.viewer.app.typed_value import ENTER
from minirt.viewer.bindings import BY_ACTION, SIGNIFICANT, Binding, keys_of
from minirt.viewer.display.lists import MARGIN, WHEEL, ListBox, layout_of
from minirt.viewer.editing import structure
from minirt.viewer.editing.colours import COLOUR, SECOND_COLOUR, colours, colours_of, next_colour
from minirt.viewer.editing.state import State
from minirt.viewer.language import GAP, searchable, translated

ADDING = {"add": 1, "add previous": -1}  # actions that open the list of elements, and how they go on in it
LISTS = {  # actions that open a list of states, and the kind of the change that each of them is
    **dict.fromkeys(ADDING, structure.ELEMENT),
    "add attribute": structure.ATTRIBUTE,
    "choose colour": COLOUR,
    SECOND_COLOUR: COLOUR,
}
TITLES = {  # of these lists, and what is said where they are empty
    structure.ELEMENT: ("element", ""),
    structure.ATTRIBUTE: ("attribute", "{} has no attribute that can be added"),
    COLOUR: ("colour", "{} has no colour"),
}
HINT = "preview    click or Enter: keep it    Esc: none"


class ListRow(NamedTuple):
    """A row of a list, which leads to a state that the picture shows, or to an action."""

    title: str
    state: State | None = None
    action: str = ""
    note: str = ""  # in the column of the keys: the value of an attribute that is there


class Choosing:
    """The list that is open. A list of states is open only while the state chosen last is the last change."""

    def __init__(self, session: Session, perform: Callable[[Binding], None]) -> None:
        self.session = session
        self._perform = perform
        self._title = ""
        self._letters = ""
        self._every: list[ListRow] = []
        self._chosen: ListRow | None = None
        self._group = ""  # of the last change, in a list of states
        self._before: State | None = None  # while the list is open
        self._place: tuple[int, int] | None = None  # pixel where it was asked for; None: its usual place
        self.target: tuple[int, int] | None = None  # pixel that an action of it is about, while it is performed
        self.names_value = False  # whether a letter of a typed value opened it, after which Tab goes on

    @property
    def is_open(self) -> bool:
        last = self.session.state.last_change
        return self._before is not None and (not self._group or (last is not None and last[0] == self._group))

    def begin(self, action: str, state: State) -> None:
        """Open the list of an action of LISTS for the selected element of `state`, and choose the kind that keys added
        last, or else the first row that is not there yet. A message tells of an empty list."""
        group = LISTS[action]
        title, complaint = TITLES[group]
        if group == COLOUR and (every := colours_of(state.element)):
            state = state.with_active(next_colour(state) if action == SECOND_COLOUR else every[0])
            title, _, _ = state.active.name.partition(":")  # without the name of a part
        choices = list(colours(state) if group == COLOUR else structure.choices(state, group))
        if not choices:
            self.session.show(state.with_message(complaint.format(state.element.title)))
            return
        self._before, self._group, self._letters, self._title = state, group, "", title
        self.names_value = False
        self._every = [ListRow(translated(title), each, note=structure.present(state, each)) for title, each in choices]
        last_kind = state.added_kind if group == structure.ELEMENT and not self._place else None
        of_kind = (row for row, (_, each) in zip(self._every, choices, strict=True) if type(each.element) is last_kind)
        new = (row for row in self._every if not row.note)
        self.choose(next(of_kind, None) or next(new, self._every[0]))

    def begin_menu(self, place: tuple[int, int], point: Triple | None) -> None:
        """Show what can be done with the selected element, or at a pixel that shows a point of the scene or none."""
        state = self.session.state
        self._before, self._group, self._letters, self._place = state, "", "", place
        self.names_value = False
        self._title = element_name(state.scene, state.selected, translated)
        self._every = [ListRow(translated(MENU[action]), action=action) for action in menu_of(state, point)]
        self.choose(self._every[0])

    def end(self) -> None:
        """Close the list; what it added stays."""
        if self._before is not None:
            if self._group:
                self.session.state = self.session.state.end_merging()
            self._before = self._place = None
            self.show()

    def takes(self, key: int, pressed: Binding | None) -> bool:
        """Take a key press, with its binding; False if the list is closed or the key means nothing to the list."""
        if not self.is_open:
            return False
        action = pressed.action if pressed and not self._letters else ""
        if self._group and LISTS.get(action) == self._group:  # the key of the list itself
            self.step(ADDING.get(action, 1))
        elif named := [row for row in self._every if row.action and row.action == action]:  # the key of a row
            self.choose(named[0])
            self.take()
        elif (self._group and action in LISTS) or self.session.modifiers & SIGNIFICANT:
            return False
        elif key in ENTER:
            self.take()
        elif key == Key.ESCAPE:
            self.cancel()
        elif key in (Key.UP, Key.DOWN):
            self.step(1 if key == Key.DOWN else -1)
        elif key == Key.BACKSPACE and self._letters:
            self.filter(self._letters[:-1])
        elif Key.A <= key <= Key.Z or (key == Key.SPACE and self._letters):
            self.filter(self._letters + chr(key))
        else:
            return False
        return True

    def takes_button(self, button: int, x: int, y: int) -> bool:
        """Take a button that goes down on a row, or the wheel; False if the list is closed or the button means nothing.

        Any button beside a list of actions closes that list.
        """
        if not self.is_open:
            return False
        row = self.row_at(x, y)
        if button in WHEEL:
            self.step(WHEEL[button])
        elif row and button == Button.LEFT:
            self.choose(row)
            self.take()
        elif not self._group:
            self.end()
        else:
            return False
        return True

    def takes_motion(self, x: int, y: int) -> bool:
        """Choose the row under the pointer; False if it is on none, and no list of actions is open."""
        row = self.row_at(x, y) if self.is_open else None
        if row and row is not self._chosen:
            self.choose(row)
        return bool(row) or (self.is_open and not self._group)

    def row_at(self, x: int, y: int) -> ListRow | None:
        """Return the row at a pixel of the window; None beside the list."""
        screen = self.session.screen
        if screen.list_box is None:
            return None
        layout = layout_of(screen.list_box, *screen.size, screen.text_size)
        index = layout.row_at(x, y)
        return None if index is None else self.rows()[index]

    def take(self) -> None:
        """Take the chosen row: its state stays, or its action is performed where it was asked for."""
        row, place, before = self._chosen, self._place, self._before
        if self._group and before and before.scene is self.session.state.scene:  # a colour or an attribute as it was
            self._before = replace(before, value_index=self.session.state.value_index)
            self.cancel()
            return
        self.end()
        if row and row.action and place and row in self.rows():
            self.session.pointer = self.target = place
            self.perform_at(place, row.action)
            self.target = None

    def perform_at(self, place: tuple[int, int], action: str) -> None:
        """Perform an action, whose list is at a place of the window if it opens one."""
        self._place = place
        self._perform(BY_ACTION[action])
        if not self.is_open:
            self._place = None

    def cancel(self) -> None:
        """Close the list, and take out what it added."""
        before = self._before
        assert before
        self.end()
        if self._group:
            self.session.show(replace(before, aim=None, message=""))

    def step(self, step: int) -> None:
        """Choose a further row, cyclically."""
        if rows := self.rows():
            self.choose(rows[(self.index_in(rows) + step) % len(rows)])

    def filter(self, letters: str) -> None:
        """Show the rows that contain some letters, and choose the first; letters that none has are not taken."""
        before, self._letters = self._letters, letters
        if rows := self.rows():
            self.choose(rows[0] if letters else self._chosen or rows[0])
        else:
            self._letters = before
            self.show(f"nothing is called {letters}")

    def choose(self, row: ListRow) -> None:
        """Choose a row: its state replaces the last one in the scene."""
        self._chosen = row
        if row.state:
            self.session.state = row.state
            self.show()
            self.session.show(row.state)
        else:
            self.show()

    def rows(self) -> list[ListRow]:
        """The rows that contain the letters: first those that begin with them, then those of which a word does."""
        letters = self._letters
        found = [(searchable(row.title), row) for row in self._every if letters in searchable(row.title)]
        if letters:
            found.sort(key=lambda each: (not each[0].startswith(letters), f" {letters}" not in each[0]))
        return [row for _, row in found]

    def index_in(self, rows: list[ListRow]) -> int:
        """Index of the chosen row, or 0."""
        return next((index for index, row in enumerate(rows) if row is self._chosen), 0)

    def show(self, complaint: str = "") -> None:
        """Show the list, with a complaint in place of the hint on its keys; no list if it is closed."""
        screen = self.session.screen
        screen.list_box = None
        if self.is_open:
            rows, title = self.rows(), self._title
            if self._group or self._letters:
                title = f"{title}: {self._letters}_"
            if complaint or self._group:
                title = GAP.join((title, complaint or HINT))
            layout = self.session.keymap.layout
            keys = [keys_of(row.action, layout)[0] if row.action else row.note for row in rows]
            titles = tuple(row.title for row in rows)
            place, left = self._place, MARGIN + screen.tools_width
            screen.list_box = ListBox(title, titles, self.index_in(rows), tuple(map(translated, keys)), place, left)
        self.session.refresh()
