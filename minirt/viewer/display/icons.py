"""Small signs for what has no surface: lights where they stand, and camera and ambient light in a corner."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from minirt.element import Element, fields_of
from minirt.fields import Colour
from minirt.scene import Camera, Scene
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.editing.projection import Pixel, Projection
from minirt.viewer.editing.state import can_edit, place_of

SIZE = 20  # pixels of a side, times the screen's scale
MOST = 200  # icons: a scene of many lights is still drawn at once
WHITE = (255, 255, 255)
SIGNED = tuple(kind for kind in ELEMENTS.values() if can_edit(kind) and not issubclass(kind, Shape))


class Icon(NamedTuple):
    """One of them."""

    owner: int  # the index of its element
    x: int  # of its middle, in pixels
    y: int
    code: str
    colour: int  # 0xRRGGBB


def signed(scene: Scene) -> list[int]:
    """The indices of the elements that have an icon."""
    return sorted({index for kind in SIGNED for index in scene.indices_of(kind)})


def icons(scene: Scene, indices: Iterable[int], lens: Projection, scale: float) -> list[Icon]:
    """The icons of those elements, as far as they are in the picture."""
    size = round(SIZE * scale)
    corner = lens.width - size
    placed: list[Icon] = []
    for index in indices:
        element = scene.elements[index]
        point = None if isinstance(element, Camera) else place_of(element)
        at: Pixel | None = lens.pixel(point) if point else (corner, size)
        corner -= 0 if point else round(1.5 * size)
        if at and 0 <= at[0] < lens.width and 0 <= at[1] < lens.height and len(placed) < MOST:
            placed.append(Icon(index, round(at[0]), round(at[1]), element.code, colour(element)))
    return placed


def icon_at(placed: list[Icon], x: int, y: int, scale: float) -> Icon | None:
    """The icon under the pointer; of several the last, which is drawn over the others."""
    reach = SIZE * scale / 2
    return next((each for each in reversed(placed) if max(abs(each.x - x), abs(each.y - y)) <= reach), None)


def colour(element: Element) -> int:
    """The element's own colour, 0xRRGGBB."""
    colours = [getattr(element, field.name) for field in fields_of(type(element)) if isinstance(field, Colour)]
    red, green, blue = map(int, next((each for each in colours if not isinstance(each, str)), WHITE))
    return red << 16 | green << 8 | blue
