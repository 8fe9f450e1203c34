"""Attributes of the selected element: one more, or one less."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Field
from minirt.scene.line_rewriting import field_text
from minirt.viewer.editing import history
from minirt.viewer.editing.adding import usual
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import values

GIVEN = "attribute"  # the kind of change


def give(state: State, _amount: float, now: float) -> State:
    """An attribute that the element does not have, its value active; again, before anything is done to it, the next
    one instead."""
    again = state.recent is not None and state.recent[0] == GIVEN and state.active is not None
    last = state.active.field.name if again and state.active else ""
    before = history.undo(state) if again else state
    element = before.element
    known = [(field.name, value) for field, value in offered(element, before)]
    if not known:
        return state.say(f"{element.title} has no attribute that can be added")
    names = [name for name, _ in known]
    number = (names.index(last) + 1) % len(known) if last in names else 0
    name, value = known[number]
    changed = element.replace(**{name: value})
    given = before.change(before.scene.edit(before.selected, changed), GIVEN, now)
    found = [value.field.name for value in values(changed)].index(name)
    field = values(changed)[found].field
    return replace(given, value=found).say(
        f"{field.doc}: {field_text(field, changed)}; again for another: {number + 1} of {len(known)}"
    )


def offered(element: Element, state: State) -> Iterator[tuple[Field, Any]]:
    """The attributes that it does not have, with a value for each; none that need a picture where there is none."""
    for field in fields_of(type(element)):
        if field.keyed and getattr(element, field.name) is None:
            try:
                yield field, usual(field, state)
            except LookupError:
                continue


def take(state: State, _amount: float, now: float) -> State:
    """The element without the attribute that the active value belongs to."""
    active = state.active
    if active is None or not active.field.keyed:
        return state.say(f"{active.name if active else state.element.title} is no attribute that can be taken away")
    changed = state.element.replace(**{active.field.name: active.field.default})
    if changed == state.element:
        return state.say(f"{active.name} is as it is without the attribute")
    state = state.change(state.scene.edit(state.selected, changed), "", now)
    return replace(state, value=0).say(f"no {active.field.title} any more")
