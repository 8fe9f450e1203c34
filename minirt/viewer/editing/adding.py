"""New elements and attributes: one of every kind that a scene file knows, made from the table of its fields alone."""

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
from minirt.scene import Scene
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.editing.motion import limited
from minirt.viewer.editing.number_format import decimals, nice, round_length
from minirt.viewer.editing.state import State, can_edit
from minirt.viewer.files.asset_files import meshes, pictures

AWAY = 1 / 2  # of the scene's size: how far in front of the camera
LARGE = 1 / 8  # of the scene's size: what is added

Made = TypeVar("Made", bound=Record)


def kinds(scene: Scene) -> list[type[Element]]:
    """What can be added to a scene: shapes first, of what may be there once only what is missing, and last what takes a
    mesh, where there is one."""
    missing = [kind for kind in ELEMENTS.values() if can_edit(kind) and not (kind.once and has(scene, kind))]
    files = next(meshes(scene), None) is not None
    useful = [kind for kind in missing if files or not takes_mesh(kind)]
    return sorted(useful, key=lambda kind: (takes_mesh(kind), not issubclass(kind, Shape)))


def takes_mesh(kind: type[Element]) -> bool:
    """Whether it is made from a mesh file."""
    return any(isinstance(field, MeshField) for field in fields_of(kind))


def has(scene: Scene, kind: type[Element]) -> bool:
    """Whether there is an element of just that kind."""
    return any(type(each) is kind for each in scene.of(kind))


def made(kind: type[Made], state: State) -> Made:
    """An element of that kind in front of the camera, or a record; LookupError where it takes a picture or a mesh
    and there is none."""
    return kind(**dict(chosen(kind, state)))


def chosen(kind: type[Record], state: State) -> Iterator[tuple[str, Any]]:
    """The fields that must be given."""
    fields = [field for field in fields_of(kind) if field.required]
    places = iter(corners(state, sum(isinstance(field, Point) for field in fields)))
    for field in fields:
        yield field.name, next(places) if isinstance(field, Point) else usual(field, state)


def corners(state: State, count: int) -> list[Triple]:
    """The place in front of the camera, or so many places around it in the plane of the view.

    A little below the middle of the picture, so that a plane is not seen from its edge.
    """
    camera = state.scene.camera
    right, up, forward = camera_frame(camera)
    size = LARGE * state.size
    middle = linear_combination(
        1.0, linear_combination(1.0, camera.position, AWAY * state.size, forward), -size / 2, up
    )
    radius = size if count > 1 else 0.0
    turns = [pi / 2 + 2 * pi * corner / max(count, 1) for corner in range(count)]
    around = [linear_combination(radius * cos(turn), right, radius * sin(turn), up) for turn in turns]
    return [round_place(limited(linear_combination(1.0, middle, 1.0, each)), state.stride) for each in around]


def round_place(place: Triple, stride: float) -> Triple:
    """The place with as many decimals as a tenth of a step has."""
    x, y, z = (round(part, decimals(stride) + 1) for part in place)
    return x, y, z


def usual(field: Field, state: State) -> Any:
    """What any other field begins with; LookupError as above."""
    if isinstance(field, Compound):
        return field.check(field.parse(field.bare)) if field.bare else made(field.record, state)
    if isinstance(field, (Picture, MeshField)):
        sort, files = ("picture", pictures) if isinstance(field, Picture) else ("mesh", meshes)
        return first(sort, files(state.scene))
    length = nice(LARGE * state.size)
    if isinstance(field, Lengths):
        return length, length, length
    if isinstance(field, Length) and field.unit:
        return round_length(clamp(length * (field.initial or 1), LEAST_LENGTH, FARTHEST))
    return plain(field)


def plain(field: Field) -> Any:
    """What a field begins with that has nothing to do with the scene; LookupError where nobody knows."""
    if field.initial is not None:
        return field.initial
    if isinstance(field, Direction):
        return field.instead
    if isinstance(field, Real):
        return (field.low + field.high) / 2
    raise LookupError(f"nothing to begin {field.name} with")


def first(sort: str, files: Iterator[Any]) -> Any:
    """The first file beside the scene; LookupError where there is none."""
    for found in files:
        return found
    raise LookupError(f"there is no {sort} beside the scene")
