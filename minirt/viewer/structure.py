"""More elements, and fewer."""

from __future__ import annotations

from minirt.element import Element, fields_of
from minirt.scene.registry import ELEMENTS
from minirt.viewer.state import State, index_of


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
