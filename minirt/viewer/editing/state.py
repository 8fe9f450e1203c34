"""State of the editor: the scene, the selection, and the undo and redo stacks."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from operator import indexOf
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Direction, Point, Triple
from minirt.scene import Camera, Scene
from minirt.viewer.editing.aiming import Aim
from minirt.viewer.editing.measure import scene_size
from minirt.viewer.editing.number_format import nice_number, round_changes
from minirt.viewer.editing.values import Value, is_editable, values

STEP_SHARE = 1 / 40  # one step of a movement as a share of the scene's size, before rounding
MERGE_SECONDS = 0.5  # seconds; changes of the same kind at shorter intervals are undone together
MAX_UNDO = 1000  # length of the undo stack


class Frame(Enum):
    """Reference frame whose axes elements move along and turn about; the value is shown to the user."""

    VIEW = "view"
    X = "X axis"
    Y = "Y axis"
    Z = "Z axis"


@dataclass(frozen=True)
class Snapshot:
    """An entry of the undo and redo stacks."""

    scene: Scene
    selected: int


@dataclass(frozen=True)
class State:
    """Immutable state of the editor; every action returns a new one."""

    scene: Scene
    selected: int  # index into scene.elements
    file_camera: Camera  # the camera as it is in the file
    size: float  # of the scene, in scene units; movements are proportional to it
    value_index: int = 0  # of the active value in `values` of the selected element
    frame: Frame = Frame.VIEW
    message: str = ""
    kind_index: int = 0  # of the last added element in `addable_kinds`
    aim: Aim | None = field(default=None, repr=False)  # where the next element goes; None: straight ahead
    undo_stack: tuple[Snapshot, ...] = field(default=(), repr=False)  # oldest first
    redo_stack: tuple[Snapshot, ...] = field(default=(), repr=False)  # latest first
    last_change: tuple[str, float] | None = None  # its kind and time, while further changes may be merged with it

    @property
    def element(self) -> Element:
        """The selected element."""
        return self.scene.elements[self.selected]

    @property
    def active(self) -> Value | None:
        """The value of the selected element that keys increase and decrease; None if it has none."""
        all_values = values(self.element)
        return all_values[self.value_index % len(all_values)] if all_values else None

    @property
    def stride(self) -> float:
        """One step of a movement in scene units: a nice number."""
        return nice_number(STEP_SHARE * self.size)

    def index_in(self, scene: Scene) -> int | None:
        """Index of the selected element in an older or newer version of the scene; None if that lacks the element."""
        if len(scene.elements) == len(self.scene.elements):  # elements were changed, but not added or deleted
            return self.selected
        try:
            return index_of(scene, self.element)
        except ValueError:
            return None

    def with_message(self, message: str) -> State:
        """This state with a message to the user."""
        return replace(self, message=message)

    def select(self, index: int) -> State:
        """Select another element. The next change is not merged with earlier ones."""
        return replace(self, selected=index, value_index=0, last_change=None, aim=None)

    def end_merging(self) -> State:
        """End merging: the next change is undone by itself."""
        return replace(self, last_change=None)

    def change(self, scene: Scene, kind: str, now: float, selected: int | None = None) -> State:
        """Replace the scene and push the old one on the undo stack.

        kind: changes of the same kind within MERGE_SECONDS are undone together; an empty kind is never merged.
        """
        last = self.last_change
        merged = bool(kind) and last is not None and last[0] == kind and now - last[1] <= MERGE_SECONDS
        past = (
            self.undo_stack
            if merged
            else (*self.undo_stack[1 - MAX_UNDO :], Snapshot(self.scene.drop_caches(), self.selected))
        )
        selected = self.selected if selected is None else selected
        return replace(self, scene=scene, selected=selected, undo_stack=past, redo_stack=(), last_change=(kind, now))

    def edit_element(self, element: Element, kind: str, now: float) -> State:
        """Replace the selected element by `element`, whose changed numbers are rounded."""
        element = round_changes(self.element, element, self.stride)
        if element == self.element:
            return self
        return self.change(self.scene.edit(self.selected, element), kind, now)

    def edit_camera(self, camera: Camera, kind: str, now: float) -> State:
        """Replace the scene's camera by `camera`, whose changed numbers are rounded."""
        camera = round_changes(self.scene.camera, camera, self.stride)
        if camera == self.scene.camera:
            return self
        return self.change(self.scene.replace(self.scene.camera, camera), kind, now)


def initial_state(scene: Scene) -> State:
    """State of the editor for a scene that was just opened."""
    return State(scene, index_of(scene, scene.camera), scene.camera, scene_size(scene))


def index_of(scene: Scene, element: Element) -> int:
    """Index in `scene.elements` of this very object."""
    return indexOf(map(id, scene.elements), id(element))


def field_names(kind: type[Element], field_type: type[Any]) -> tuple[str, ...]:
    """Names of the fields of a type, such as the points or the directions."""
    return tuple(each.name for each in fields_of(kind) if isinstance(each, field_type))


def position_of(element: Element) -> Triple | None:
    """Position of an element: its first point, None if it has no points."""
    names = field_names(type(element), Point)
    position: Triple | None = getattr(element, names[0]) if names else None
    return position


def can_edit(kind: type[Element]) -> bool:
    """Whether keys can edit elements of the kind."""
    return any(map(is_editable, fields_of(kind))) or bool(field_names(kind, Point) or field_names(kind, Direction))
