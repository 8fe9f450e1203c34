"""Rows: widgets for the values of an element, chosen by the types of its declared fields alone.

A number is dragged to slide it (Shift: finer), or clicked to type it; a digit or a sign types it, too, while it has the
focus. One drag is one step of undo.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import chain
from typing import Any

from slimgui import imgui

from minirt.element import Element
from minirt.errors import MiniRTError
from minirt.fields import Choice, Colour, Field, Flag, MeshField, MeshFile, Paint, Picture, Three, spelled
from minirt.viewer.app.session import FINE_STEP, Session
from minirt.viewer.editing.placing import keep_standing
from minirt.viewer.editing.state import State
from minirt.viewer.editing.typed import CHARACTERS, set_typed, with_value
from minirt.viewer.editing.values import CHANNELS, Value, part_names, seen_fields, values_of_field
from minirt.viewer.files import usable_files
from minirt.viewer.language import translated
from minirt.viewer.panel.gui import GOLD, Gui

PIXELS = 6  # of a drag to the right or upwards, for one step
SLIDE = ("value slide", 0.0)  # kind and time of the changes of a drag: the constant time merges them for undo
LABEL = 0.3  # of the width: the name of a value
COLOUR_OR = "colour"  # what stands for a colour among the pictures
TO_TYPE = 3  # frames until a text has the focus, and what began it
TYPING = imgui.InputTextFlags.ENTER_RETURNS_TRUE | imgui.InputTextFlags.AUTO_SELECT_ALL
SQUARE = imgui.ColorEditFlags.NO_INPUTS | imgui.ColorEditFlags.NO_LABEL | imgui.ColorEditFlags.NO_OPTIONS


class Rows:
    """The rows of values. What the user does is applied at once to the element, which is selected by that."""

    def __init__(self, session: Session, gui: Gui) -> None:
        self.session = session
        self.gui = gui
        self.error = ("", "")  # name of the value that was refused, and why
        self.index = 0  # of the element whose rows are shown
        self._typing: Value | None = None  # the number that is typed
        self._shows_typing = False  # whether the last frame shows it
        self._text, self._first = "", ""  # what is typed, and the character that began it
        self.pressed = ""  # name of the number under the button that is down
        self._start: Element | None = None  # the element when the button went down
        self._slid = 0.0  # steps since

    @property
    def element(self) -> Element:
        """The element whose rows are shown, as it is now."""
        return self.session.state.scene.elements[self.index]

    def begin_frame(self) -> None:
        """Begin a frame: a number that is not shown any more is not typed any more."""
        if not self._first and not self._shows_typing:
            self._typing = None
        self._shows_typing = False
        self.session.slides = bool(self.pressed) and imgui.is_mouse_down(imgui.MouseButton.LEFT)

    def show(self, index: int) -> None:
        """Show the rows of the values that an element always has."""
        self.index = index
        for field in seen_fields(self.element):
            if not field.keyed or field.default is not None:
                self.show_field(field)

    def show_field(self, field: Field) -> None:
        """Show the rows of a field: one for each field of the record that is its value."""
        for value in values_of_field(field, getattr(self.element, field.name)):
            self.show_value(value)

    def show_value(self, value: Value) -> None:
        """Show the name of a value and its widgets."""
        leaf, old = value.leaf, value.get(self.element)
        if isinstance(leaf, Flag):
            if self.box(value.name, old, leaf.doc):
                self.set(value, not old)
            return
        left, width = imgui.get_cursor_pos_x(), imgui.get_content_region_avail()[0]
        imgui.push_id(value.name)
        imgui.align_text_to_frame_padding()
        imgui.text(translated(leaf.title))
        imgui.set_item_tooltip(leaf.doc + (f", in {leaf.range}" if leaf.range else ""))
        imgui.same_line(left + LABEL * width)
        room = (1 - LABEL) * width
        if isinstance(leaf, Picture | MeshField | Paint):
            self.choose_file(value, room if not isinstance(leaf, Paint) or isinstance(old, str) else 0.3 * room)
            old = value.get(self.element)
        if isinstance(leaf, Paint) and not isinstance(old, str):
            imgui.same_line()
            room *= 0.66
        if isinstance(leaf, Choice):
            if word := self.option(value.name, leaf.words, old, room):
                self.set(value, word)
        elif isinstance(leaf, Three) and not isinstance(old, str):
            self.show_triple(value, room)
        elif isinstance(old, int | float):
            self.number(value, room)
        if self.error[0].startswith(value.name):
            imgui.push_style_color(imgui.Col.TEXT, GOLD)
            imgui.text_wrapped(f"! {translated(self.error[1])}")
            imgui.pop_style_color()
        imgui.pop_id()

    def show_triple(self, value: Value, room: float) -> None:
        """Show the parts of a colour, a position or sizes beside each other, the angles of a direction below."""
        left, gap = imgui.get_cursor_pos_x(), imgui.get_style().item_inner_spacing[0]
        if isinstance(value.leaf, Colour):
            self.pick_colour(value)
            imgui.same_line(0.0, gap)
        room -= imgui.get_cursor_pos_x() - left
        for part, name in enumerate(part_names(value.leaf)):
            columns = Three.width if part < Three.width else 2
            if part == Three.width:
                imgui.set_cursor_pos_x(left)
            elif part:
                imgui.same_line(0.0, gap)
            prefix = name[:1].upper() if name in CHANNELS else name[:4]
            self.number(value._replace(channel=part), (room - (columns - 1) * gap) / columns, prefix)

    def pick_colour(self, value: Value) -> None:
        """Show a colour as a square, which opens a picker."""
        shown = tuple(part / 255 for part in value.get(self.element))
        changed, new = imgui.color_edit3(f"###{value.name} picker", shown, SQUARE)
        if changed:
            levels = tuple(round(255 * part) for part in new)
            self.change(value, self.element, lambda: value.replaced(self.element, levels))
        if imgui.is_item_deactivated():
            self.session.state = self.session.state.end_merging()

    def option(self, name: str, options: Iterable[Any], shown: Any, width: float = 0.0) -> Any:
        """Show a list, with its name unless a `width` is given; return the option that is chosen now, or None."""
        chosen = None
        imgui.set_next_item_width(width or imgui.get_content_region_avail()[0] / 2)
        if imgui.begin_combo(f"{'' if width else translated(name)}###{name}", option_title(shown)):
            for option in options:
                if imgui.selectable(option_title(option), option == shown)[0]:
                    chosen = option
            imgui.end_combo()
        return chosen

    def whole(self, name: str, number: int, high: int) -> int:
        """Show a whole number from 1 to `high`; return what it is now."""
        imgui.set_next_item_width(imgui.get_content_region_avail()[0] / 2)
        number = imgui.input_int(f"{translated(name)}###{name}", number)[1]
        return min(max(number, 1), high)

    def box(self, title: str, is_on: bool, doc: str = "", disabled: bool = False) -> bool:
        """Show a box that switches something on and off; return whether it is clicked now."""
        imgui.begin_disabled(disabled)
        clicked, _ = imgui.checkbox(f"{translated(title)}###{title} on", is_on)
        imgui.end_disabled()
        imgui.set_item_tooltip(doc)
        return bool(clicked)

    def choose_file(self, value: Value, room: float) -> None:
        """Show the list of the pictures, or meshes, beside the scene; in place of a picture there may be a colour."""
        leaf, name = value.leaf, f"{value.name} file"
        files: Iterable[Any] = usable_files(self.session.state.scene, isinstance(leaf, MeshField))
        files = chain([leaf.initial], files) if isinstance(leaf, Paint) else files
        file = self.option(name, files, value.get(self.element), room)
        if file is not None:
            self.set(value, file)

    def number(self, value: Value, width: float, prefix: str = "") -> None:
        """Show a number, which is dragged, typed or stepped."""
        if self._typing == value:
            self.type(value, width)
            return
        texts = [f"{prefix} {value.current(self.element):.{digits}g}".strip() for digits in (6, 4, 3, 2)]
        text = next((each for each in texts if imgui.calc_text_size(each)[0] < width - self.gui.size / 2), texts[-1])
        entered = imgui.button(f"{text}###{value.name}", (width, 0.0))
        imgui.set_item_tooltip(translated("drag it, or click to type it: -3, 2*3, +=1; Shift: finer"))
        if imgui.is_item_activated():
            self.pressed, self._start, self._slid = value.name, self.element, 0.0
            self.session.state = self.session.state.end_merging()
        if self.pressed == value.name:
            self.drag(value)
        if entered and not self._slid:
            self.begin_typing(value, "")
        elif imgui.is_item_focused() and self.gui.typed and self.gui.typed in CHARACTERS and not self.gui.types:
            self.begin_typing(value, self.gui.typed)
        if self.pressed == value.name and not imgui.is_item_active():
            self.pressed = ""
            self.gui.show(self.session.state.end_merging())

    def drag(self, value: Value) -> None:
        """Slide the number under the button that is down, to the right or upwards to increase it."""
        right, down = self.gui.io.mouse_delta
        if self._start and (right or down) and imgui.is_mouse_dragging(imgui.MouseButton.LEFT):
            self._slid += (right - down) / PIXELS * (FINE_STEP if self.gui.io.key_shift else 1.0)
            self.step(value, self._start, self._slid)

    def begin_typing(self, value: Value, first: str) -> None:
        """Turn a number into a text, all of it selected; `first` replaces it."""
        self._typing, self._text, self._first = value, spelled(value.current(self.element)), first or " "
        self.gui.unsettled = TO_TYPE

    def type(self, value: Value, width: float) -> None:
        """Show the text of the number that is typed; Enter, and the focus of another widget, set it."""
        if self._first:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(width)
        entered, self._text = imgui.input_text(f"###{value.name}", self._text, TYPING)
        self._shows_typing = True
        if self._first and imgui.is_item_active():
            self.gui.io.add_input_characters_utf8(self._first.strip())
            self._first = ""
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton.LEFT):
            self.gui.select_all()
        left = imgui.is_item_deactivated_after_edit() and not imgui.is_key_down(imgui.Key.KEY_ESCAPE)
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
        self.apply(lambda state: with_value(state, value, new, self.session.now), value.name)

    def apply(self, edit: Callable[[State], State], name: str = "") -> None:
        """Select the element and edit it; a change that is refused is told below the row of the value `name`."""
        state = self.session.state.with_message("")
        if state.selected != self.index:
            state = state.select(self.index)
        try:
            after = edit(state)
        except (MiniRTError, ValueError, LookupError) as error:
            after = state.with_message(str(error))
        self.error = (name, after.message) if after.message and after.scene is state.scene else ("", "")
        self.gui.show(after)


def option_title(option: Any) -> str:
    """Name of a word, a file, or a colour in place of a file, in a list."""
    return option.name if isinstance(option, MeshFile) else option if isinstance(option, str) else COLOUR_OR
