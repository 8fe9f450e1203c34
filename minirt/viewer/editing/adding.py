"""Default elements and attributes: one of every kind that a scene file knows, made from its table of fields alone."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import Any, TypeVar

from minirt.element import Element, Record, fields_of
from minirt.fields import (
    FARTHEST,
    LEAST_LENGTH,
    Direction,
    Field,
    Length,
    Lengths,
    MeshField,
    Picture,
    Point,
    Real,
    Triple,
    clamp,
)
from minirt.materials import Compound
from minirt.scene import Light, Scene
from minirt.scene.elements import camera_frame, linear_combination
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.editing.motion import clamp_point
from minirt.viewer.editing.projection import UP, aim_ahead
from minirt.viewer.editing.standing import settled
from minirt.viewer.editing.state import State, can_edit
from minirt.viewer.editing.values import leading_decimal, nice_number, round_length, round_point
from minirt.viewer.files import meshes, pictures

SIZE = 1 / 8  # of lengths in a new attribute, as a share of the scene's size
LAMP_SHARE = 0.6  # of the way to a surface: where a new lamp hangs
LAMP_BRIGHTNESS = 0.8  # of the lamp that the first shape brings

RecordType = TypeVar("RecordType", bound=Record)


def addable_kinds(scene: Scene) -> list[type[Element]]:
    """Kinds of elements that can be added to a scene: shapes first, kinds made from a mesh file last.

    Left out are kinds of which a scene has one and has it already, and kinds that need a mesh file where there is none.
    """
    missing = [kind for kind in ELEMENTS.values() if can_edit(kind) and not (kind.once and contains_kind(scene, kind))]
    files = next(meshes(scene), None) is not None
    useful = [kind for kind in missing if files or not needs_mesh(kind)]
    return sorted(useful, key=lambda kind: (needs_mesh(kind), not issubclass(kind, Shape)))


def needs_mesh(kind: type[Element]) -> bool:
    """Whether elements of the kind are made from a mesh file."""
    return any(isinstance(field, MeshField) for field in fields_of(kind))


def contains_kind(scene: Scene, kind: type[Element]) -> bool:
    """Whether a scene has an element of exactly this kind."""
    return any(type(each) is kind for each in scene.of(kind))


def default_element(kind: type[Element], state: State) -> Element:
    """Make an element of default values where the state aims; a shape stands on the surface there.

    LookupError if it needs a picture or mesh file and there is none beside the scene.
    """
    aim = state.aim or aim_ahead(state.scene.camera, state.size)
    made = kind(**dict(required_values(kind, state, one_digit(aim.size))))
    return settled(made, aim, state.scene, state.stride) if isinstance(made, Shape) else made


def default_record(kind: type[RecordType], state: State) -> RecordType:
    """Make a record of default values, such as the value of an attribute. LookupError as in `default_element`."""
    return kind(**dict(required_values(kind, state, nice_number(SIZE * state.size))))


def one_digit(length: float) -> float:
    """Round a length to its leading digit."""
    return clamp(round(length, leading_decimal(length)), LEAST_LENGTH, FARTHEST)


def required_values(kind: type[Record], state: State, length: float) -> Iterator[tuple[str, Any]]:
    """Yield names and default values of the required fields; `length` is the usual one."""
    fields = [field for field in fields_of(kind) if field.required]
    points = iter(default_points(kind, state, sum(isinstance(field, Point) for field in fields)))
    for field in fields:
        yield field.name, next(points) if isinstance(field, Point) else default_value(field, state, length)


def default_points(kind: type[Record], state: State, count: int) -> list[Triple]:
    """The point aimed at, or `count` points on a circle around it, parallel to the image plane.

    What has no surface hangs on the way there, so that a lamp lights the surface that it is aimed at.
    """
    aim = state.aim or aim_ahead(state.scene.camera, state.size)
    right, up, _ = camera_frame(state.scene.camera)
    middle = aim.point
    if aim.normal and not issubclass(kind, Shape):
        middle = linear_combination(1 - LAMP_SHARE, aim.eye, LAMP_SHARE, aim.point)
    radius = one_digit(aim.size) / 2 if count > 1 else 0.0
    angles = [pi / 2 + 2 * pi * corner / max(count, 1) for corner in range(count)]
    offsets = [linear_combination(radius * cos(angle), right, radius * sin(angle), up) for angle in angles]
    return [round_point(clamp_point(linear_combination(1.0, middle, 1.0, offset)), state.stride) for offset in offsets]


def first_lamp(state: State) -> Light:
    """A lamp for a scene without any: above the camera's left shoulder, at a distance that lights what it looks at."""
    camera = state.scene.camera
    right, _, _ = camera_frame(camera)
    beside = linear_combination(-LAMP_SHARE * state.size, right, LAMP_SHARE * state.size, UP)
    position = clamp_point(linear_combination(1.0, camera.position, 1.0, beside))
    return Light(position=round_point(position, state.stride), brightness=LAMP_BRIGHTNESS)


def default_value(field: Field, state: State, length: float | None = None) -> Any:
    """Default value of a field that is not a point; LookupError as in `default_record`."""
    if isinstance(field, Compound):
        return field.check(field.parse(field.bare)) if field.bare else default_record(field.record, state)
    if isinstance(field, (Picture, MeshField)):
        noun, files = ("picture", pictures) if isinstance(field, Picture) else ("mesh", meshes)
        return first_file(noun, files(state.scene))
    length = nice_number(SIZE * state.size) if length is None else length
    if isinstance(field, Lengths):
        return length, length, length
    if isinstance(field, Length) and field.unit:
        return round_length(clamp(length * (field.initial or 1), LEAST_LENGTH, FARTHEST))
    return constant_default(field)


def constant_default(field: Field) -> Any:
    """Default value of a field, independent of the scene; LookupError if it has none."""
    if field.initial is not None:
        return field.initial
    if isinstance(field, Direction):
        return field.instead
    if isinstance(field, Real):
        return (field.low + field.high) / 2
    raise LookupError(f"{field.name} has no default value")


def first_file(noun: str, files: Iterator[Any]) -> Any:
    """Return the first file beside the scene; LookupError if there is none."""
    for file in files:
        return file
    raise LookupError(f"there is no {noun} beside the scene")
