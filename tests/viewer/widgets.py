"""Widgets of the panel: where those of the last frame are, by their names, and which one has the focus.

The calls of Dear ImGui are wrapped, so that the panel itself notes nothing. The name of a widget is what follows ### in
its label. In an open list it follows the name of the list, and in the row of an element its index comes after it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from slimgui import imgui

NAMED = "button", "checkbox", "selectable", "input_text", "input_text_with_hint", "input_int", "color_button"
GROUPS = ("collapsing_header",)
TABS = "begin_tab_item", "tab_item_button"


class Widgets:
    """The widgets of the last frame of any panel of this process."""

    def __init__(self) -> None:
        self.places: dict[str, tuple[float, float]] = {}  # their centres
        self.focused = ""
        self._list = ""  # the one that is open
        self._index = ""  # of the element whose row is made
        for name in (*NAMED, *TABS, *GROUPS):
            follow(name, lambda _, label, *__: self.note(label))
        follow("begin_combo", lambda is_open, label, *_: self.open(label) if is_open else self.note(label))
        follow("end_combo", lambda _: self.open(""))
        follow("push_id", lambda _, identity: setattr(self, "_index", identity if isinstance(identity, int) else ""))
        follow("pop_id", lambda _: setattr(self, "_index", ""))
        follow("new_frame", lambda _: self.places.clear())

    def open(self, label: str) -> None:
        """A list opens, or the one that is open ends."""
        self._list = label.rsplit("###", maxsplit=1)[-1]

    def note(self, label: str) -> None:
        """Note where the last widget is."""
        words = self._list, label.rsplit("###", maxsplit=1)[-1], self._index
        name = " ".join(str(word) for word in words if word != "")
        (left, top), (right, bottom) = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        self.places[name] = (left + right) / 2, (top + bottom) / 2
        if imgui.is_item_focused():
            self.focused = name


def follow(name: str, note: Callable[..., None]) -> None:
    """Call `note` after each call of a function of Dear ImGui, with its result and its arguments."""
    function = getattr(imgui, name)

    def followed(*arguments: Any, **options: Any) -> Any:
        result = function(*arguments, **options)
        note(result, *arguments)
        return result

    setattr(imgui, name, followed)


WIDGETS = Widgets()
