"""Elements: the list of all elements of the scene, and the values of the selected one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from slimgui import imgui

from minirt.element import Element, fields_of
from minirt.fields import Colour
from minirt.scene import Scene
from minirt.viewer.app.session import Session
from minirt.viewer.editing.editor import apply
from minirt.viewer.language import searchable, translated
from minirt.viewer.panel.groups import Groups
from minirt.viewer.panel.rows import Rows
from minirt.viewer.panel.style import Rgba

AROUND = 3  # rows above and below those that are seen: the arrow keys go on to them
LISTED = 0.35  # of the height: the list of elements
TOOLS = {"add": "+ Add", "duplicate": "copy", "delete": "delete"}  # actions of the buttons above the list
PLAIN = (128, 128, 128)  # the square of an element without a colour


class Elements:
    """The page of the list and of the selected element."""

    def __init__(self, session: Session, rows: Rows, groups: Groups) -> None:
        self.session = session
        self.rows = rows
        self.groups = groups
        self._wanted = ""  # what is searched for
        self._followed = -1  # the selected element that the list was scrolled to
        self._named: tuple[Scene | None, str] = None, ""  # scene and search of the next two
        self._names: list[str] = []
        self._found: Sequence[int] = ()  # indices

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
        """Show the rows of the elements that are found, as far as they are in sight."""
        state = self.session.state
        if self._named != (state.scene, self._wanted):
            self._named, self._names = (state.scene, self._wanted), names(state.scene)
            self._found = found(searchable(self._wanted), state.scene, self._names)
        indices = self._found
        if imgui.begin_child("list", (0.0, height), imgui.ChildFlags.BORDERS | imgui.ChildFlags.NAV_FLATTENED):
            if state.selected != self._followed and state.selected in indices:
                self._followed = state.selected
                place = indices.index(state.selected) * imgui.get_frame_height_with_spacing()
                imgui.set_scroll_y(max(0.0, place - height / 2))
            for place in seen(len(indices)):
                self.row(indices[place])
        imgui.end_child()

    def row(self, index: int) -> None:
        """Show an element: a box that hides it, its colour, kind and name. A click selects, two bring it into view."""
        session, state = self.session, self.session.state
        element = state.scene.elements[index]
        imgui.push_id(index)
        imgui.push_item_flag(imgui.ItemFlags.NO_TAB_STOP, True)  # Tab passes the list, the arrows go through it
        changed, _ = imgui.checkbox("###shown", index not in state.hidden)
        self.rows.gui.hint("shown while you edit; the file keeps it")
        if changed:
            self.rows.gui.show(replace(state, hidden=state.hidden ^ {index}))
        imgui.same_line()
        side = imgui.get_frame_height() * 0.7
        imgui.push_item_flag(imgui.ItemFlags.NO_NAV, True)
        picked = imgui.color_button("###colour", colour_of(element), imgui.ColorEditFlags.NO_TOOLTIP, (side, side))
        imgui.pop_item_flag()
        imgui.same_line()
        title = f"{translated(element.title)} {self._names[index]}###element"
        picked |= imgui.selectable(title, index == state.selected, imgui.SelectableFlags.ALLOW_DOUBLE_CLICK)[0]
        if picked and index != state.selected:
            self._followed = index
            self.rows.gui.show(state.with_message("").select(index))
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton.LEFT):
            self.rows.gui.show(apply(session.state, "look at", 1.0, session.now))
        imgui.pop_item_flag()
        imgui.pop_id()


def names(scene: Scene) -> list[str]:
    """Names of all elements: the comments on the lines before them."""
    pairs = pairwise(("", *scene.items))
    lines = [before if isinstance(before, str) else "" for before, item in pairs if isinstance(item, Element)]
    return [line.lstrip("# ").strip() if line.lstrip().startswith("#") else "" for line in lines]


def found(word: str, scene: Scene, names: Sequence[str]) -> Sequence[int]:
    """Indices of the elements whose kind, code or name has what is searched for."""
    titles = zip(scene.elements, names, strict=True) if word else ()
    titled = enumerate(searchable(f"{translated(each.title)} {each.code} {name}") for each, name in titles)
    return [index for index, title in titled if word in title] if word else range(len(scene.elements))


def colour_of(element: Element) -> Rgba:
    """The first colour of an element, for the square in its row."""
    found = (getattr(element, field.name) for field in fields_of(type(element)) if isinstance(field, Colour))
    red, green, blue = next((each for each in found if isinstance(each, tuple)), PLAIN)
    return red / 255, green / 255, blue / 255, 1.0


def seen(count: int) -> Iterator[int]:
    """Yield the numbers of the rows in sight, between empty space in place of the others."""
    top, scrolled, height = imgui.get_cursor_pos_y(), imgui.get_scroll_y(), imgui.get_frame_height_with_spacing()
    first = max(0, int(scrolled / height) - AROUND)
    imgui.set_cursor_pos_y(top + first * height)
    yield from range(first, min(count, int((scrolled + imgui.get_window_height()) / height) + 1 + AROUND))
    imgui.set_cursor_pos_y(top + count * height)
    imgui.dummy((0.0, 0.0))
