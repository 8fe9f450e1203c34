"""What the editor knows: a scene, what is selected in it, and the way back."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from operator import indexOf
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Direction, Point, Triple
from minirt.scene import Camera, Scene
from minirt.viewer.editing.measure import size_of
from minirt.viewer.editing.number_format import neat, nice
from minirt.viewer.editing.values import Value, grows, values

STRIDE = 1 / 40  # of the scene's size: one step of a movement, about
MERGE = 0.5  # seconds; changes of the same kind that follow each other faster are undone together
MOST = 1000  # changes that can be undone


class Frame(Enum):
    """The axes along and about which objects move; the value is what the user sees."""

    VIEW = "view"
    X = "X axis"
    Y = "Y axis"
    Z = "Z axis"


@dataclass(frozen=True)
class Moment:
    """What undo goes back to."""

    scene: Scene
    selected: int


@dataclass(frozen=True)
class State:
    """Immutable; every action of the editor makes a new one."""

    scene: Scene
    selected: int  # index into scene.elements
    home: Camera  # the camera of the file
    size: float  # how large the scene is, in scene units: movements are shares of it
    value: int = 0  # index into `values` of the selected element
    frame: Frame = Frame.VIEW
    message: str = ""
    kind: int = 0  # index into the kinds that can be added, of the last one that was
    past: tuple[Moment, ...] = field(default=(), repr=False)  # oldest first
    future: tuple[Moment, ...] = field(default=(), repr=False)  # furthest first
    recent: tuple[str, float] | None = None  # kind and time of the last change, while more may be merged with it

    @property
    def element(self) -> Element:
        """The selected one."""
        return self.scene.elements[self.selected]

    @property
    def active(self) -> Value | None:
        """What grows and shrinks of the selected element, if anything."""
        known = values(self.element)
        return known[self.value % len(known)] if known else None

    @property
    def stride(self) -> float:
        """One step of a movement: a round number of scene units."""
        return nice(STRIDE * self.size)

    def say(self, message: str) -> State:
        """The same with a message to the user."""
        return replace(self, message=message)

    def select(self, index: int) -> State:
        """Select another element; what follows is undone by itself."""
        return replace(self, selected=index, value=0, recent=None)

    def cut(self) -> State:
        """What follows is undone by itself."""
        return replace(self, recent=None)

    def change(self, scene: Scene, kind: str, now: float, selected: int | None = None) -> State:
        """Another scene; `kind` tells which changes may be undone together. With none that is so for no other."""
        same = bool(kind) and self.recent is not None and self.recent[0] == kind and now - self.recent[1] <= MERGE
        past = self.past if same else (*self.past[1 - MOST :], Moment(self.scene.drop_caches(), self.selected))
        chosen = self.selected if selected is None else selected
        return replace(self, scene=scene, selected=chosen, past=past, future=(), recent=(kind, now))

    def put(self, element: Element, kind: str, now: float) -> State:
        """`element` in the place of the selected one, with round numbers where they are new."""
        element = neat(self.element, element, self.stride)
        if element == self.element:
            return self
        return self.change(self.scene.edit(self.selected, element), kind, now)

    def put_camera(self, camera: Camera, kind: str, now: float) -> State:
        """That camera in the place of the scene's, likewise."""
        camera = neat(self.scene.camera, camera, self.stride)
        if camera == self.scene.camera:
            return self
        return self.change(self.scene.replace(self.scene.camera, camera), kind, now)


def opened(scene: Scene) -> State:
    """The state in which a scene is first seen."""
    return State(scene, index_of(scene, scene.camera), scene.camera, size_of(scene))


def index_of(scene: Scene, element: Element) -> int:
    """The index of that very element in `scene.elements`."""
    return indexOf(map(id, scene.elements), id(element))


def named(kind: type[Element], sort: type[Any]) -> tuple[str, ...]:
    """The names of the fields of one sort: of the points, of the directions."""
    return tuple(each.name for each in fields_of(kind) if isinstance(each, sort))


def place_of(element: Element) -> Triple | None:
    """The first of its points, None where it has none."""
    names = named(type(element), Point)
    place: Triple | None = getattr(element, names[0]) if names else None
    return place


def can_edit(kind: type[Element]) -> bool:
    """Whether any key does anything to it."""
    return any(map(grows, fields_of(kind))) or bool(named(kind, Point) or named(kind, Direction))
