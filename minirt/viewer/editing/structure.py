"""Add, duplicate and delete elements; add attributes (highlight, mirror, texture, ...) and remove them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
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
from minirt.viewer.editing.adding import addable_kinds, default_element, default_value, first_lamp
from minirt.viewer.editing.state import State, index_of, undo
from minirt.viewer.editing.values import values

ELEMENT, ATTRIBUTE = "add", "attribute"  # what was added: kinds of changes, see `State.change`


def duplicate(state: State, _amount: float, now: float) -> State:
    """Insert a copy after the selected element, at the same position, and select it."""
    element = state.element
    copy = copy_element(element)
    if copy is None:
        return state.with_message(f"a scene has one {element.title}")
    scene = state.scene.edit(state.selected, element, copy)
    state = state.select(state.selected).change(scene, "", now, state.selected + 1)
    return state.with_message(f"a copy of the {element.title}, at the same position")


def copy_element(element: Element) -> Element | None:
    """Copy an element. A kind that a scene has once is copied as its derived repeatable kind; None without one."""
    repeatable = (kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once)
    kind = next(repeatable, None)
    return kind(**{each.name: getattr(element, each.name) for each in fields_of(type(element))}) if kind else None


def delete(state: State, _amount: float, now: float) -> State:
    """Delete the selected element, and select the camera."""
    element = state.element
    if element.required:
        return state.with_message(f"a scene needs its {element.title}")
    scene = state.scene.edit(state.selected)
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).with_message(f"deleted the {element.title}")


def default_elements(kinds: list[type[Element]], numbers: Iterable[int], state: State) -> Iterator[tuple[int, Element]]:
    """Yield default elements of the kinds with these numbers; kinds that need a missing file, or cannot be so small or
    far away, are skipped."""
    for number in numbers:
        with suppress(LookupError, ElementError):
            yield number, default_element(kinds[number], state)


def is_adding(state: State, kind: str = ELEMENT) -> bool:
    """Whether the last change added an element or an attribute, which may still be replaced by another one."""
    return state.last_change is not None and state.last_change[0] == kind


def before_adding(state: State, kind: str = ELEMENT) -> State:
    """The state without the element or attribute that was just added."""
    return undo(state) if is_adding(state, kind) else state


def add(step: int, state: State, _amount: float, now: float) -> State:
    """Add an element where the state aims, of the kind that was added last, and select it.

    Called again before another change, it replaces that element by one of the next (step 1) or previous (-1) kind.
    """
    before = before_adding(state)
    kinds = addable_kinds(before.scene)
    numbers = [(state.kind_index + step * (is_adding(state) + skipped)) % len(kinds) for skipped in range(len(kinds))]
    number, element = next(default_elements(kinds, numbers, before))
    return added(before, number, element, now)


def added(before: State, number: int, element: Element, now: float) -> State:
    """The state with a new element, which is selected. The first shape of a scene without any lamp brings one."""
    last = len(before.scene.elements) - 1
    lamps = [first_lamp(before)] if isinstance(element, Shape) and not before.scene.of(Lamp) else []
    scene = before.scene.edit(last, before.scene.elements[last], element, *lamps)
    after = replace(replace(before, value_index=0).change(scene, ELEMENT, now, last + 1), kind_index=number)
    return after.with_message(f"a new {element.title}{', and a light, since there was none' if lamps else ''}")


def add_attribute(state: State, _amount: float, now: float) -> State:
    """Add an attribute that the element does not have, and make its value active.

    Called again before another change, it replaces that attribute by the next one.
    """
    last = state.active.field.name if is_adding(state, ATTRIBUTE) and state.active else ""
    before = before_adding(state, ATTRIBUTE)
    missing = list(missing_attributes(before.element, before))
    if not missing:
        return state.with_message(f"{before.element.title} has no attribute that can be added")
    names = [field.name for field, _ in missing]
    number = (names.index(last) + 1) % len(missing) if last in names else 0
    return with_attribute(before, missing[number][0].name, missing[number][1], now)


def with_attribute(before: State, name: str, value: Any, now: float) -> State:
    """The state whose selected element has a new attribute, which is active."""
    changed = before.element.replace(**{name: value})
    after = before.change(before.scene.edit(before.selected, changed), ATTRIBUTE, now)
    index = [value.field.name for value in values(changed)].index(name)
    field = values(changed)[index].field
    return replace(after, value_index=index).with_message(f"{field.doc}: {field_text(field, changed)}")


def missing_attributes(element: Element, state: State) -> Iterator[tuple[Field, Any]]:
    """Yield the attributes that an element lacks, with default values; none that need a missing picture file."""
    for field in fields_of(type(element)):
        if field.keyed and getattr(element, field.name) is None:
            try:
                yield field, default_value(field, state)
            except LookupError:
                continue


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
