"""A scene: the elements of a file in its order, with the comments and blank lines between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from minirt.element import Element
from minirt.scene.elements import Ambient, Camera, Light, Resolution
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape

Item = Element | str  # a str is a line without an element, as it stands in the file


@dataclass(frozen=True)
class Scene:
    """An immutable scene; every change makes a new one. ValueError without exactly one camera, or with two of what
    may be there once.

    `scene.spheres`, `scene.planes` and so on are the elements of one kind.
    """

    items: tuple[Item, ...]
    file: Path | None = None  # where it was read from

    def __init__(self, items: Iterable[Item], file: Path | None = None) -> None:
        object.__setattr__(self, "items", tuple(items))
        object.__setattr__(self, "file", file)
        for kind in ELEMENTS.values():
            count = sum(type(item) is kind for item in self.items) if kind.once else 1
            if count > 1 or (kind is Camera and count == 0):
                raise ValueError(
                    f"a scene has {'exactly' if kind is Camera else 'at most'} one {kind.title}, got {count}"
                )

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        """Everything but comments and blank lines, in the order of the file."""
        return tuple(item for item in self.items if isinstance(item, Element))

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """The surfaces, in the order of the file."""
        return tuple(element for element in self.elements if isinstance(element, Shape))

    @cached_property
    def lights(self) -> tuple[Light, ...]:
        """The point lights, in the order of the file."""
        return tuple(element for element in self.elements if isinstance(element, Light))

    @cached_property
    def camera(self) -> Camera:
        """The eye."""
        return next(element for element in self.elements if isinstance(element, Camera))

    @cached_property
    def ambient(self) -> Ambient | None:
        """The light from everywhere, if there is any."""
        return next((element for element in self.elements if isinstance(element, Ambient)), None)

    @cached_property
    def resolution(self) -> Resolution | None:
        """The size of the picture, if the file names one."""
        return next((element for element in self.elements if isinstance(element, Resolution)), None)

    def __getattr__(self, plural: str) -> tuple[Any, ...]:
        for kind in ELEMENTS.values():
            if kind.plural == plural:
                return tuple(element for element in self.elements if type(element) is kind)
        raise AttributeError(f"a scene has no '{plural}'")

    def replace(self, old: Element, new: Element | None = None, **changes: Any) -> Scene:
        """The scene with `new`, or with `old` changed in some fields, in the place of `old`; ValueError where `old`
        is not in the scene."""
        items = list(self.items)
        items[self.index(old)] = old.replace(**changes) if new is None else new
        return Scene(items, self.file)

    def index(self, element: Element) -> int:
        """The index in `items` of that very element or else of the first equal one; ValueError where there is none."""
        for index, item in enumerate(self.items):
            if item is element:
                return index
        return self.items.index(element)
