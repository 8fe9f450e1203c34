"""Elements: the list of all elements of the scene, and the values of the selected one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from slimgui import imgui

from minirt.mlx import Modifier
from minirt.scene import Camera, Scene
from minirt.scene.names import COUNTED_AS, element_name, numbered_kind, own_name
from minirt.viewer.app.session import Session
from minirt.viewer.editing import structure
from minirt.viewer.editing.colours import own_colour
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.selection import look_through
from minirt.viewer.language import searchable, translated
from minirt.viewer.panel.groups import Groups
from minirt.viewer.panel.numbers import TO_TYPE, TYPING
from minirt.viewer.panel.rows import Rows

AROUND = 3  # rows above and below those that are seen: the arrow keys go on to them
LISTED = 0.35  # of the height: the list of elements
TOOLS = {"add": "+ Add", "duplicate": "copy", "delete": "delete"}  # actions of the buttons above the list
SQUARE = 0.7  # of the height of a row: the side of the square with an element's colour
PLAIN = (128, 128, 128)  # the square of an element without a colour


class Elements:
    """The page of the list and of the selected element."""

    def __init__(self, session: Session, rows: Rows, groups: Groups) -> None:
        self.session = session
        self.rows = rows
        self.groups = groups
        self._wanted = ""  # what is searched for
        self._followed = -1  # the selected element that the list was scrolled to
        self._searched: tuple[Scene | None, str] = None, ""  # scene and search of the next one
        self._found: Sequence[int] = ()  # indices
        self._pointed: int | None = None  # index of the element whose row the pointer is on
        self._naming: int | None = None  # index of the element whose name is typed
        self._name, self._naming_since = "", 0.0  # what is typed, and the time in seconds
        self._takes_focus = False  # whether the text of the name has still to get the focus

    def show(self) -> None:
        """Show the list, and below it the rows of the selected element."""
        self.rows.gui.buttons(TOOLS)
        hint = translated("search")
        self.rows.gui.go_on(2 * imgui.calc_text_size(hint)[0])
        imgui.set_next_item_width(-1.0)
        self._wanted = imgui.input_text_with_hint("###search", hint, self._wanted)[1]
        height = imgui.get_content_region_avail()[1]
        self.list(LISTED * height)
        if imgui.begin_child("values", (0.0, 0.0), imgui.ChildFlags.NAV_FLATTENED):
            state = self.session.state
            imgui.separator_text(translated(state.element.title))
            self.groups.show(state.selected)
        imgui.end_child()

    def list(self, height: float) -> None:
        """Show the rows of the elements that are found, as far as they are in sight, in a list `height` pixels high.
        The list is scrolled to an element that was selected since the last frame."""
        state = self.session.state
        if self._searched != (state.scene, self._wanted):
            self._searched = state.scene, self._wanted
            self._found = found(searchable(self._wanted), state.scene)
        indices = self._found
        self._pointed = None
        if imgui.begin_child("list", (0.0, height), imgui.ChildFlags.BORDERS | imgui.ChildFlags.NAV_FLATTENED):
            if state.selected != self._followed and state.selected in indices:
                # The height of a list that appears is known in its second frame alone: then it is scrolled again.
                self._followed = -1 if imgui.is_window_appearing() else state.selected
                row_height = imgui.get_frame_height_with_spacing()
                end = len(indices) * row_height - imgui.get_content_region_avail()[1]
                imgui.set_scroll_y(max(0.0, min(indices.index(state.selected) * row_height - height / 2, end)))
                self.rows.gui.unsettled = max(self.rows.gui.unsettled, 1)  # Dear ImGui scrolls in the next frame
            for place in seen(len(indices)):
                self.row(indices[place])
        imgui.end_child()
        if self.session.screen.pointed != self._pointed:
            self.session.screen.pointed = self._pointed
            self.rows.gui.show(self.session.state)

    def row(self, index: int) -> None:
        """Show the row of an element: a box that hides it, its colour and its name. The box acts on all selected
        elements if this is one of them. `_pointed` notes the row under the pointer."""
        state = self.session.state
        element = state.scene.elements[index]
        imgui.push_id(index)
        imgui.push_item_flag(imgui.ItemFlags.NO_TAB_STOP, True)  # Tab passes the list, the arrows go through it
        imgui.begin_group()
        imgui.begin_disabled(isinstance(element, Camera))  # no picture is without one
        changed, _ = imgui.checkbox("###shown", index not in state.hidden)
        imgui.end_disabled()
        self.rows.gui.hint("shown while you edit; the file keeps it")
        if changed:
            switched = state.chosen if index in state.chosen else {index}
            switched = {each for each in switched if not isinstance(state.scene.elements[each], Camera)}
            hidden = state.hidden - switched if index in state.hidden else state.hidden | switched
            self.rows.gui.show(replace(state, hidden=hidden))
        imgui.same_line()
        side = SQUARE * imgui.get_frame_height()
        imgui.push_item_flag(imgui.ItemFlags.NO_NAV, True)
        red, green, blue = (level / 255 for level in own_colour(element) or PLAIN)
        if imgui.color_button("###colour", (red, green, blue, 1.0), imgui.ColorEditFlags.NO_TOOLTIP, (side, side)):
            self.pick(index)
        imgui.pop_item_flag()
        imgui.same_line()
        if index == self._naming:
            self.type_name(index)
        else:
            self.show_name(index)
        imgui.end_group()
        if imgui.is_item_hovered():
            self._pointed = index
        imgui.pop_item_flag()
        imgui.pop_id()

    def show_name(self, index: int) -> None:
        """Show the name of an element, and its kind, if that is not its name, at the right.

        A click selects the element, or with Shift or Ctrl adds it to the selection or removes it. A click on the only
        selected element begins to rename it. A double click brings it into view, or looks through a camera.
        """
        session, state = self.session, self.session.state
        name, kind = element_name(state.scene, index, translated), numbered_kind(state.scene, index, translated)
        flags = imgui.SelectableFlags.ALLOW_DOUBLE_CLICK
        right = imgui.get_cursor_pos_x() + imgui.get_content_region_avail()[0]  # border of the list, in pixels
        picked = imgui.selectable(f"{name}###element", index in state.chosen, flags)[0]
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton.LEFT):
            self.visit(index)
        elif picked and state.chosen == {index} and not session.modifiers:
            # From the next frame on `type_name` shows a field in place of this row, until a second click comes soon.
            self._naming, self._name, self._takes_focus = index, own_name(state.element), True
            self._naming_since = session.now
            self.rows.gui.unsettled = TO_TYPE  # frames until the field takes keys
        elif picked:
            self.pick(index)
        if kind != name:
            imgui.same_line(right - imgui.calc_text_size(kind)[0])
            imgui.text_disabled(kind)

    def pick(self, index: int) -> None:
        """Select an element, with Shift or Ctrl beside others."""
        state, self._followed = self.session.state.with_message(""), index
        adds = bool(self.session.modifiers & (Modifier.SHIFT | Modifier.ACCEL))
        self.rows.gui.show(state.add_or_remove(index) if adds else state.select(index))

    def visit(self, index: int) -> None:
        """Look through a camera; bring any other element, and the camera in view, to where they are seen well."""
        session, state = self.session, self.session.state.select(index)
        is_further = isinstance(state.element, Camera) and state.element is not state.scene.camera
        after = look_through(state, index, session.now) if is_further else apply(state, "look at", 1.0, session.now)
        self.rows.gui.show(after)

    def type_name(self, index: int) -> None:
        """Show the name that is typed; Enter, and the focus of another widget, give it to the element.

        If the click that began the typing was the first of a double click, typing ends without a change, and the
        element is brought into view.
        """
        if self._takes_focus:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1.0)
        entered, self._name = imgui.input_text("###name", self._name, TYPING)
        is_double = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton.LEFT)
        if is_double and self.session.now - self._naming_since < self.rows.gui.io.mouse_double_click_time:
            self._naming = None
            self.visit(index)
            return
        if self._takes_focus and imgui.is_item_active():
            self._takes_focus = False
        left = imgui.is_item_deactivated_after_edit() and not imgui.is_key_down(imgui.Key.KEY_ESCAPE)
        if entered or left:
            self.rows.gui.show(structure.rename(self.session.state.select(index), self._name))
        if entered or (not self._takes_focus and not imgui.is_item_active()):
            self._naming = None


def found(word: str, scene: Scene) -> Sequence[int]:
    """Return the indices of the elements that contain `word`, in small letters without accents; all if it is empty.

    Searched are the kind and number of an element, its code, its own name, and the last comment above it.
    """
    if not word:
        return range(len(scene.elements))
    indices, numbers, comment = list[int](), Counter[str](), ""
    for item in scene.items:
        if isinstance(item, str):
            comment = item
            continue
        kind = COUNTED_AS.get(type(item), type(item)).title
        numbers[kind] += 1
        title = f"{translated(kind)} {numbers[kind]}"
        if word in searchable(f"{title} {item.code} {own_name(item)} {comment}"):
            indices.append(numbers.total() - 1)
    return indices


def seen(count: int) -> Iterator[int]:
    """Yield the numbers of the rows in sight, between empty space in place of the others."""
    top, scrolled, height = imgui.get_cursor_pos_y(), imgui.get_scroll_y(), imgui.get_frame_height_with_spacing()
    first = max(0, int(scrolled / height) - AROUND)
    imgui.set_cursor_pos_y(top + first * height)
    yield from range(first, min(count, int((scrolled + imgui.get_window_height()) / height) + 1 + AROUND))
    imgui.set_cursor_pos_y(top + count * height)
    imgui.dummy((0.0, 0.0))
