"""Add, duplicate and delete elements."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

from minirt.element import Element, fields_of
from minirt.scene.registry import ELEMENTS
from minirt.viewer.editing import history
from minirt.viewer.editing.adding import addable_kinds, default_record
from minirt.viewer.editing.state import State, index_of

CHANGE_KIND = "add"  # for undo: see `State.change`


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


def default_elements(kinds: list[type[Element]], numbers: list[int], state: State) -> Iterator[tuple[int, Element]]:
    """Yield default elements of the kinds with these numbers; kinds that need a missing file are skipped."""
    for number in numbers:
        with suppress(LookupError):
            yield number, default_record(kinds[number], state)


def add(step: int, state: State, _amount: float, now: float) -> State:
    """Add an element in front of the camera, of the kind that was added last, and select it.

    Called again before another change, it replaces that element by one of the next (step 1) or previous (-1) kind.
    """
    again = state.last_change is not None and state.last_change[0] == CHANGE_KIND
    before = history.undo(state) if again else state
    kinds = addable_kinds(before.scene)
    numbers = [(state.kind_index + step * (again + skipped)) % len(kinds) for skipped in range(len(kinds))]
    number, element = next(default_elements(kinds, numbers, before))
    last = len(before.scene.elements) - 1
    scene = before.scene.edit(last, before.scene.elements[last], element)
    added = replace(replace(before, value_index=0).change(scene, CHANGE_KIND, now, last + 1), kind_index=number)
    return added.with_message(f"a new {element.title}; again for another kind: {number + 1} of {len(kinds)}")
