"""Groups: the values of an element in groups that fold, and the boxes that switch its attributes on and off.

Dear ImGui remembers for each name of a group whether it is folded, for all elements, as long as the window is open.
"""

from __future__ import annotations

from collections.abc import Iterator

from slimgui import imgui

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import Angle, Colour, Direction, Field, Point
from minirt.scene import Camera, Scene
from minirt.scene.value_reader import lacked_by
from minirt.viewer.editing import structure
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import seen_fields
from minirt.viewer.language import translated
from minirt.viewer.panel.rows import Rows
from minirt.viewer.panel.style import BOX, BOX_UNDER_POINTER, LIST, rgba

PLACE, SIZE, COLOUR, LENS, SURFACE, PICTURES = GROUPS = ("place", "size", "colour", "lens", "surface", "pictures")
FOLDED = (SURFACE, PICTURES)  # at first
NAMED = {"roll": PLACE, "brightness": COLOUR, "uv": PICTURES}  # groups of fields whose types do not tell them


class Groups:
    """The values of an element, below the names of their groups."""

    def __init__(self, rows: Rows) -> None:
        self.rows = rows
        self._asked: tuple[Scene | None, int] = None, -1  # scene and index of the element whose reasons are known
        self._reasons: dict[str, str] = {}  # why attributes cannot be had, by their names

    def show(self, index: int) -> None:
        """Show the values of the element `index`, by their groups; the name of an only group is not shown."""
        self.rows.index = index
        kind = type(self.rows.element)
        groups: dict[str, list[Field]] = {}
        for field in seen_fields(self.rows.element):
            groups.setdefault(group_of(kind, field), []).append(field)
        for name in (each for each in GROUPS if each in groups):
            if len(groups) == 1 or self.is_unfolded(name, groups[name]):
                for field in groups[name]:
                    if is_optional(field):
                        self.attribute(field)
                    else:
                        self.rows.show_field(field)

    def is_unfolded(self, name: str, fields: list[Field]) -> bool:
        """Show the name of a group, with the attributes that the element has; return whether the group is unfolded."""
        element = self.rows.element
        there = [each.title for each in fields if is_optional(each) and getattr(element, each.name) is not None]
        title = translated(name) + (f": {', '.join(map(translated, there))}" if there else "")
        flags = imgui.TreeNodeFlags.NONE if name in FOLDED else imgui.TreeNodeFlags.DEFAULT_OPEN
        colours = {imgui.Col.HEADER: LIST, imgui.Col.HEADER_HOVERED: BOX_UNDER_POINTER, imgui.Col.HEADER_ACTIVE: BOX}
        for part, colour in colours.items():  # unlike a chosen row, which Dear ImGui gives the same colours
            imgui.push_style_color(part, rgba(colour))
        imgui.push_item_flag(imgui.ItemFlags.NO_TAB_STOP, True)  # Tab goes from value to value
        unfolded = imgui.collapsing_header(f"{title}###{name} group", flags=flags)[0]
        imgui.pop_item_flag()
        imgui.pop_style_color(len(colours))
        return bool(unfolded)

    def attribute(self, field: Field) -> None:
        """Show the box of an attribute; below it the reason why the element cannot have it or why it has no effect, and
        its rows if the element has it. A click on the box adds or removes the attribute."""
        there = getattr(self.rows.element, field.name) is not None
        lacked = lacked_by(self.rows.element, field)
        if lacked:
            names = f" {translated('or')} ".join(translated(each.replace("_", " ")) for each in lacked)
            reason = f"{translated('no effect without')} {names}"
        else:
            reason = "" if there else translated(self.reasons().get(field.name, ""))
        changed = self.rows.box(field.title, there, field.doc, disabled=bool(reason) and not there)
        if reason:
            self.rows.gui.go_on(imgui.calc_text_size(reason)[0])
            imgui.push_style_color(imgui.Col.TEXT, imgui.get_style().colors[imgui.Col.TEXT_DISABLED])
            imgui.text_wrapped(reason)
            imgui.pop_style_color()
        if changed:
            switch = structure.without_attribute if there else structure.with_attribute
            self.rows.apply(lambda state: switch(state, field).end_merging(), field.title)
        elif there:
            imgui.indent()
            imgui.begin_disabled(bool(lacked))
            self.rows.show_field(field)
            imgui.end_disabled()
            imgui.unindent()

    def reasons(self) -> dict[str, str]:
        """Why attributes cannot be had, by their names; as it was at the press while a number is dragged."""
        asked = self.rows.session.state.scene, self.rows.index
        if self._asked != asked and not self.rows.pressed:
            self._asked = asked
            self._reasons = dict(refusals(self.rows.session.state.select(self.rows.index)))
        return self._reasons


def group_of(kind: type[Element], field: Field) -> str:
    """The group of a field of a kind of elements: its name tells it, or its type."""
    if field.name in NAMED:
        return NAMED[field.name]
    if isinstance(field, Point | Direction | Angle):
        return PLACE
    if field.mapped:
        return PICTURES
    if field.sort == "shapes":
        return SURFACE
    if isinstance(field, Colour):
        return COLOUR
    return LENS if issubclass(kind, Camera) else SIZE


def is_optional(field: Field) -> bool:
    """Whether a field is an attribute that an element may have or not."""
    return field.keyed and field.default is None


def refusals(state: State) -> Iterator[tuple[str, str]]:
    """Yield the names of the attributes that the selected element cannot have, and why."""
    for field in filter(is_optional, fields_of(type(state.element))):
        try:
            structure.with_attribute(state, field)
        except (LookupError, ElementError) as error:
            yield field.name, str(error)
