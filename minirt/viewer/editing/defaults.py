"""Values with which new elements and attributes begin."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

from minirt.element import Element, Record, fields_of
from minirt.fields import Direction, Field, Length, Lengths, MeshField, Picture, Point, Real, Triple, clamp_length
from minirt.materials import Compound
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Camera, Light
from minirt.scene.elements import linear_combination
from minirt.shapes import Shape
from minirt.viewer.editing.placing import aim_ahead, settled
from minirt.viewer.editing.projection import UP
from minirt.viewer.editing.rigid import clamp_point
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import RecordType, leading_decimal, round_length, round_point
from minirt.viewer.files import usable_files

SIZE = 1 / 8  # of lengths in a new attribute, as a share of the scene's size
STACKED = 1.5  # times the usual size on top of another shape: of a shape of the same kind
SHOULDER = 0.6  # of the scene's size: how far the lamp that the first shape brings is beside and above the camera
LAMP_BRIGHTNESS = 0.8  # of the lamp that the first shape brings


def default_element(kind: type[Element], state: State) -> Element:
    """Make an element of default values where `state` aims, or else ahead; a shape stands on the surface there.

    LookupError if a field needs a picture or mesh file and there is none beside the scene.
    """
    if issubclass(kind, Camera):  # the new camera sees what is seen now
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

    Fields that may be left out are, unless they have an initial value beside the default. LookupError as in
    `default_element`.
    """
    fields = [each for each in fields_of(kind) if each.required or None not in (each.initial, each.default)]
    points = iter(default_points(kind, state, sum(isinstance(field, Point) for field in fields)))
    made = (next(points) if isinstance(each, Point) else default_value(each, state, length) for each in fields)
    return kind(**dict(zip((each.name for each in fields), made, strict=True)))


def one_digit(length: float) -> float:
    """Round a length to its leading digit."""
    return clamp_length(round(length, leading_decimal(length)))


def default_points(kind: type[Record], state: State, count: int) -> list[Triple]:
    """The point aimed at, or `count` points on a circle around it, parallel to the image plane, the first on top.

    For an element without a surface, such as a lamp, they are in front of a surface that is aimed at, by half of the
    usual size of an element there, so that the lamp lights the surface.
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
    """Default value of a field that is not a point. LookupError if it has none, and as in `default_element`.
    `length`: the usual one of a new element, in scene units."""
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
