"""Add, duplicate and delete elements; add attributes (highlight, mirror, texture, ...) and remove them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import Field
from minirt.scene import Lamp
from minirt.scene.registry import ELEMENTS
from minirt.scene.writer import field_text
from minirt.shapes import Shape
from minirt.viewer.editing.adding import SIZE, addable_kinds, default_element, default_value, first_lamp
from minirt.viewer.editing.state import State, index_of, undo
from minirt.viewer.editing.values import nice_number, values

ELEMENT, ATTRIBUTE = "add", "attribute"  # what was added: kinds of changes, see `State.change`


def duplicate(state: State, _amount: float, now: float) -> State:
    """Insert a copy after the selected element, at the same position, and select it."""
    element = state.element
    # A kind that a scene has once is copied as the repeatable kind that is derived from it, if there is one.
    repeatable = [kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once]
    if not repeatable:
        return state.with_message(f"a scene has one {element.title}")
    copy = repeatable[0](**{each.name: getattr(element, each.name) for each in fields_of(type(element))})
    scene = state.scene.edit(state.selected, element, copy)
    state = state.select(state.selected).change(scene, "", now, state.selected + 1)
    return state.with_message(f"a copy of the {element.title}, at the same position")


def delete(state: State, _amount: float, now: float) -> State:
    """Delete the selected element, and select the camera."""
    element = state.element
    if element.required:
        return state.with_message(f"a scene needs its {element.title}")
    scene = state.scene.edit(state.selected)
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).with_message(f"deleted the {element.title}")


def is_adding(state: State, group: str = ELEMENT) -> bool:
    """Whether the last change added an element or an attribute, which may still be replaced by another one."""
    return state.last_change is not None and state.last_change[0] == group


def before_adding(state: State, group: str) -> State:
    """The state without the element or attribute that was just added."""
    return undo(state) if is_adding(state, group) else state


def candidates(state: State, group: str) -> list[Any]:
    """The kinds of elements that can be added, or the fields of the attributes that the selected element lacks."""
    if group == ELEMENT:
        return addable_kinds(state.scene)
    return [each for each in fields_of(type(state.element)) if each.keyed and getattr(state.element, each.name) is None]


def choices(before: State, group: str, first: int = 0, step: int = 1) -> Iterator[State]:
    """Yield the states after each candidate was added, cyclically from the one with the number `first`.

    Those that need a missing file, or cannot be so small or far away, are left out.
    """
    kinds = candidates(before, group)
    for number in [(first + step * count) % len(kinds) for count in range(len(kinds))]:
        with suppress(LookupError, ElementError):
            yield (with_element if group == ELEMENT else with_attribute)(before, kinds[number], number)


def add(group: str, step: int, state: State, _amount: float, _now: float) -> State:
    """Add an element where the state aims, of the kind that was added last, or the first missing attribute.

    Called again before another change, it replaces that by the next one (step 1) or the previous one (-1).
    """
    adding, before, first = is_adding(state, group), before_adding(state, group), 0
    if group == ELEMENT:
        first = state.kind_index + step * adding
    elif adding and state.active:
        first = candidates(before, group).index(state.active.field) + step
    nothing = state.with_message(f"{state.element.title} has no attribute that can be added")
    return next(choices(before, group, first, step), nothing)


def with_element(before: State, kind: type[Element], number: int) -> State:
    """The state with a new element, which is selected. The first shape of a scene without any lamp brings one."""
    element, last = default_element(kind, before), len(before.scene.elements) - 1
    lamps = [first_lamp(before)] if isinstance(element, Shape) and not before.scene.of(Lamp) else []
    scene = before.scene.edit(last, before.scene.elements[last], element, *lamps)
    after = replace(before, value_index=0, kind_index=number).change(scene, ELEMENT, 0.0, last + 1)
    return after.with_message(f"a new {element.title}{', and a light, since there was none' if lamps else ''}")


def with_attribute(before: State, field: Field, _number: int) -> State:
    """The state whose selected element has a new attribute, which is active."""
    changed = before.element.replace(**{field.name: default_value(field, before, nice_number(SIZE * before.size))})
    after = before.change(before.scene.edit(before.selected, changed), ATTRIBUTE, 0.0)
    index = [value.field.name for value in values(changed)].index(field.name)
    return replace(after, value_index=index).with_message(f"{field.doc}: {field_text(field, changed)}")


def remove_attribute(state: State, _amount: float, now: float) -> State:
    """Remove the attribute of the active value from the selected element."""
    active = state.active
    if active is None or not active.field.keyed:
        return state.with_message(
            f"{active.name if active else state.element.title} is no attribute that can be removed"
        )
    changed = state.element.replace(**{active.field.name: active.field.default})
    if changed == state.element:
        return state.with_message(f"{active.name} is as it is without the attribute")
    state = state.change(state.scene.edit(state.selected, changed), "", now)
    return replace(state, value_index=0).with_message(f"no {active.field.title} any more")
