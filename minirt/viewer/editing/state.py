"""State of the editor: the scene, the selection, and undo and redo by stacks of snapshots."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from functools import partial
from operator import indexOf
from typing import Any, NamedTuple

from minirt.element import Element, fields_of
from minirt.fields import Field, Whole
from minirt.scene import Camera, Scene
from minirt.viewer.editing.projection import STEP_SHARE, Aim, scene_size
from minirt.viewer.editing.values import Value, nice_number, round_changes, values

MERGE_SECONDS = 0.5  # seconds; changes of the same kind at shorter intervals are undone together
GIVEN = ("typed", "value")  # how the kinds of changes begin that give an element a value
LOOKING = ("position", "direction", "roll")  # fields of a camera that change while one looks around
MAX_UNDO = 1000  # length of the undo stack
MAX_ITEMS = 1_000_000  # of all scenes of the undo stack, about 500 bytes each; edits share them, files read anew do not


class MoveAxes(Enum):
    """Reference frame whose axes elements move along and turn about; the value is shown to the user."""

    VIEW = "view"
    X = "X axis"
    Y = "Y axis"
    Z = "Z axis"


class Snapshot(NamedTuple):
    """An entry of the undo and redo stacks."""

    scene: Scene
    selected: int
    others: frozenset[int] = frozenset()


@dataclass(frozen=True)
class State:
    """Immutable state of the editor; every action returns a new one."""

    scene: Scene
    selected: int  # index into scene.elements: of the primary element, whose values are shown and changed
    file_cameras: tuple[Camera, ...]  # the cameras as they are in the file
    size: float  # of the scene, in scene units; movements are proportional to it
    value_index: int = 0  # of the active value in `values` of the selected element
    frame: MoveAxes = MoveAxes.VIEW
    message: str = ""
    added_kind: type[Element] | None = None  # of the last added element
    others: frozenset[int] = frozenset()  # indices of the other selected elements, which move with the primary one
    hidden: frozenset[int] = frozenset()  # indices of elements that the window does not show; no file has them
    aim: Aim | None = field(default=None, repr=False)  # where the next element goes; None: straight ahead
    undo_stack: tuple[Snapshot, ...] = field(default=(), repr=False)  # oldest first
    redo_stack: tuple[Snapshot, ...] = field(default=(), repr=False)  # the next is the last
    last_change: tuple[str, float] | None = None  # its kind and time, while further changes may be merged with it

    @property
    def element(self) -> Element:
        return self.scene.elements[self.selected]

    @property
    def chosen(self) -> frozenset[int]:
        """Indices of all selected elements."""
        return self.others | {self.selected}

    @property
    def rest(self) -> Scene:
        """The scene without the selected elements."""
        scene = self.scene
        for index in sorted(self.chosen, reverse=True):
            scene = scene.edit(index)
        return scene

    @property
    def active(self) -> Value:
        """The value of the selected element that keys increase and decrease."""
        all_values = values(self.element)
        return all_values[self.value_index % len(all_values)]

    def with_active(self, wanted: Field | Value) -> State:
        """The state in which a value, its first part, or the first value of a field of the element is active."""
        every = enumerate(values(self.element))
        index = next(
            (at for at, each in every if wanted in (each.field, each._replace(channel=None), each)), self.value_index
        )
        return replace(self, value_index=index)

    @property
    def stride(self) -> float:
        """One step of a movement in scene units: a nice number."""
        return nice_number(STEP_SHARE * self.size)

    @property
    def snapshot(self) -> Snapshot:
        return Snapshot(self.scene.drop_caches(), self.selected, self.others)

    def indices_in(self, scene: Scene, indices: frozenset[int]) -> frozenset[int]:
        """Indices of elements in an older or newer version of the scene, without those that it lacks."""
        if not indices or len(scene.elements) == len(self.scene.elements):  # none was added or deleted
            return indices
        identities = {id(self.scene.elements[index]) for index in indices}
        return frozenset(index for index, element in enumerate(scene.elements) if id(element) in identities)

    def with_message(self, message: str) -> State:
        """This state with a message to the user."""
        return replace(self, message=message)

    def select(self, index: int) -> State:
        """Select another element alone. The next change is not merged with earlier ones."""
        return replace(self, selected=index, others=frozenset(), value_index=0, last_change=None, aim=None)

    def make_primary(self, index: int) -> State:
        """Make a selected element the primary one; select any other element alone."""
        return replace(self.select(index), others=self.chosen - {index} if index in self.chosen else frozenset())

    def add_or_remove(self, index: int) -> State:
        """Add an element to the selection, as the primary one, or remove it; the camera in view is selected alone."""
        eye = index_of(self.scene, self.scene.camera)
        chosen = (self.chosen - {eye}) ^ {index}
        if index == eye or not chosen:
            return self.select(index)
        primary = next(each for each in (index, self.selected, max(chosen)) if each in chosen)
        return replace(self.select(primary), others=chosen - {primary})

    def end_merging(self) -> State:
        """End merging: the next change is undone by itself."""
        return replace(self, last_change=None)

    def change(self, scene: Scene, kind: str, now: float, selected: int | None = None) -> State:
        """Replace the scene, push the old one on the undo stack, and empty the redo stack.

        `selected` is the index of the primary element in the new scene; None leaves it. `now` is a time in seconds.
        kind: changes of the same kind within MERGE_SECONDS are undone together; an empty kind is never merged.
        Values of a camera that were typed, or that no looking around changes, are noted in its `edited`: they count as
        unsaved, looking around does not.
        """
        last_kind, then = self.last_change or ("", now)
        merged = bool(kind) and kind == last_kind and now - then <= MERGE_SECONDS
        past = self.undo_stack if merged else (*self.undo_stack[1 - MAX_UNDO :], self.snapshot)
        selected = self.selected if selected is None else selected
        scene = with_edited_cameras(self.scene, scene, also_view=kind.startswith(GIVEN))
        changes: dict[str, Any] = {"undo_stack": past, "redo_stack": (), "last_change": (kind, now)}
        hidden, others = self.indices_in(scene, self.hidden), self.indices_in(scene, self.others)
        return replace(self, scene=scene, selected=selected, others=others - {selected}, hidden=hidden, **changes)

    def edit_element(self, element: Element, kind: str, now: float, index: int | None = None) -> State:
        """Replace the selected element, or another one, by `element`, whose changed numbers are rounded."""
        return self.edit_elements({self.selected if index is None else index: element}, kind, now)

    def edit_elements(self, changed: dict[int, Element], kind: str, now: float) -> State:
        """Replace elements, by their indices, by others whose changed numbers are rounded."""
        scene = self.scene
        for index, element in changed.items():
            old = self.scene.elements[index]
            new = round_changes(old, element, self.stride)
            scene = scene if new == old else scene.edit(index, new)
        return self if scene is self.scene else self.change(scene, kind, now)

    def edit_camera(self, camera: Camera, kind: str, now: float) -> State:
        """Replace the scene's camera by `camera`, whose changed numbers are rounded."""
        return self.edit_element(camera, kind, now, index_of(self.scene, self.scene.camera))


def with_edited_cameras(old: Scene, new: Scene, *, also_view: bool) -> Scene:
    """Return the new scene with a note in its cameras, `edited`, of the fields that were given other values than in the
    old one, and of these values.

    `also_view`: also of the fields that looking around changes, as their values were typed or read.
    """
    for before, after in zip(old.of(Camera), new.of(Camera), strict=False):
        names = [each.name for each in fields_of(Camera) if also_view or each.name not in LOOKING]
        given = {name: getattr(after, name) for name in names if getattr(after, name) != getattr(before, name)}
        if given and before.edited == after.edited:
            new = new.replace(after, after.replace(edited=tuple((dict(before.edited) | given).items())))
    return new


def initial_state(scene: Scene) -> State:
    """State of the editor for a scene that was just opened."""
    return State(scene, index_of(scene, scene.camera), scene.cameras, scene_size(scene))


class Hidden(Element):
    """Stands for an element that the window does not show, so that all others keep their indices."""

    code, title, plural = "", "hidden element", "hidden elements"


def index_of(scene: Scene, element: Element) -> int:
    """Index in `scene.elements` of this very object."""
    return indexOf(map(id, scene.elements), id(element))


def can_edit(kind: type[Element]) -> bool:
    """Whether elements of the kind are seen in the picture, so that keys go to them; a resolution is not."""
    return any(not isinstance(each, Whole) for each in fields_of(kind))


def travel(taken: str, given: str, state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Take the last snapshot from the stack of undo or redo, and give the current one to the other stack.

    The active value, and where the element stands, stay if the selected element stays.
    """
    stack, other = getattr(state, f"{taken}_stack"), getattr(state, f"{given}_stack")
    if not stack:
        return state.with_message(f"nothing to {taken}")
    scene, selected, others = stack[-1]
    stacks = {f"{taken}_stack": stack[:-1], f"{given}_stack": (*other, state.snapshot)}
    hidden = state.indices_in(scene, state.hidden)
    state = state if selected == state.selected else state.select(selected)
    return replace(state, scene=scene, others=others, hidden=hidden, last_change=None, **stacks)


undo, redo = partial(travel, "undo", "redo"), partial(travel, "redo", "undo")


def stack_after_reading(state: State) -> tuple[Snapshot, ...]:
    """Undo stack of a state whose file was read anew. Its oldest entries are dropped where it has too many items."""
    stack = (*state.undo_stack[1 - MAX_UNDO :], state.snapshot)
    pages: dict[int, int] = {}  # their numbers of items, by identity
    for number in range(len(stack) - 1, -1, -1):
        pages.update((id(page), len(page.items)) for page in stack[number].scene.pages)
        if sum(pages.values()) > MAX_ITEMS:
            return stack[min(number + 1, len(stack) - 1) :]
    return stack


def state_after_reading(old: State, scene: Scene, saved: Scene | None) -> State:
    """Return the state for the new scene of the file, with the undo history and the axes of the old state.

    The selection stays if the element at its index has the same kind. The current camera stays if the file has the same
    cameras as `saved`, the scene that the file held before; None never keeps it.
    """
    new = initial_state(scene)
    if saved and scene.cameras == saved.cameras:
        scene = scene.seen_by(old.scene.shown + 1)
        kept = old.scene.camera.replace(source=scene.camera.source, edited=scene.camera.edited)
        new = replace(new, scene=scene.replace(scene.camera, kept))
    stays = old.selected < len(scene.elements) and type(scene.elements[old.selected]) is type(old.element)
    selected, value_index = (old.selected, old.value_index) if stays else (new.selected, 0)
    stack = stack_after_reading(old)
    return replace(new, selected=selected, value_index=value_index, frame=old.frame, undo_stack=stack)
