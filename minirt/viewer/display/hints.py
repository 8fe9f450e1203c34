"""Hints of the line of information: what keys do now to the selected element."""

from __future__ import annotations

import re

from minirt.scene import Camera
from minirt.scene.line_rewriting import field_text
from minirt.viewer.editing.state import Frame, State
from minirt.viewer.editing.values import Value

LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")
GAP = "    "  # between groups of words


def hints(state: State, every: bool) -> str:
    """Present meanings of keys, the most useful first: `+ - diameter 3.8`. `every`: also what is as usual."""
    active = state.active
    groups = [
        f"{state.element.title}: + - {active.name} {value_text(state, active)}" if active else state.element.title
    ]
    if isinstance(state.element, Camera):
        groups.append("wheel: nearer")
    if every or state.frame is not Frame.VIEW:
        groups.append(f"X: move {'in the ' if state.frame is Frame.VIEW else 'along the '}{state.frame.value}")
    return GAP.join([*groups, "H: help"])


def value_text(state: State, active: Value) -> str:
    """The active value as the file spells it, numbers to six digits."""
    text = field_text(active.field, state.element).partition(":")[2] or field_text(active.field, state.element)
    parts = text.split(",")
    if active.part is not None and active.part < len(parts):
        text = parts[active.part]
    return short_numbers(text)


def short_numbers(text: str) -> str:
    """Shorten numbers in a text to six digits."""
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", text)
