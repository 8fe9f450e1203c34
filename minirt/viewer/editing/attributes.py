"""Add an attribute (highlight, mirror, texture, ...) to the selected element, or remove one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Field
from minirt.scene.line_rewriting import field_text
from minirt.viewer.editing import history
from minirt.viewer.editing.adding import default_value
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import values

CHANGE_KIND = "attribute"  # for undo: see `State.change`


def is_adding(state: State) -> bool:
    """Whether the last change added an attribute, which may still be replaced by another one."""
    return state.last_change is not None and state.last_change[0] == CHANGE_KIND and state.active is not None


def before_adding(state: State) -> State:
    """The state without the attribute that was just added."""
    return history.undo(state) if is_adding(state) else state


def add_attribute(state: State, _amount: float, now: float) -> State:
    """Add an attribute that the element does not have, and make its value active.

    Called again before another change, it replaces that attribute by the next one.
    """
    last = state.active.field.name if is_adding(state) and state.active else ""
    before = before_adding(state)
    missing = list(missing_attributes(before.element, before))
    if not missing:
        return state.with_message(f"{before.element.title} has no attribute that can be added")
    names = [field.name for field, _ in missing]
    number = (names.index(last) + 1) % len(missing) if last in names else 0
    return added(before, missing[number][0].name, missing[number][1], now)


def add_named(name: str, state: State, now: float) -> State:
    """Add the attribute of this name, or replace the one that was just added."""
    before = before_adding(state)
    value = next((value for field, value in missing_attributes(before.element, before) if field.name == name), None)
    return state if value is None else added(before, name, value, now)


def added(before: State, name: str, value: Any, now: float) -> State:
    """The state whose selected element has a new attribute, which is active."""
    changed = before.element.replace(**{name: value})
    after = before.change(before.scene.edit(before.selected, changed), CHANGE_KIND, now)
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
