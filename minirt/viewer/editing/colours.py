"""Words for colours: what a colour is called, and the colours that an element can be given by a word."""

from __future__ import annotations

from collections.abc import Iterator
from colorsys import rgb_to_hsv
from math import hypot, inf

from minirt.element import Element, fields_of
from minirt.fields import Colour, Triple
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import Value, values

GREY = 0.15  # saturation, or brightness, below which a colour is a grey
HUES = 5  # brightnesses that are as far from each other as the two ends of the circle of hues
SECOND_COLOUR = "choose second colour"  # the action that gives the colour of a pattern
COLOUR = "colour"  # kind of the changes that give colours by words, see `State.change`
COLOURS: dict[str, Triple] = {
    "black": (0, 0, 0),
    "dark grey": (70, 70, 70),
    "grey": (130, 130, 130),
    "light grey": (195, 195, 195),
    "white": (255, 255, 255),
    "dark red": (120, 10, 10),
    "red": (230, 30, 30),
    "pink": (255, 160, 190),
    "beige": (240, 220, 180),
    "brown": (130, 75, 30),
    "orange": (255, 140, 0),
    "yellow": (255, 235, 40),
    "dark green": (10, 90, 20),
    "green": (40, 180, 50),
    "light green": (150, 230, 140),
    "turquoise": (50, 195, 190),
    "light blue": (150, 195, 255),
    "blue": (30, 80, 210),
    "dark blue": (25, 40, 110),
    "purple": (140, 40, 190),
}


def colour_word(colour: Triple) -> str:
    """Return the word whose colour is nearest: of the greys in brightness, of the others in hue before brightness."""
    hue, saturation, brightness = rgb_to_hsv(*(level / 255 for level in colour))
    is_grey = saturation < GREY or brightness < GREY

    def distance(word: str) -> float:
        other, share, light = rgb_to_hsv(*(level / 255 for level in COLOURS[word]))
        if is_grey or share < GREY:
            return abs(light - brightness) if is_grey and share < GREY else inf
        turn = abs(hue - other)
        return hypot(min(turn, 1 - turn) * HUES, light - brightness, (share - saturation) / 2)

    return min(COLOURS, key=distance)


def colour_value(element: Element, active: Value | None = None) -> Value | None:
    """Return the active value if it is a colour, or else the first colour of an element; None where it has none."""
    is_colour = active is not None and isinstance(active.leaf, Colour)
    every = [active, *colours_of(element)] if is_colour else colours_of(element)
    return every[0]._replace(channel=None) if every and every[0] else None


def colours_of(element: Element) -> list[Value]:
    """Return the colours of an element: its own, and those of its patterns."""
    return [*dict.fromkeys(each._replace(channel=None) for each in values(element) if isinstance(each.leaf, Colour))]


def next_colour(state: State) -> Value:
    """Return the colour of a pattern of the selected element, the next after the active one; its own if it has none."""
    own, *others = colours_of(state.element)
    active = state.active._replace(channel=None)
    at = others.index(active) + 1 if active in others else 0
    return others[at % len(others)] if others else own


def own_colour(element: Element) -> Triple | None:
    """Return the first colour of an element that no attribute has, in levels from 0 to 255; None without one."""
    own = (getattr(element, field.name) for field in fields_of(type(element)) if isinstance(field, Colour))
    return next((each for each in own if isinstance(each, tuple)), None)


def colours(state: State) -> Iterator[tuple[str, State]]:
    """Yield the selected elements as they are, and in each colour, with its word."""
    if colour_value(state.element) is None:
        return
    yield "as it is", state.change(state.scene, COLOUR, 0.0)
    for word, levels in COLOURS.items():
        scene = state.scene
        for index in state.chosen:
            element = scene.elements[index]
            if value := colour_value(element, state.active if index == state.selected else None):
                painted = element.replace(**{value.field.name: value.replaced(element, levels)})
                scene = scene.edit(index, painted)
        yield word, state.change(scene, COLOUR, 0.0).with_message(f"colour: {word}")
