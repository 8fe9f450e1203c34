"""State of the editor: the scene, the selection, and undo and redo by stacks of snapshots."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from operator import indexOf
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Direction, Point, Triple
from minirt.scene import Camera, Lamp, Scene
from minirt.shapes import Shape
from minirt.viewer.editing.projection import Aim, scene_size
from minirt.viewer.editing.values import Value, is_editable, nice_number, round_changes, values

STEP_SHARE = 1 / 40  # one step of a movement as a share of the scene's size, before rounding
MERGE_SECONDS = 0.5  # seconds; changes of the same kind at shorter intervals are undone together
MAX_UNDO = 1000  # length of the undo stack
MAX_ITEMS = 1_000_000  # of all scenes of the undo stack, about 500 bytes each; edits share them, files read anew do not


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


def select_neighbour(step: int, state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next (step 1) or previous (-1) editable element in the order of the file, cyclically."""
    count = len(state.scene.elements)
    indices = ((state.selected + step * number) % count for number in range(1, count + 1))
    return state.select(next(index for index in indices if can_edit(type(state.scene.elements[index]))))


def select_camera(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the camera."""
    return state.select(index_of(state.scene, state.scene.camera))


def select_next_light(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next light after the selected element, cyclically."""
    lights = list(state.scene.indices_of(Lamp))
    if not lights:
        return state.with_message("there is no light")
    return state.select(next((index for index in lights if index > state.selected), lights[0]))


def select_shape(state: State, shape: Shape | None) -> State:
    """Select the shape that a pixel shows, or keep the selection if it shows none."""
    state = state.with_message("" if shape else "there is nothing")
    return state.select(index_of(state.scene, shape)) if shape else state


def undo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Undo the last change, and restore the selection before it."""
    if not state.undo_stack:
        return state.with_message("nothing to undo")
    return restore(
        state.undo_stack[-1],
        replace(state, undo_stack=state.undo_stack[:-1], redo_stack=(*state.redo_stack, current_snapshot(state))),
    )


def redo(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Redo the change that was undone last."""
    if not state.redo_stack:
        return state.with_message("nothing to redo")
    return restore(
        state.redo_stack[-1],
        replace(state, undo_stack=(*state.undo_stack, current_snapshot(state)), redo_stack=state.redo_stack[:-1]),
    )


def current_snapshot(state: State) -> Snapshot:
    """Snapshot of the current scene and selection."""
    return Snapshot(state.scene.drop_caches(), state.selected)


def stack_after_reading(state: State) -> tuple[Snapshot, ...]:
    """Undo stack of a state whose file was read anew. Its oldest entries are dropped where it has too many items."""
    stack = (*state.undo_stack[1 - MAX_UNDO :], current_snapshot(state))
    pages: set[int] = set()
    items = 0
    for number in range(len(stack) - 1, -1, -1):
        new = {id(page): len(page.items) for page in stack[number].scene.pages if id(page) not in pages}
        pages.update(new)
        items += sum(new.values())
        if items > MAX_ITEMS and number < len(stack) - 1:
            return stack[number + 1 :]
    return stack


def restore(snapshot: Snapshot, state: State) -> State:
    """The state with the scene of a snapshot. The active value stays if the selected element stays."""
    value_index = state.value_index if snapshot.selected == state.selected else 0
    return replace(state, scene=snapshot.scene, selected=snapshot.selected, value_index=value_index, last_change=None)


def state_after_reading(old: State, scene: Scene, saved: Scene | None) -> State:
    """Return the state for the new scene of the file, with selection and undo history of the old state.

    The current camera stays if the file has the same camera as `saved`, the scene that the file held before.
    """
    new = initial_state(scene)
    if saved and scene.camera == saved.camera:
        new = replace(new, scene=scene.replace(scene.camera, old.scene.camera.replace(source=scene.camera.source)))
    same = old.selected < len(scene.elements) and type(scene.elements[old.selected]) is type(old.element)
    return replace(
        new,
        selected=old.selected if same else new.selected,
        value_index=old.value_index if same else 0,
        frame=old.frame,
        undo_stack=stack_after_reading(old),
    )
