"""Rows: widgets for the values of an element, chosen by the types of its declared fields alone."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain
from typing import Any

from slimgui import imgui

from minirt.errors import FieldError, quoted
from minirt.fields import Choice, Colour, Field, Flag, MeshField, MeshFile, Paint, Picture, Three
from minirt.viewer.editing.colours import COLOURS
from minirt.viewer.editing.typed import with_value
from minirt.viewer.editing.values import ANGLES, CHANNELS, Value, part_names, values_of_field
from minirt.viewer.files import usable_files
from minirt.viewer.language import translated
from minirt.viewer.panel.numbers import TYPING, Numbers
from minirt.viewer.panel.style import GOLD, TEXT, rgba

ALL_THREE = "1 2 3"  # beside the name of three numbers while one of them is typed, as all can be typed at once
LABEL = 0.3  # of the width: the name of a value
COLOUR_OR = "colour"  # what stands for a colour among the pictures
HEX = re.compile("#?([0-9a-fA-F]{6})")
SWATCHES = 10  # in a line
PICKER = imgui.ColorEditFlags.NO_INPUTS | imgui.ColorEditFlags.NO_SIDE_PREVIEW | imgui.ColorEditFlags.NO_LABEL
SELECTED = imgui.InputTextFlags.AUTO_SELECT_ALL


class Rows(Numbers):
    """The rows of values."""

    def show_field(self, field: Field) -> None:
        """Show the rows of a field: one for each field of the record that is its value."""
        for value in values_of_field(field, getattr(self.element, field.name)):
            self.show_value(value)

    def show_value(self, value: Value) -> None:
        """Show the name of a value and its widgets: a box, or a list of files or words, numbers or a colour."""
        leaf, old = value.leaf, value.get(self.element)
        if isinstance(leaf, Flag):
            if self.box(value.name, old, leaf.doc):
                self.set(value, not old)
            return
        left, width = imgui.get_cursor_pos_x(), imgui.get_content_region_avail()[0]
        imgui.push_id(f"{self.index} {value.name}")  # what is typed is that of no other element
        self.show_label(value, width)
        room = (1 - LABEL) * width
        imgui.set_cursor_pos_x(left + LABEL * width)
        if isinstance(leaf, Picture | MeshField | Paint):
            self.choose_file(value, room)
            old = value.get(self.element)  # the choice may have changed it
        if isinstance(leaf, Paint) and not isinstance(old, str):  # a colour in place of a picture
            imgui.set_cursor_pos_x(left + LABEL * width)
        if isinstance(leaf, Choice):
            if word := self.option(value.name, leaf.words, old, room):
                self.set(value, word)
        elif isinstance(leaf, Three) and not isinstance(old, str):
            self.show_triple(value, room)
        elif isinstance(old, int | float):
            self.number(value, room)
        imgui.pop_id()

    def show_label(self, value: Value, width: float) -> None:
        """Show the name of a value in a row of a width; its widgets follow beside it, or below a name that is too long.
        A value that was refused is marked, and the reason is shown under the pointer."""
        leaf = value.leaf
        imgui.align_text_to_frame_padding()
        title = translated(leaf.title)
        longer = f"{title}: {ALL_THREE}"
        if self.typing == (self.index, value) and imgui.calc_text_size(longer)[0] < LABEL * width:
            title = longer
        index, name, reason = self.error
        is_refused = index == self.index and name.startswith(value.name)
        imgui.push_style_color(imgui.Col.TEXT, rgba(GOLD if is_refused else TEXT))
        imgui.text(f"! {title}" if is_refused else title)
        imgui.pop_style_color()
        if is_refused:
            self.gui.hint(reason)
        else:
            self.gui.hint(leaf.doc, leaf.range)
        if imgui.get_item_rect_size()[0] < LABEL * width:
            imgui.same_line()

    def show_triple(self, value: Value, room: float) -> None:
        """Show the parts of a colour, a position or sizes beside each other, in `room` pixels. The two angles of a
        direction are on a line of their own below its components."""
        left, gap = imgui.get_cursor_pos_x(), imgui.get_style().item_inner_spacing[0]
        if isinstance(value.leaf, Colour):
            self.pick_colour(value)
            imgui.same_line(0.0, gap)
        room -= imgui.get_cursor_pos_x() - left
        for part, name in enumerate(part_names(value.leaf)):
            columns = Three.width if part < Three.width else len(ANGLES)
            if part == Three.width:  # the first angle
                imgui.set_cursor_pos_x(left)
            elif part:
                imgui.same_line(0.0, gap)
            prefix = name[:1].upper() if name in CHANNELS else translated(name)[:4]
            self.number(value._replace(channel=part), (room - (columns - 1) * gap) / columns, prefix)

    def pick_colour(self, value: Value) -> None:
        """Show a colour as a square; a click opens a picker, colours with names, and the hexadecimal spelling. Changes
        by the picker that follow each other are undone together."""
        colour = value.get(self.element)
        red, green, blue = (part / 255 for part in colour)
        side = imgui.get_frame_height()
        if imgui.color_button(f"###{value.name} picker", (red, green, blue, 1.0), size=(side, side)):
            imgui.open_popup("picker")
        if not imgui.begin_popup("picker"):
            return
        changed, new = imgui.color_picker3(f"###{value.name} mixer", (red, green, blue), PICKER)
        if changed:
            levels = tuple(round(255 * part) for part in new)
            self.change(value, self.element, lambda: value.replaced(self.element, levels))
        if imgui.is_item_deactivated():
            self.session.state = self.session.state.end_merging()
        self.swatches(value, imgui.get_item_rect_size()[0])
        entered, text = imgui.input_text(f"hex###{value.name} hex", bytes(colour).hex().upper(), TYPING)
        if entered or imgui.is_item_deactivated_after_edit():
            self.apply(lambda state: with_value(state, value, lambda *_: levels_of(text), self.session.now), value.name)
        imgui.end_popup()

    def swatches(self, value: Value, width: float) -> None:
        """Show the colours that have a name, in lines `width` pixels wide; a click sets one and closes the picker."""
        side = width / SWATCHES
        imgui.push_style_var(imgui.StyleVar.ITEM_SPACING, (0.0, 0.0))
        for number, (word, levels) in enumerate(COLOURS.items()):
            if number % SWATCHES:
                imgui.same_line()
            red, green, blue = (level / 255 for level in levels)
            flags = imgui.ColorEditFlags.NO_TOOLTIP
            if imgui.color_button(f"###{value.name} {word}", (red, green, blue, 1.0), flags, (side, side)):
                self.set(value, levels)
                imgui.close_current_popup()
            self.gui.hint(word)
        imgui.pop_style_var()

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
        number = imgui.input_int(f"{translated(name)}###{name}", number, flags=SELECTED)[1]
        return min(max(number, 1), high)

    def box(self, title: str, is_on: bool, doc: str = "", disabled: bool = False) -> bool:
        """Show a box that switches something on and off; return whether it is clicked now."""
        imgui.begin_disabled(disabled)
        clicked, _ = imgui.checkbox(f"{translated(title)}###{title} on", is_on)
        imgui.end_disabled()
        self.gui.hint(doc)
        return bool(clicked)

    def choose_file(self, value: Value, room: float) -> None:
        """Show the list of the pictures, or meshes, beside the scene; in place of a picture there may be a colour."""
        leaf, name = value.leaf, f"{value.name} file"
        files: Iterable[Any] = usable_files(self.session.state.scene, isinstance(leaf, MeshField))
        files = chain([leaf.initial], files) if isinstance(leaf, Paint) else files
        file = self.option(name, files, value.get(self.element), room)
        if file is not None:
            self.set(value, file)


def option_title(option: Any) -> str:
    """Name of a word, a file, or a colour in place of a file, in a list."""
    if isinstance(option, MeshFile):
        return option.name
    return option if isinstance(option, str) else translated(COLOUR_OR)


def levels_of(text: str) -> tuple[int, ...]:
    """Red, green and blue of a hexadecimal spelling, such as FF8000; FieldError for any other text."""
    if spelled := HEX.fullmatch(text.strip()):
        return tuple(bytes.fromhex(spelled[1]))
    raise FieldError(f"must be six digits from 0 to F, got {quoted(text)}")
