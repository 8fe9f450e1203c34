"""New elements and attributes, made from tables of fields alone, and where shapes stand.

Shapes stand on surfaces, drop onto what lies beneath, and snap to a grid.
"""

from __future__ import annotations

from math import cos, dist, hypot, isfinite, pi, sin
from typing import Any

from minirt.element import Element, Record, fields_of
from minirt.fields import Direction, Field, Length, Lengths, MeshField, Picture, Point, Real, Triple, clamp_length
from minirt.materials import Compound
from minirt.rendering.packing.camera import camera_frame
from minirt.rendering.queries.pick import clearance
from minirt.scene import Light, Scene
from minirt.scene.elements import linear_combination
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.editing.motion import clamp_point, shifted
from minirt.viewer.editing.projection import UP, Aim, aim_ahead, dot, extent, field_names, position_of, subtract
from minirt.viewer.editing.state import State, can_edit
from minirt.viewer.editing.values import RecordType, leading_decimal, round_length, round_point
from minirt.viewer.files import usable_files

LEVEL = 0.35  # cosine of the slope of a surface, of 70 degrees, on which shapes still come to rest
POINT_ROUNDING = 1 / 100  # of a step, to a tenth of which the points of a standing shape are rounded
SAME = 1 / 50  # of a step: positions closer than this differ by rounding
FLAT_LIFT = 0.01  # of its radius: how far above a surface a flat shape lies
DOWN = (0.0, -1.0, 0.0)
SIZE = 1 / 8  # of lengths in a new attribute, as a share of the scene's size
LAMP_SHARE = 0.6  # of the way to a surface: where a new lamp hangs
LAMP_BRIGHTNESS = 0.8  # of the lamp that the first shape brings


def stand(shape: Shape, point: Triple, normal: Triple) -> Shape:
    """Move a shape along the normal of a surface so that it touches the plane through `point` from outside."""
    lowest = lowest_along(shape, normal)
    if lowest is None:
        return shape
    x, y, z = normal
    flat = -lowest == lowest_along(shape, (-x, -y, -z))  # it lies on the surface, which would hide it
    lift = FLAT_LIFT * (extent(shape) or (point, 0.0))[1] if flat else 0.0
    return shifted(shape, normal, dot(point, normal) - lowest + lift)


def settled(shape: Shape, aim: Aim, scene: Scene, stride: float) -> Shape:
    """Put a shape where the pointer aims, standing on the other shapes of a scene.

    Upright surfaces are touched from outside; on others it comes to rest as if it were dropped there.
    """
    if aim.normal is None or shape.bounds() is None:
        return shape
    normal, (middle, _) = aim.normal, middle_of(shape)
    point = tidy_point(aim.point, normal, stride)
    at = shifted(shape, subtract(point, middle))
    rests = LEVEL < normal[1] < 1
    standing = stand(at, point, UP if rests else normal)
    if rests:
        standing = dropped(standing, scene, None) or standing
    points = {name: getattr(standing, name) for name in field_names(type(shape), Point)}
    return standing.replace(**{name: round_point(each, POINT_ROUNDING * stride) for name, each in points.items()})


def tidy_point(point: Triple, normal: Triple, stride: float) -> Triple:
    """Round a point to a tenth of a step, where the surface is parallel to two axes and the point stays on it."""
    if max(map(abs, normal)) < 1:
        return point
    (x, y, z), (a, b, c) = point, round_point(point, stride)
    return x if normal[0] else a, y if normal[1] else b, z if normal[2] else c


def keep_standing(state: State, changed: Element) -> Element:
    """The changed version of the selected element; one that still is where it was added stands there again."""
    old, aim = state.element, state.aim
    if aim is None or not isinstance(old, Shape) or not isinstance(changed, Shape):
        return changed
    scene, stride = state.scene.edit(state.selected), state.stride
    before, there = position_of(old), position_of(settled(old, aim, scene, stride))
    stands = before and there and dist(before, there) < SAME * stride
    return settled(changed, aim, scene, stride) if stands else changed


def lowest_along(shape: Shape, direction: Triple) -> float | None:
    """Least coordinate of a shape along a direction, by its box and its balls; None for an infinite shape."""
    box = shape.bounds()
    if box is None:
        return None
    by_box = sum(min(low * part, high * part) for low, high, part in zip(*box, direction, strict=True))
    by_balls = (dot(centre, direction) - radius for centre, radius in shape.balls())
    return max(by_box, min(by_balls, default=by_box))


def middle_of(shape: Shape) -> tuple[Triple, float]:
    """Middle and radius of a bounded shape."""
    found = extent(shape)
    assert found
    return found


def dropped(shape: Shape, scene: Scene, grid: float | None) -> Shape | None:
    """Lower or raise a bounded shape onto what lies beneath it, or onto the ground y = 0; None if nothing does.

    Its middle goes onto the middle of the shape beneath, if that is within its radius, or else onto lines of a grid.
    """
    (x, _, z), radius = middle_of(shape)
    others = [each for each in scene.shapes if each is not shape]
    _, support = clearance(shape, others)
    box, below = shape.bounds(), support.bounds() if support else None
    assert box
    centre = middle_of(support)[0] if support and below else None
    rise = 0.0
    if below and centre and hypot(centre[0] - x, centre[2] - z) <= radius:
        x_to, z_to, rise = centre[0], centre[2], max(0.0, below[1][1] - box[0][1])  # all of it is above the other
    else:
        x_to, z_to = (each if grid is None else grid * round(each / grid) for each in (x, z))
    there = shifted(shape, (x_to - x, rise, z_to - z))
    gap, support = clearance(there, others)
    low, high = box[0][1] + rise, box[1][1] + rise
    if support is None and high > 0:
        gap = low
    return shifted(there, DOWN, gap) if isfinite(gap) else None


def drop(state: State, _amount: float, now: float) -> State:
    """Drop the selected shape onto what lies beneath, on a grid or in the middle."""
    shape = state.element
    if not isinstance(shape, Shape) or shape.bounds() is None:
        return state.with_message(f"{shape.title} cannot stand on anything")
    there = dropped(shape, state.scene.edit(state.selected), state.stride)
    if there is None:
        return state.with_message(f"there is nothing beneath the {shape.title}")
    return state.edit_element(there, "", now).with_message(f"on what lies beneath, on a grid of {state.stride:g}")


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
    aim = state.aim or aim_ahead(state.scene.camera, state.size)
    made = default_record(kind, state, one_digit(aim.size))
    return settled(made, aim, state.scene, state.stride) if isinstance(made, Shape) else made


def default_record(kind: type[RecordType], state: State, length: float) -> RecordType:
    """Make a record of default values, such as the value of an attribute; `length` is the usual one.

    LookupError as in `default_element`.
    """
    fields = [field for field in fields_of(kind) if field.required]
    points = iter(default_points(kind, state, sum(isinstance(field, Point) for field in fields)))
    return kind(
        **{
            field.name: next(points) if isinstance(field, Point) else default_value(field, state, length)
            for field in fields
        }
    )


def one_digit(length: float) -> float:
    """Round a length to its leading digit."""
    return clamp_length(round(length, leading_decimal(length)))


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


def default_value(field: Field, state: State, length: float) -> Any:
    """Default value of a field that is not a point; LookupError as in `default_element`."""
    if isinstance(field, Compound):
        return field.check(field.parse(field.bare)) if field.bare else default_record(field.record, state, length)
    if isinstance(field, (Picture, MeshField)):
        for file in usable_files(state.scene, isinstance(field, MeshField)):
            return file
        raise LookupError(f"there is no file for {field.name} beside the scene")
    if isinstance(field, Lengths):
        return length, length, length
    if isinstance(field, Length) and field.unit:
        return round_length(clamp_length(length * (field.initial or 1)))
    usual = field.instead if field.initial is None and isinstance(field, Direction) else field.initial
    if usual is None and isinstance(field, Real):
        usual = (field.low + field.high) / 2
    if usual is None:
        raise LookupError(f"{field.name} has no default value")
    return usual
