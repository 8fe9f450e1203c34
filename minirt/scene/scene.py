"""A scene: the elements of a file in its order, with the comments and blank lines between them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from operator import indexOf
from pathlib import Path
from typing import Any

from minirt.element import Element
from minirt.scene.concatenation import Concatenation
from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.lights import Lamp
from minirt.scene.pages import Item, Page, replace_item, split_into_pages
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape

UNIQUE_KINDS = tuple(kind for kind in ELEMENTS.values() if kind.once)


@dataclass(frozen=True, init=False)
class Scene:
    """An immutable scene; every change makes a new one, which shares all pages but one with the old. ValueError without
    exactly one camera, or with two of what may be there once.

    `scene.spheres`, `scene.planes` and so on are the elements of one kind.
    """

    items: Concatenation[Item]
    file: Path | None  # where it was read from
    pages: tuple[Page, ...] = field(repr=False, compare=False)

    def __init__(self, items: Iterable[Item], file: Path | None = None) -> None:
        self._hold(tuple(split_into_pages(tuple(items))), file)

    def _hold(self, pages: tuple[Page, ...], file: Path | None) -> None:
        """Become the scene of those pages."""
        for name, value in (("items", Concatenation(page.items for page in pages)), ("file", file), ("pages", pages)):
            object.__setattr__(self, name, value)
        for kind in UNIQUE_KINDS:
            count = sum(type(each) is kind for page in pages if kind in page.kinds for each in page.of(kind))
            if count > 1 or (kind is Camera and count == 0):
                raise ValueError(
                    f"a scene has {'exactly' if kind is Camera else 'at most'} one {kind.title}, got {count}"
                )

    @cached_property
    def elements(self) -> Concatenation[Element]:
        """Everything but comments and blank lines, in the order of the file."""
        return Concatenation(page.of(Element) for page in self.pages)

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """The surfaces, in the order of the file."""
        return self.of(Shape)

    @cached_property
    def lights(self) -> tuple[Lamp, ...]:
        """The lamps, in the order of the file."""
        return self.of(Lamp)

    @cached_property
    def camera(self) -> Camera:
        """The eye."""
        camera: Camera = self.of(Camera)[0]
        return camera

    @cached_property
    def ambient(self) -> Ambient | None:
        """The light from everywhere, if there is any."""
        return next(iter(self.of(Ambient)), None)

    @cached_property
    def background(self) -> Background | None:
        """What rays see that meet nothing, if it is not black."""
        return next(iter(self.of(Background)), None)

    @cached_property
    def resolution(self) -> Resolution | None:
        """The size of the picture, if the file names one."""
        return next(iter(self.of(Resolution)), None)

    def beside(self, name: str) -> Path:
        """Where a file is that an element names: the way begins at the folder of the scene's own file."""
        return self.file.parent / name if self.file else Path(name)

    def of(self, sort: type[Any]) -> tuple[Any, ...]:
        """The elements of that type or of one that is derived from it, in the order of the file."""
        return tuple(chain.from_iterable(page.of(sort) for page in self.pages))

    def indices_of(self, sort: type[Any]) -> Iterator[int]:
        """The indices in `elements` of those of that type; looks into no page that has none."""
        for start, elements, page in zip((0, *self.elements.ends), self.elements.parts, self.pages, strict=False):
            if page.of(sort):
                yield from (index for index, each in enumerate(elements, start) if isinstance(each, sort))

    def __getattr__(self, plural: str) -> tuple[Any, ...]:
        for kind in ELEMENTS.values():
            if kind.plural == plural:
                return tuple(element for element in self.of(kind) if type(element) is kind)
        raise AttributeError(f"a scene has no '{plural}'")

    def replace(self, old: Element, new: Element | None = None, **changes: Any) -> Scene:
        """The scene with `new`, or with `old` changed in some fields, in the place of `old`; ValueError where `old`
        is not in the scene."""
        return self._edited(*self.items.locate(self.index(old)), old.replace(**changes) if new is None else new)

    def index(self, element: Element) -> int:
        """The index in `items` of that very element or else of the first equal one; ValueError where there is none."""
        try:
            return indexOf(map(id, self.items), id(element))
        except ValueError:
            return tuple(self.items).index(element)

    def edit(self, index: int, *instead: Element) -> Scene:
        """The scene with other elements, any number of them, in the place of `elements[index]`."""
        number, at = self.elements.locate(index)
        items = self.pages[number].items
        return self._edited(number, [i for i, item in enumerate(items) if isinstance(item, Element)][at], *instead)

    def _edited(self, number: int, at: int, *instead: Element) -> Scene:
        """The scene with other elements in the place of the item at that index of that page."""
        page = self.pages[number]
        scene = object.__new__(Scene)
        scene._hold((*self.pages[:number], *replace_item(page, at, instead), *self.pages[number + 1 :]), self.file)
        if "shapes" in vars(self) and not any(isinstance(each, Shape) for each in (page.items[at], *instead)):
            vars(scene)["shapes"] = self.shapes
        return scene

    def drop_caches(self) -> Scene:
        """Forget what takes much room and can be worked out again; for a scene that is kept, but not shown."""
        vars(self).pop("shapes", None)
        return self
