"""Add, duplicate and delete elements; add attributes (highlight, mirror, texture, ...) and remove them.

New elements and attributes are made from tables of fields alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import copysign

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import Field, MeshField, Triple
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Lamp, Scene
from minirt.scene.names import element_name, named_block, own_name, renamed
from minirt.scene.registry import ELEMENTS
from minirt.scene.writer import field_text
from minirt.shapes import Shape
from minirt.shapes.shape import union_of_bounds
from minirt.viewer.editing.defaults import SIZE, default_element, default_value, first_lamp
from minirt.viewer.editing.projection import field_names
from minirt.viewer.editing.rigid import shifted
from minirt.viewer.editing.state import Snapshot, State, can_edit, index_of
from minirt.viewer.editing.values import nice_number, position_value, round_point, values
from minirt.viewer.language import GAP

ELEMENT, ATTRIBUTE = "add", "attribute"  # what was added: kinds of changes, see `State.change`
FURTHER = "further "  # begins the titles of lights and cameras after the first
APART = 1.2  # breadths of selected shapes from their middle to that of their copies


def duplicate(state: State, _amount: float, now: float) -> State:
    """Insert a copy after each selected element, and select the copies, which are beside the originals.

    The first value is active or, if that has three numbers, the position, so that three typed numbers are the position.
    A message says if a scene cannot have another element of a kind.
    """
    scene, copies, way = state.scene, dict[int, Element](), way_beside(state)
    for index in sorted(state.chosen, reverse=True):
        element = state.scene.elements[index]
        # A kind that a scene has once is copied as the repeatable kind that is derived from it, if there is one.
        repeatable = [kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once]
        if not repeatable:
            return state.with_message(f"a scene has one {element.title}")
        copies[index] = shifted(element.as_kind(repeatable[0]), way)
        scene = scene.edit(index, element, copies[index])
    what = names_of_chosen(state)
    others = frozenset(index_of(scene, copies[index]) for index in state.others)
    state = state.change(scene, "", now, index_of(scene, copies[state.selected]))
    state = replace(state, others=others, value_index=0)
    place = position_value(state.element)
    if place and isinstance(state.active.get(state.element), tuple):
        state = state.with_active(place)
    message = f"a copy of {what}, beside the original" if any(way) else f"a copy of {what}, at the same position"
    if place and not others:
        also = "" if state.active == place else f"{GAP}or press = and type {state.active.name}, Tab, x y z"
        message += f"{GAP}press = and type x y z: its position{also}"
    return state.with_message(message)


def way_beside(state: State) -> Triple:
    """Return the way that takes the selected shapes beside themselves: to the right in the picture, along x or z.

    It is APART times as long as their common box is wide, a tenth of a stride at least; 0 if no shape has bounds.
    """
    chosen = [state.scene.elements[index] for index in state.chosen]
    boxes = [box for each in chosen if isinstance(each, Shape) and (box := each.bounds())]
    if not boxes:
        return 0.0, 0.0, 0.0
    least, greatest = union_of_bounds(*boxes)
    right, _, _ = camera_frame(state.scene.camera)
    axis = 0 if abs(right[0]) >= abs(right[2]) else 2
    length = copysign(max(APART * (greatest[axis] - least[axis]), state.stride / 10), right[axis])
    x, _, z = round_point((length, 0.0, length), state.stride)
    return (x, 0.0, 0.0) if axis == 0 else (0.0, 0.0, z)


def delete(state: State, _amount: float, now: float) -> State:
    """Delete the selected elements, and select the camera."""
    elements = [state.scene.elements[index] for index in state.chosen]
    for element in elements:
        if element.required:
            return state.with_message(f"a scene needs its {element.title}")
    what = names_of_chosen(state)
    scene = state.rest
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).with_message(f"deleted {what}")


def rename(state: State, name: str) -> State:
    """Give the selected element a name, which its line has in a comment; without one it is called as if it had none."""
    element = renamed(state.element, name)
    if own_name(element) == own_name(state.element):
        return state
    state = state.change(state.scene.edit(state.selected, element), "", 0.0)
    return state.with_message(f"name: {element_name(state.scene, state.selected)}")


def names_of_chosen(state: State | Snapshot) -> str:
    """The name of the selected element, or the number of selected elements."""
    return f"{len(state.others) + 1} elements" if state.others else element_name(state.scene, state.selected)


def choices(state: State, group: str) -> Iterator[tuple[str, State]]:
    """Yield a title, and the state after adding, for each kind of element, or each attribute of the selected element.

    `group`: ELEMENT or ATTRIBUTE. What needs a missing file, or cannot be so small or far away, is left out. An
    attribute that is there stays as it is, and its value becomes active.
    """
    if group == ELEMENT:
        kinds = addable_kinds(state.scene)  # never a first and a further light at once: titles are unique
        ways = [(kind.title.removeprefix(FURTHER), partial(with_element, state, kind)) for kind in kinds]
    else:
        fields = [each for each in fields_of(type(state.element)) if each.keyed and each.default is None]
        ways = [(field.title, partial(with_attribute, state, field)) for field in fields]
    for title, add in ways:
        with suppress(LookupError, ElementError):
            yield title, add()


def with_element(before: State, kind: type[Element]) -> State:
    """The state with a new element, which is selected. The first shape of a scene without any lamp brings one."""
    element, last = default_element(kind, before), len(before.scene.elements) - 1
    lamps = [first_lamp(before)] if isinstance(element, Shape) and not before.scene.of(Lamp) else []
    apart = [""] if named_block(before.scene, last)[0] else []  # a blank line, so that it is not named like those above
    scene = before.scene.edit(last, before.scene.elements[last], *apart, element, *lamps)
    after = replace(before, value_index=0, added_kind=kind).change(scene, ELEMENT, 0.0, last + 1)
    return after.with_message(f"a new {element.title}{', and a light, since there was none' if lamps else ''}")


def with_attribute(before: State, field: Field) -> State:
    """The state whose selected element has an attribute, which is active: a new one, unless it is there."""
    if getattr(before.element, field.name) is not None:
        return replace(before.with_active(field), last_change=(ATTRIBUTE, 0.0))
    changed = before.element.replace(**{field.name: default_value(field, before, nice_number(SIZE * before.size))})
    after = before.change(before.scene.edit(before.selected, changed), ATTRIBUTE, 0.0)
    index = [value.field.name for value in values(changed)].index(field.name)
    return replace(after, value_index=index).with_message(f"{field.doc}: {field_text(field, changed)}")


def present(before: State, choice: State) -> str:
    """The value of an attribute that is there before it is chosen; nothing for any other choice."""
    is_there = choice.scene is before.scene and choice.last_change == (ATTRIBUTE, 0.0)
    return field_text(choice.active.field, choice.element).partition(":")[2] if is_there else ""


def remove_attribute(state: State, _amount: float, _now: float) -> State:
    """Remove the attribute of the active value from the selected element."""
    active = state.active
    if not active.field.keyed:
        return state.with_message(f"{state.element.title} needs its {active.name}")
    after = without_attribute(state, active.field)
    if after.element == state.element:
        return state.with_message(f"{active.name} has its usual value: there is nothing to remove")
    return after.with_message(f"no {active.field.title} any more")


def without_attribute(before: State, field: Field) -> State:
    """The state whose selected element has lost an attribute, or has its default again."""
    changed = before.element.replace(**{field.name: field.default})
    return replace(before.change(before.scene.edit(before.selected, changed), "", 0.0), value_index=0)


# Default values.


def addable_kinds(scene: Scene) -> list[type[Element]]:
    """Kinds of elements that can be added to a scene: shapes first, kinds made from a mesh file last.

    Left out are kinds of which a scene has one and has it already.
    """
    there = {type(each) for kind in ELEMENTS.values() if kind.once for each in scene.of(kind)}
    missing = [kind for kind in ELEMENTS.values() if can_edit(kind) and not (kind.once and kind in there)]
    return sorted(missing, key=lambda kind: (bool(field_names(kind, MeshField)), not issubclass(kind, Shape)))
