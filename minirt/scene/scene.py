"""Scene: the elements of a file in its order, with the comments and blank lines between them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from minirt.element import Element
from minirt.errors import counted, did_you_mean
from minirt.helpers import file_io
from minirt.helpers.system import gc_paused
from minirt.records import Immutable
from minirt.scene import writer
from minirt.scene.arguments import check_elements
from minirt.scene.elements import Ambient, Background, Camera, FurtherCamera, Lamp, Resolution
from minirt.scene.pages import Answer, Item, Page, pages_of, replace_item, span_of_ids
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape

if TYPE_CHECKING:  # a stub, written by `python -m tests.make_tables`
    from minirt.scene.element_lists import ElementLists
else:
    ElementLists = object

Kind = TypeVar("Kind")
UNIQUE_KINDS = tuple(kind for kind in ELEMENTS.values() if kind.once)


def cached(find: Callable[[Scene], Answer], doc: str) -> cached_property[Answer]:
    """Return a property of a scene that is found once."""
    find.__doc__ = doc
    return cached_property(find)


def every(kind: type[Kind], doc: str) -> cached_property[tuple[Kind, ...]]:
    """Return a property of a scene: its elements of a kind, in the order of the file."""
    return cached(lambda scene: scene.of(kind), doc)


def first(kind: type[Kind], doc: str) -> cached_property[Kind | None]:
    """Return a property of a scene: its first element of a kind, if it has one."""
    return cached(lambda scene: next(iter(scene.of(kind)), None), doc)


COMMENT = re.compile(r"\ufeff?[ \t\r]*(?:#[^\n]*)?")  # or a blank line: what a scene has beside elements
MISSING = "# missing: "  # begins the comment that a lenient reader makes of a shape that it cannot read


class Scene(Immutable, ElementLists):
    """An immutable scene. An edit makes a new scene, which shares all pages but one with the old.

    `scene.spheres`, `scene.planes` and so on are the elements of one kind. ValueError without exactly one camera beside
    further cameras, or with two elements of a kind that may be there once.
    """

    file: Path | None  # from which it was read
    pages: tuple[Page, ...]
    shown: int = 0  # index in `cameras` of the one that pictures show

    def __init__(self, items: Iterable[Item], file: Path | None = None) -> None:
        """Make a scene of elements, comments and blank lines; TypeError for anything else."""
        items = tuple(items)
        check_elements("Scene", *(item for item in items if not (isinstance(item, str) and COMMENT.fullmatch(item))))
        self._set_pages(tuple(pages_of([items])), file)

    @classmethod
    def of_pages(cls, pages: tuple[Page, ...], file: Path | None) -> Scene:
        """Return the scene with some pages."""
        scene = object.__new__(cls)
        scene._set_pages(pages, file)
        return scene

    def _set_pages(self, pages: tuple[Page, ...], file: Path | None) -> None:
        """Set the contents; ValueError for a wrong number of a unique element."""
        vars(self).update(pages=pages, file=file)
        for kind in UNIQUE_KINDS:
            count = sum(type(element) is kind for page in pages if kind in page.kinds for element in page.of(kind))
            if count > 1 or (kind is Camera and count == 0):
                number = "exactly" if kind is Camera else "at most"
                raise ValueError(f"a scene has {number} one {kind.title}, got {count}")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene) or (self.file, self.shown) != (other.file, other.shown):
            return False
        return self.pages == other.pages or self.items == other.items

    def __hash__(self) -> int:
        return hash((self.items, self.file))

    items: cached_property[tuple[Item, ...]] = cached(
        lambda scene: scene.of(object), "The elements, comments and blank lines, in the order of the file."
    )
    elements = every(Element, "All elements, without comments and blank lines, in the order of the file.")
    shapes = every(Shape, "All shapes, in the order of the file.")  # type: ignore[type-abstract]
    runs: cached_property[tuple[Sequence[Shape], ...]] = cached(
        lambda scene: tuple(filter(None, (page.of(Shape) for page in scene.pages))),
        "All shapes page by page: scenes that share pages share these sequences.",
    )
    lights = every(Lamp, "All light sources, in the order of the file.")
    cameras: cached_property[tuple[Camera, ...]] = cached(
        lambda scene: tuple(sorted(scene.of(Camera), key=lambda camera: isinstance(camera, FurtherCamera))),
        "The camera, and then the further cameras in the order of the file.",
    )
    camera: cached_property[Camera] = cached(lambda scene: scene.cameras[scene.shown], "The camera of pictures.")
    ambient = first(Ambient, "The ambient light, if the file has one.")
    background = first(Background, "The background of rays that hit nothing; None is black.")
    missing: cached_property[tuple[str, ...]] = cached(
        lambda scene: tuple(each.removeprefix(MISSING) for each in scene.of(str) if each.startswith(MISSING)),
        "The lines of shapes that a lenient reader could not read; they are comments.",
    )
    resolution = first(Resolution, "The size of the picture, if the file has one.")

    def beside(self, name: str) -> Path:
        """Return the path of a file that an element names, relative to the folder of the scene file or one above."""
        return file_io.located(self.file.parent, name) if self.file else Path(name)

    def of(self, sort: type[Any]) -> tuple[Any, ...]:
        """Return the elements that are instances of a type, subclasses included, in the order of the file."""
        with gc_paused(freeze=False):
            return tuple(chain.from_iterable(page.of(sort) for page in self.pages))

    def indices_of(self, sort: type[Any]) -> Iterator[int]:
        """Yield the indices in `elements` of the instances of a type; pages without one are skipped."""
        start = 0
        for page in self.pages:
            elements = page.of(Element)
            if page.of(sort):
                yield from (index for index, element in enumerate(elements, start) if isinstance(element, sort))
            start += len(elements)

    if not TYPE_CHECKING:

        def __getattr__(self, plural: str) -> tuple[Any, ...]:
            for kind in ELEMENTS.values():
                if kind.plural == plural:
                    return tuple(element for element in self.of(kind) if type(element) is kind)
            known = () if plural.startswith("_") else dir(self)
            raise AttributeError(f"a scene has no '{plural}'{did_you_mean(plural, known)}")

    def __dir__(self) -> list[str]:
        plurals = {kind.plural for kind in ELEMENTS.values()}
        return sorted(plurals.union(super().__dir__()))

    def __repr__(self) -> str:
        where = f", from {str(self.file)!r}" if self.file else ""
        return f"<Scene of {counted(len(self.shapes), 'shape')} and {counted(len(self.lights), 'light')}{where}>"

    def replace(self, old: Element, new: Element | None = None, **changes: Any) -> Scene:
        """Return the scene with `old` replaced by `new`, or with some of its fields changed; ValueError without it."""
        check_elements("replace", old, *(() if new is None else (new,)))
        new = old.replace(**changes) if new is None else new
        if isinstance(old, Camera) and isinstance(new, Camera) and type(new) is not type(old):
            new = new.as_kind(type(old))
        return self._edited(self.index(old), object, new)

    def add(self, *elements: Element) -> Scene:
        """Return the scene with one or several elements at its end; ValueError where a kind may be there only once.

        scene = scene.add(minirt.Sphere((0, 1, 8), 2, (255, 0, 0)))
        """
        check_elements("add", *elements)
        items = self.items
        end = len(items) - (items[-1:] == ("",))  # before the blank line that is the end of a file
        return Scene((*items[:end], *elements, *items[end:]), self.file).seen_by(self.shown + 1)

    def seen_by(self, number: int) -> Scene:
        """Return the scene as camera `number` of the file sees it, from 1; ValueError where there is none.

        minirt.render(scene.seen_by(2), 640, 480)
        """
        if not 1 <= number <= len(self.cameras):
            raise ValueError(f"the scene has {counted(len(self.cameras), 'camera')}, got the number {number}")
        scene = object.__new__(Scene)
        vars(scene).update(vars(self), shown=number - 1, camera=self.cameras[number - 1])
        return scene

    def mirrored(self) -> Scene:
        """Return the scene with pictures as of left-handed coordinates."""
        scene = self
        for camera in self.cameras:
            scene = scene.replace(camera, left_handed=True)
        return scene

    def remove(self, *elements: Element) -> Scene:
        """Return the scene without some elements; ValueError when one is not in the scene, or is its camera."""
        check_elements("remove", *elements)
        scene = self
        for element in elements:
            scene = scene._edited(scene.index(element), object)
        return scene

    def save(self, path: str | os.PathLike[str] | None = None) -> None:
        """Write the scene to a file, by default the one that it was read from, as a whole or not at all.

        Comments and unchanged lines stay as they were read. Textures and meshes keep their names, which are relative to
        the folder of the file, into which meshes of arrays are written. SceneError when the file cannot be written,
        ValueError where there is no path.
        """
        target = self.file if path is None else path
        if target is None:
            raise ValueError("a scene that was not read from a file needs a path: scene.save('name.rt')")
        writer.write(self.pages, target)

    def index(self, element: Element) -> int:
        """Return the index in `items` of the element itself, else of the first equal one; ValueError without one."""
        start = 0
        for page in self.pages:
            is_near = page.is_made and id(element) in page.cached(span_of_ids)
            if is_near and id(element) in (ids := list(map(id, page.items))):
                return start + ids.index(id(element))
            start += len(page.items)
        with suppress(ValueError):
            return self.items.index(element)
        raise ValueError(f"the scene has no {element!r}")

    def edit(self, index: int, *new: Item) -> Scene:
        """Return the scene with `elements[index]` replaced by any number of items."""
        return self._edited(range(sum(len(page.of(Element)) for page in self.pages))[index], Element, *new)

    def _edited(self, index: int, sort: type[Any], *new: Item) -> Scene:
        """Return the scene with one item replaced by any number of `new` items.

        `index` counts the items of the class `sort`. The scene is seen by the same camera, or by that which replaces
        it, or by the first one.
        """
        number, rest = 0, index  # of the page, and of the item in it
        while rest >= (length := len(self.pages[number].of(sort))):
            rest, number = rest - length, number + 1
        page = self.pages[number]
        place = [place for place, item in enumerate(page.items) if isinstance(item, sort)][rest]
        pages = *self.pages[:number], *replace_item(page, place, new), *self.pages[number + 1 :]
        scene = Scene.of_pages(pages, self.file)
        if self.shown:
            kept = [number for number, camera in enumerate(scene.cameras, 1) if camera is self.camera]
            replaced = self.shown + 1 if len(scene.cameras) == len(self.cameras) else 1
            scene = scene.seen_by(kept[0] if kept else replaced)
        return scene

    def drop_caches(self) -> Scene:
        """Drop large cached values, for a scene that is kept but not shown; return the scene."""
        for name in ("items", "elements", "shapes"):
            vars(self).pop(name, None)
        return self
