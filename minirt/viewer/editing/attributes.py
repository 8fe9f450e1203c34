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


def add_attribute(state: State, _amount: float, now: float) -> State:
    """Add an attribute that the element does not have, and make its value active.

    Called again before another change, it replaces that attribute by the next one.
    """
    again = state.last_change is not None and state.last_change[0] == CHANGE_KIND and state.active is not None
    last = state.active.field.name if again and state.active else ""
    before = history.undo(state) if again else state
    element = before.element
    missing = [(field.name, value) for field, value in missing_attributes(element, before)]
    if not missing:
        return state.with_message(f"{element.title} has no attribute that can be added")
    names = [name for name, _ in missing]
    number = (names.index(last) + 1) % len(missing) if last in names else 0
    name, value = missing[number]
    changed = element.replace(**{name: value})
    added = before.change(before.scene.edit(before.selected, changed), CHANGE_KIND, now)
    index = [value.field.name for value in values(changed)].index(name)
    field = values(changed)[index].field
    return replace(added, value_index=index).with_message(
        f"{field.doc}: {field_text(field, changed)}; again for another: {number + 1} of {len(missing)}"
    )


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
