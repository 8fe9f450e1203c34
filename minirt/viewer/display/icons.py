"""Icons for elements without a surface: lights at their position, camera and ambient light in a corner."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from minirt.element import Element, fields_of
from minirt.fields import Colour
from minirt.scene import Camera, Scene
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.editing.projection import Pixel, Projection
from minirt.viewer.editing.state import can_edit, position_of

SIZE = 20  # pixels of a side, times the screen's scale
MAX_ICONS = 200  # so that a scene of many lights is still drawn at once
WHITE = (255, 255, 255)
KINDS_WITH_ICON = tuple(kind for kind in ELEMENTS.values() if can_edit(kind) and not issubclass(kind, Shape))


class Icon(NamedTuple):
    """A square that stands for an element."""

    owner: int  # the index of its element
    x: int  # centre, in pixels
    y: int
    code: str
    colour: int  # 0xRRGGBB


def elements_with_icon(scene: Scene) -> list[int]:
    """Return the indices of the elements that have an icon."""
    return sorted({index for kind in KINDS_WITH_ICON for index in scene.indices_of(kind)})


def place_icons(scene: Scene, indices: Iterable[int], view: Projection, scale: float) -> list[Icon]:
    """Return the icons of the elements with these indices, as far as they lie within the picture."""
    size = round(SIZE * scale)
    corner = view.width - size
    placed: list[Icon] = []
    for index in indices:
        element = scene.elements[index]
        point = None if isinstance(element, Camera) else position_of(element)
        at: Pixel | None = view.pixel(point) if point else (corner, size)
        corner -= 0 if point else round(1.5 * size)
        if at and 0 <= at[0] < view.width and 0 <= at[1] < view.height and len(placed) < MAX_ICONS:
            placed.append(Icon(index, round(at[0]), round(at[1]), element.code, colour_of(element)))
    return placed


def icon_at(icons: list[Icon], x: int, y: int, scale: float) -> Icon | None:
    """Return the icon under the pointer; if several overlap, the last, which is drawn on top."""
    reach = SIZE * scale / 2
    return next((each for each in reversed(icons) if max(abs(each.x - x), abs(each.y - y)) <= reach), None)


def colour_of(element: Element) -> int:
    """Return the element's own colour as 0xRRGGBB, white if it has none."""
    colours = [getattr(element, field.name) for field in fields_of(type(element)) if isinstance(field, Colour)]
    red, green, blue = map(int, next((each for each in colours if not isinstance(each, str)), WHITE))
    return red << 16 | green << 8 | blue
