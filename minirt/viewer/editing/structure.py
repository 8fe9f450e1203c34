"""More elements, and fewer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

from minirt.element import Element, fields_of
from minirt.scene.registry import ELEMENTS
from minirt.viewer.editing import history
from minirt.viewer.editing.adding import kinds, made
from minirt.viewer.editing.state import State, index_of

ADDED = "add"  # the kind of change


def duplicate(state: State, _amount: float, now: float) -> State:
    """A copy of the selected element behind it, selected, in the same place."""
    element = state.element
    copy = copied(element)
    if copy is None:
        return state.say(f"a scene has one {element.title}")
    scene = state.scene.edit(state.selected, element, copy)
    state = state.select(state.selected).change(scene, "", now, state.selected + 1)
    return state.say(f"a copy of the {element.title}, in the same place")


def copied(element: Element) -> Element | None:
    """The same as a line of its own. Of what may be there once, the kind that continues it; None without one."""
    kinds = (kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once)
    kind = next(kinds, None)
    return kind(**{each.name: getattr(element, each.name) for each in fields_of(type(element))}) if kind else None


def delete(state: State, _amount: float, now: float) -> State:
    """The scene without the selected element; then the camera is selected."""
    element = state.element
    if element.required:
        return state.say(f"a scene needs its {element.title}")
    scene = state.scene.edit(state.selected)
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).say(f"deleted the {element.title}")


def makeable(known: list[type[Element]], numbers: list[int], state: State) -> Iterator[tuple[int, Element]]:
    """Elements of those kinds, but for what takes a file where there is none."""
    for number in numbers:
        with suppress(LookupError):
            yield number, made(known[number], state)


def add(way: int, state: State, _amount: float, now: float) -> State:
    """An element in front of the camera, selected; again, before anything is done to it, one of the next kind instead.

    The kind is that of the last one that was added.
    """
    again = state.recent is not None and state.recent[0] == ADDED
    before = history.undo(state) if again else state
    known = kinds(before.scene)
    turns = [(state.kind + way * (again + ahead)) % len(known) for ahead in range(len(known))]
    number, element = next(makeable(known, turns, before))
    last = len(before.scene.elements) - 1
    scene = before.scene.edit(last, before.scene.elements[last], element)
    added = replace(replace(before, value=0).change(scene, ADDED, now, last + 1), kind=number)
    return added.say(f"a new {element.title}; again for another kind: {number + 1} of {len(known)}")
