"""Add, duplicate and delete elements; add attributes (highlight, mirror, texture, ...) and remove them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import Field
from minirt.scene import Lamp
from minirt.scene.registry import ELEMENTS
from minirt.scene.writer import field_text
from minirt.shapes import Shape
from minirt.viewer.editing.adding import SIZE, addable_kinds, default_element, default_value, first_lamp
from minirt.viewer.editing.state import State, index_of
from minirt.viewer.editing.values import nice_number, values

ELEMENT, ATTRIBUTE = "add", "attribute"  # what was added: kinds of changes, see `State.change`


def duplicate(state: State, _amount: float, now: float) -> State:
    """Insert a copy after the selected element, at the same position, and select it; what stands, stands on there."""
    element = state.element
    # A kind that a scene has once is copied as the repeatable kind that is derived from it, if there is one.
    repeatable = [kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once]
    if not repeatable:
        return state.with_message(f"a scene has one {element.title}")
    copy = element.as_kind(repeatable[0])
    scene = state.scene.edit(state.selected, element, copy)
    state = replace(state.change(scene, "", now, state.selected + 1), value_index=0)
    return state.with_message(f"a copy of the {element.title}, at the same position")


def delete(state: State, _amount: float, now: float) -> State:
    """Delete the selected element, and select the camera."""
    element = state.element
    if element.required:
        return state.with_message(f"a scene needs its {element.title}")
    scene = state.scene.edit(state.selected)
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).with_message(f"deleted the {element.title}")


def choices(state: State, group: str) -> Iterator[State]:
    """Yield the states after each kind of element, or each attribute that the selected element lacks, was added.

    Those that need a missing file, or cannot be so small or far away, are left out.
    """
    if group == ELEMENT:
        additions = [partial(with_element, state, kind) for kind in addable_kinds(state.scene)]
    else:
        keyed = (field for field in fields_of(type(state.element)) if field.keyed)
        absent = (field for field in keyed if getattr(state.element, field.name) is None)
        additions = [partial(with_attribute, state, field) for field in absent]
    for add in additions:
        with suppress(LookupError, ElementError):
            yield add()


def with_element(before: State, kind: type[Element]) -> State:
    """The state with a new element, which is selected. The first shape of a scene without any lamp brings one."""
    element, last = default_element(kind, before), len(before.scene.elements) - 1
    lamps = [first_lamp(before)] if isinstance(element, Shape) and not before.scene.of(Lamp) else []
    scene = before.scene.edit(last, before.scene.elements[last], element, *lamps)
    after = replace(before, value_index=0, added_kind=kind).change(scene, ELEMENT, 0.0, last + 1)
    return after.with_message(f"a new {element.title}{', and a light, since there was none' if lamps else ''}")


def with_attribute(before: State, field: Field) -> State:
    """The state whose selected element has a new attribute, which is active."""
    changed = before.element.replace(**{field.name: default_value(field, before, nice_number(SIZE * before.size))})
    after = before.change(before.scene.edit(before.selected, changed), ATTRIBUTE, 0.0)
    index = [value.field.name for value in values(changed)].index(field.name)
    return replace(after, value_index=index).with_message(f"{field.doc}: {field_text(field, changed)}")


def remove_attribute(state: State, _amount: float, now: float) -> State:
    """Remove the attribute of the active value from the selected element."""
    active = state.active
    if active is None or not active.field.keyed:
        name = active.name if active else state.element.title
        return state.with_message(f"{name} is no attribute that can be removed")
    changed = state.element.replace(**{active.field.name: active.field.default})
    if changed == state.element:
        return state.with_message(f"{active.name} is as it is without the attribute")
    state = state.change(state.scene.edit(state.selected, changed), "", now)
    return replace(state, value_index=0).with_message(f"no {active.field.title} any more")
