"""Numbers of an element that are dragged or typed, and how they change the scene.

A number is dragged to slide it (Shift: finer), or clicked to type it; a digit or a sign types it, too, while it has the
focus. One drag is one step of undo.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from slimgui import imgui

from minirt.element import Element
from minirt.errors import MiniRTError
from minirt.fields import Three, spelled
from minirt.viewer.app.session import FINE_STEP, Session
from minirt.viewer.editing.placing import keep_standing
from minirt.viewer.editing.state import State
from minirt.viewer.editing.typed import CHARACTERS, set_typed, three_words, with_value
from minirt.viewer.editing.values import Value
from minirt.viewer.panel.gui import Gui

PIXELS = 6  # of a drag to the right or upwards, for one step
SLIDE = ("value slide", 0.0)  # kind and time of the changes of a drag: the constant time merges them for undo
TO_TYPE = 3  # frames until a text has the focus, and what began it
AGAIN = " again"
HINT = "drag it, or click to type it: -3, 2*3, +=1; Shift: finer"
HINT_OF_THREE = "drag it, or click to type it: -3, 2*3, +=1, or all three: 1 2 3; Shift: finer"
TYPING = imgui.InputTextFlags.ENTER_RETURNS_TRUE | imgui.InputTextFlags.AUTO_SELECT_ALL
NO_ERROR = -1, "", ""


class Numbers:
    """Numbers as widgets. What the user does is applied at once to the element, which is selected by that."""

    def __init__(self, session: Session, gui: Gui) -> None:
        self.session = session
        self.gui = gui
        self.error = NO_ERROR  # index of the element and name of its value that was refused, and why
        self.index = 0  # of the element whose rows are shown
        self._typing: tuple[int, Value] | None = None  # the number that is typed, after the index of its element
        self._shows_typing = False  # whether the last frame shows it
        self._goes_on = False  # whether Tab has left a number that was typed for another one
        self._again = ""  # or AGAIN: a part of the name of its widget
        self._text, self._first = "", ""  # what is typed, and the character that began it
        self.pressed = ""  # name of the number under the button that is down
        self._start: Element | None = None  # the element when the button went down
        self._slid = 0.0  # steps since

    @property
    def element(self) -> Element:
        """The element whose rows are shown, as it is now."""
        return self.session.state.scene.elements[self.index]

    @property
    def typing(self) -> tuple[int, Value] | None:
        """The value of which a part is typed, after the index of its element; None while no part is."""
        typed = self._typing
        return (typed[0], typed[1]._replace(channel=None)) if typed and typed[1].channel is not None else None

    def begin_frame(self) -> None:
        """Begin a frame: a number that is not shown any more is not typed any more."""
        if not self._first and not self._shows_typing:
            self._typing = None
        self._shows_typing = False
        self._goes_on &= imgui.is_key_down(imgui.Key.KEY_TAB)
        self.session.slides = bool(self.pressed) and imgui.is_mouse_down(imgui.MouseButton.LEFT)

    def number(self, value: Value, width: float, prefix: str = "") -> None:
        """Show a number as a button `width` pixels wide, or as a text while it is typed; drag it, or begin to type it.

        prefix: the name shown before the number where there is room. A click, Tab from a number that was typed, and a
        digit or sign while the number has the focus begin to type it.
        """
        if self._typing == (self.index, value):
            self.type(value, width)
            return
        texts, room = [*spellings(value.current(self.element), prefix)], width - self.gui.size / 2
        text = next((each for each in texts if imgui.calc_text_size(each)[0] < room), texts[-1])
        imgui.push_item_flag(imgui.ItemFlags.NO_TAB_STOP, self.is_typed_with_others(value))
        clicked = imgui.button(f"{text}###{value.name}", (width, 0.0))
        imgui.pop_item_flag()
        self.gui.hint(HINT_OF_THREE if isinstance(value.leaf, Three) else HINT)
        if imgui.is_item_activated():
            self.pressed, self._start, self._slid = value.name, self.element, 0.0
            self.session.state = self.session.state.end_merging()
        if self.pressed == value.name:
            self.drag(value)
        characters = self.gui.typed if imgui.is_item_focused() and not self.gui.types else ""
        if (clicked and not self._slid) or (self._goes_on and imgui.is_item_focused()):
            self.begin_typing(value, "")
        elif characters and characters in CHARACTERS:
            self.begin_typing(value, characters)
        if self.pressed == value.name and not imgui.is_item_active():
            self.pressed = ""
            self.gui.show(self.session.state.end_merging())

    def is_typed_with_others(self, value: Value) -> bool:
        """Whether a part gets its number from a text of three numbers that is typed, so that Tab passes it."""
        is_same = self.typing == (self.index, value._replace(channel=None))
        return is_same and bool(three_words(self._text))

    def drag(self, value: Value) -> None:
        """Slide the number under the button that is down, to the right or upwards to increase it."""
        right, down = self.gui.io.mouse_delta
        if self._start and (right or down) and imgui.is_mouse_dragging(imgui.MouseButton.LEFT):
            self._slid += (right - down) / PIXELS * (FINE_STEP if self.gui.io.key_shift else 1.0)
            self.step(value, self._start, self._slid)

    def begin_typing(self, value: Value, first: str) -> None:
        """Turn a number into a text, all of it selected; `first` replaces it."""
        self._goes_on = False
        self._typing, self._text, self._first = (self.index, value), spelled(value.current(self.element)), first or " "
        self.gui.unsettled = TO_TYPE

    def type(self, value: Value, width: float) -> None:
        """Show the text of the number that is typed; Enter, and the focus of another widget, set the number. After Tab
        the next number is typed; a double click selects all of the text. A text that is refused changes nothing."""
        if self._first:  # the text has not got the focus yet
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(width)
        entered, self._text = imgui.input_text(f"###{value.name}{self._again}", self._text, TYPING)
        self._shows_typing = True
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton.LEFT):
            self._again = "" if self._again else AGAIN  # another widget begins with all of the text selected
            self._first, self.gui.unsettled = " ", TO_TYPE
            return
        if self._first and imgui.is_item_active():
            self.gui.io.add_input_characters_utf8(self._first.strip())
            self._first = ""
        left = imgui.is_item_deactivated_after_edit() and not imgui.is_key_down(imgui.Key.KEY_ESCAPE)
        if imgui.is_item_deactivated() and imgui.is_key_down(imgui.Key.KEY_TAB):
            self._goes_on, self.gui.unsettled = True, TO_TYPE
        if entered or left:
            self.apply(lambda state: set_typed(state, value, self._text.strip(), self.session.now), value.name)
        if entered or (not self._first and not imgui.is_item_active()):
            self._typing = None

    # --- changes of the scene ---

    def step(self, value: Value, start: Element, steps: float) -> None:
        """Change a value by a number of steps from what it was in `start`."""
        state = self.session.state
        self.change(value, start, lambda: value.stepped(start, steps, state.scene, state.stride))

    def change(self, value: Value, start: Element, field: Callable[[], Any]) -> None:
        """Change a field of an element that was `start`; changes that follow each other are undone together."""

        def edit(state: State) -> State:
            changed = start.replace(**{value.field.name: field()})
            return state.edit_element(keep_standing(state, start, changed), *SLIDE)

        self.apply(edit, value.name)

    def set(self, value: Value, new: Any) -> None:
        """Set a value at once, as one step of undo."""
        self.apply(lambda state: with_value(state, value, lambda *_: new, self.session.now), value.name)

    def apply(self, edit: Callable[[State], State], name: str = "") -> None:
        """Select the element and make the state that `edit` returns the current one; it may raise an error.

        A change that is refused, by an error or a message and the same scene, is told at the row of the value `name`.
        """
        state = self.session.state.with_message("")
        if state.selected != self.index:
            state = state.select(self.index)
        try:
            after = edit(state)
        except (MiniRTError, ValueError, LookupError) as error:
            after = state.with_message(str(error))
        if after.message and after.scene is state.scene:
            self.error = self.index, name, after.message
        elif self.error[1] == name or self.error[0] != self.index:
            self.error = NO_ERROR
        self.gui.show(after)


def spellings(number: float, prefix: str) -> Iterator[str]:
    """Yield shorter and shorter texts for a number: with its name and without, and with fewer digits."""
    exact = f"{number:.6g}"
    for digits in (6, 4, 3, 2):
        text = f"{number:.{digits}g}"
        if ("e" in text) == ("e" in exact):  # 200 and not 2e+02
            yield f"{prefix} {text}".strip()
            yield text
