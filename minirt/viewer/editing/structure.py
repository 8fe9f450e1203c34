"""Add, duplicate and delete elements; add attributes (highlight, mirror, texture, ...) and remove them.

New elements and attributes are made from tables of fields alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import copysign, cos, pi, sin
from typing import Any

from minirt.element import Element, Record, fields_of
from minirt.errors import ElementError
from minirt.fields import Direction, Field, Length, Lengths, MeshField, Picture, Point, Real, Triple, clamp_length
from minirt.materials import Compound
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Camera, Lamp, Light, Scene
from minirt.scene.elements import linear_combination
from minirt.scene.names import element_name, named_block, own_name, renamed
from minirt.scene.registry import ELEMENTS
from minirt.scene.writer import field_text
from minirt.shapes import Shape
from minirt.shapes.shape import union_of_bounds
from minirt.viewer.editing.placing import aim_ahead, settled
from minirt.viewer.editing.projection import UP, field_names
from minirt.viewer.editing.rigid import clamp_point, shifted
from minirt.viewer.editing.state import Snapshot, State, can_edit, index_of
from minirt.viewer.editing.values import (
    RecordType,
    leading_decimal,
    nice_number,
    position_value,
    round_length,
    round_point,
    values,
)
from minirt.viewer.files import usable_files
from minirt.viewer.language import GAP

ELEMENT, ATTRIBUTE = "add", "attribute"  # what was added: kinds of changes, see `State.change`
SIZE = 1 / 8  # of lengths in a new attribute, as a share of the scene's size
STACKED = 1.5  # times the usual size on top of another shape: of a shape of the same kind
FURTHER = "further "  # begins the titles of lights and cameras after the first
APART = 1.2  # breadths of selected shapes from their middle to that of their copies
SHOULDER = 0.6  # of the scene's size: how far the lamp that the first shape brings is beside and above the camera
LAMP_BRIGHTNESS = 0.8  # of the lamp that the first shape brings


def duplicate(state: State, _amount: float, now: float) -> State:
    """Insert a copy after each selected element, and select the copies, which are beside the originals.

    A coordinate that is active stays so, as that of the next copy will be changed, too; else the first value is active.
    """
    scene, copies, way, active = state.scene, dict[int, Element](), way_beside(state), state.active
    for index in sorted(state.chosen, reverse=True):
        element = state.scene.elements[index]
        # A kind that a scene has once is copied as the repeatable kind that is derived from it, if there is one.
        repeatable = [kind for kind in ELEMENTS.values() if issubclass(kind, type(element)) and not kind.once]
        if not repeatable:
            return state.with_message(f"a scene has one {element.title}")
        copies[index] = shifted(element.as_kind(repeatable[0]), way)
        scene = scene.edit(index, element, copies[index])
    what = names_of_chosen(state)
    others = frozenset(index_of(scene, copies[index]) for index in state.others)
    state = state.change(scene, "", now, index_of(scene, copies[state.selected]))
    state = replace(state, others=others, value_index=0)
    state = state.with_active(active) if isinstance(active.leaf, Point) else state
    message = f"a copy of {what}, beside the original" if any(way) else f"a copy of {what}, at the same position"
    if position_value(state.element) and not others:
        begun = "" if isinstance(state.active.leaf, Point) else f"{state.active.name}, Tab, "
        message += f"{GAP}type = {begun}x y z"
    return state.with_message(message)


def way_beside(state: State) -> Triple:
    """Return the way that takes the selected shapes beside themselves: to the right in the picture, along x or z.

    There is no way beside what has no bounds, such as a plane or a light.
    """
    chosen = [state.scene.elements[index] for index in state.chosen]
    boxes = [box for each in chosen if isinstance(each, Shape) and (box := each.bounds())]
    if not boxes:
        return 0.0, 0.0, 0.0
    least, greatest = union_of_bounds(*boxes)
    right, _, _ = camera_frame(state.scene.camera)
    axis = 0 if abs(right[0]) >= abs(right[2]) else 2
    length = copysign(max(APART * (greatest[axis] - least[axis]), state.stride / 10), right[axis])
    x, _, z = round_point((length, 0.0, length), state.stride)
    return (x, 0.0, 0.0) if axis == 0 else (0.0, 0.0, z)


def delete(state: State, _amount: float, now: float) -> State:
    """Delete the selected elements, and select the camera."""
    elements = [state.scene.elements[index] for index in state.chosen]
    for element in elements:
        if element.required:
            return state.with_message(f"a scene needs its {element.title}")
    what = names_of_chosen(state)
    scene = state.rest
    state = state.change(scene, "", now, index_of(scene, scene.camera))
    return state.select(state.selected).with_message(f"deleted {what}")


def rename(state: State, name: str) -> State:
    """Give the selected element a name, which its line has in a comment; without one it is called as if it had none."""
    element = renamed(state.element, name)
    if own_name(element) == own_name(state.element):
        return state
    state = state.change(state.scene.edit(state.selected, element), "", 0.0)
    return state.with_message(f"name: {element_name(state.scene, state.selected)}")


def names_of_chosen(state: State | Snapshot) -> str:
    """The name of the selected element, or the number of selected elements."""
    return f"{len(state.others) + 1} elements" if state.others else element_name(state.scene, state.selected)


def choices(state: State, group: str) -> Iterator[tuple[str, State]]:
    """Yield the states after each kind of element, or each attribute that the selected element lacks, was added.

    Each comes with its title. Those that need a missing file, or cannot be so small or far away, are left out.
    """
    if group == ELEMENT:
        kinds = addable_kinds(state.scene)  # of a light and a further one, only one can be added
        ways = [(kind.title.removeprefix(FURTHER), partial(with_element, state, kind)) for kind in kinds]
    else:
        absent = [each for each in fields_of(type(state.element)) if getattr(state.element, each.name) is None]
        ways = [(field.title, partial(with_attribute, state, field)) for field in absent if field.keyed]
    for title, add in ways:
        with suppress(LookupError, ElementError):
            yield title, add()


def with_element(before: State, kind: type[Element]) -> State:
    """The state with a new element, which is selected. The first shape of a scene without any lamp brings one."""
    element, last = default_element(kind, before), len(before.scene.elements) - 1
    lamps = [first_lamp(before)] if isinstance(element, Shape) and not before.scene.of(Lamp) else []
    apart = [""] if named_block(before.scene, last)[0] else []  # a blank line, so that it is not named like those above
    scene = before.scene.edit(last, before.scene.elements[last], *apart, element, *lamps)
    after = replace(before, value_index=0, added_kind=kind).change(scene, ELEMENT, 0.0, last + 1)
    return after.with_message(f"a new {element.title}{', and a light, since there was none' if lamps else ''}")


def with_attribute(before: State, field: Field) -> State:
    """The state whose selected element has a new attribute, which is active."""
    changed = before.element.replace(**{field.name: default_value(field, before, nice_number(SIZE * before.size))})
    after = before.change(before.scene.edit(before.selected, changed), ATTRIBUTE, 0.0)
    index = [value.field.name for value in values(changed)].index(field.name)
    return replace(after, value_index=index).with_message(f"{field.doc}: {field_text(field, changed)}")


def remove_attribute(state: State, _amount: float, _now: float) -> State:
    """Remove the attribute of the active value from the selected element."""
    active = state.active
    if not active.field.keyed:
        return state.with_message(f"{state.element.title} needs its {active.name}")
    after = without_attribute(state, active.field)
    if after.element == state.element:
        return state.with_message(f"{active.name} has its usual value: there is nothing to remove")
    return after.with_message(f"no {active.field.title} any more")


def without_attribute(before: State, field: Field) -> State:
    """The state whose selected element has lost an attribute, or has its default again."""
    changed = before.element.replace(**{field.name: field.default})
    return replace(before.change(before.scene.edit(before.selected, changed), "", 0.0), value_index=0)


# Default values.


def addable_kinds(scene: Scene) -> list[type[Element]]:
    """Kinds of elements that can be added to a scene: shapes first, kinds made from a mesh file last.

    Left out are kinds of which a scene has one and has it already.
    """
    there = {type(each) for kind in ELEMENTS.values() if kind.once for each in scene.of(kind)}
    missing = [kind for kind in ELEMENTS.values() if can_edit(kind) and not (kind.once and kind in there)]
    return sorted(missing, key=lambda kind: (bool(field_names(kind, MeshField)), not issubclass(kind, Shape)))


def default_element(kind: type[Element], state: State) -> Element:
    """Make an element of default values where the state aims; a shape stands on the surface there.

    LookupError if it needs a picture or mesh file and there is none beside the scene.
    """
    if issubclass(kind, Camera):  # which sees what is seen now
        return state.scene.camera.as_kind(kind)
    aim = state.aim or aim_ahead(state.scene.camera, state.size)
    if type(aim.beneath) is kind:  # a ball on a ball is of its colour, and not much smaller
        length = min(STACKED * aim.size, aim.usual)
        like = default_record(kind, state, clamp_length(round(length, leading_decimal(length) + 1)))
        return settled(like.replace(colour=aim.beneath.colour), aim, state.scene, state.stride)
    made = default_record(kind, state, one_digit(aim.size))
    return settled(made, aim, state.scene, state.stride) if isinstance(made, Shape) else made


def default_record(kind: type[RecordType], state: State, length: float) -> RecordType:
    """Make a record of default values, such as the value of an attribute; `length` is the usual one.

    LookupError as in `default_element`.
    """
    fields = [field for field in fields_of(kind) if field.required]
    points = iter(default_points(kind, state, sum(isinstance(field, Point) for field in fields)))
    made = (next(points) if isinstance(each, Point) else default_value(each, state, length) for each in fields)
    return kind(**dict(zip((each.name for each in fields), made, strict=True)))


def one_digit(length: float) -> float:
    """Round a length to its leading digit."""
    return clamp_length(round(length, leading_decimal(length)))


def default_points(kind: type[Record], state: State, count: int) -> list[Triple]:
    """The point aimed at, or `count` points on a circle around it, parallel to the image plane.

    What has no surface hangs half of the size of a new shape in front of a surface there, so that a lamp lights it.
    """
    aim = state.aim or aim_ahead(state.scene.camera, state.size)
    right, up, _ = camera_frame(state.scene.camera)
    middle = aim.point
    if aim.normal and not issubclass(kind, Shape):
        middle = linear_combination(1.0, aim.point, aim.usual / 2, aim.normal)
    radius = one_digit(aim.size) / 2 if count > 1 else 0.0
    angles = [pi / 2 + 2 * pi * corner / max(count, 1) for corner in range(count)]
    offsets = [linear_combination(radius * cos(angle), right, radius * sin(angle), up) for angle in angles]
    return [round_point(clamp_point(linear_combination(1.0, middle, 1.0, offset)), state.stride) for offset in offsets]


def first_lamp(state: State) -> Light:
    """A lamp for a scene without any: above the camera's left shoulder, at a distance that lights what it looks at."""
    camera = state.scene.camera
    right, _, _ = camera_frame(camera)
    beside = linear_combination(-SHOULDER * state.size, right, SHOULDER * state.size, UP)
    position = clamp_point(linear_combination(1.0, camera.position, 1.0, beside))
    return Light(position=round_point(position, state.stride), brightness=LAMP_BRIGHTNESS)


def default_value(field: Field, state: State, length: float) -> Any:
    """Default value of a field that is not a point; LookupError as in `default_element`."""
    if isinstance(field, Compound):
        return field.check(field.parse(field.bare)) if field.bare else default_record(field.record, state, length)
    if isinstance(field, (Picture, MeshField)):
        is_mesh = isinstance(field, MeshField)
        for file in usable_files(state.scene, is_mesh):
            return file
        raise LookupError("there is no mesh beside the scene" if is_mesh else "there is no picture beside the scene")
    if isinstance(field, Lengths):
        return length, length, length
    if isinstance(field, Length) and field.unit:
        return round_length(clamp_length(length * (field.initial or 1)))
    usual = field.instead if field.initial is None and isinstance(field, Direction) else field.initial
    if usual is None and isinstance(field, Real):
        usual = (field.low + field.high) / 2
    if usual is None:
        raise LookupError(f"{field.title} has no default value")
    return usual
