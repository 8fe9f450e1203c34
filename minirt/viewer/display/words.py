"""Words for an element: "red sphere", and "diameter [1.6]" with the active value in brackets."""

from __future__ import annotations

import re

from minirt.element import Element, fields_of
from minirt.fields import Colour, Direction, Field, Point
from minirt.scene.writer import field_text
from minirt.viewer.editing.colours import colour_word, own_colour
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import Value, values
from minirt.viewer.language import translated

LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")
LAST = (Point, Colour, Direction)  # sorts of fields that are said after all others, in this order


def title_in_words(element: Element) -> str:
    """Return what an element is called, with its first colour if it has one: "red sphere"."""
    title = translated(element.title)
    colour = own_colour(element)
    if colour is None:
        return title
    return translated("{colour} {element}").format(colour=translated(colour_word(colour)), element=title)


def values_in_words(state: State) -> dict[str, Field]:
    """Return the values of the selected element with their titles, except those at their default, and their fields."""
    element, active = state.element, state.active
    fields = [
        field
        for field in fields_of(type(element))
        if field == active.field or not field.keyed or getattr(element, field.name) != field.default
    ]
    fields.sort(key=order)
    return {value_in_words(state, field): field for field in fields}


def next_in_line(state: State, step: int, whole: bool = False) -> Value:
    """Return the value after the active one in the line on top (step 1), or the one before (step -1), cyclically.

    A part of a triple is followed by the next part, unless all parts were set at once (`whole`) or it is the last one.
    """
    active, every = state.active, values(state.element)
    counts = {field: words.count(",") + 1 for words, field in values_in_words(state).items()}  # of parts on the line
    shown = [each for each in every if (each.part or 0) < counts.get(each.field, 0)]
    is_part = active.channel is not None
    same_field = [each for each in shown if each.field == active.field and (each.channel is not None) == is_part]
    index = same_field.index(active) + step if active in same_field and not whole else -1
    if 0 <= index < len(same_field):
        return same_field[index]
    fields = [field for field in counts if any(each.field == field for each in shown)]
    following = fields[(fields.index(active.field) + step) % len(fields)]
    return next(each for each in shown if each.field == following)


def order(field: Field) -> int:
    """Return where the sort of a field stands among those of an element: sizes first, directions last."""
    return next((place for place, sort in enumerate(LAST, 1) if isinstance(field, sort)), 0)


def value_in_words(state: State, field: Field) -> str:
    """Return the title and the value of a field as the file spells it, numbers to six digits."""
    text, active = field_text(field, state.element).removeprefix(field.prefix), state.active
    text = bracketed(text, active.part) if field == active.field else text
    return f"{translated(field.title)} {short_numbers(text)}"


def bracketed(text: str, part: int | None) -> str:
    """Put brackets around a field, or around one of its components."""
    parts = text.split(",")
    if part is None or part >= len(parts):  # a component at its default is not written
        return f"[{text}]"
    return ",".join([*parts[:part], f"[{parts[part]}]", *parts[part + 1 :]])


def short_numbers(text: str) -> str:
    """Shorten numbers in a text to six digits."""
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", text)
