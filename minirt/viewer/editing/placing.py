"""Aim at a place for a shape; place it on the surface there, along its normal, on what lies beneath, or on a grid."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, dist, hypot, inf, isfinite

from minirt.element import Element, fields_of
from minirt.fields import Direction, Point, Triple, clamp_length, neat
from minirt.rendering.queries.pick import clearance, first_hit, surface_normal
from minirt.scene import Camera, Scene
from minirt.scene.elements import linear_combination
from minirt.shapes import Shape
from minirt.shapes.shape import Oriented
from minirt.viewer.editing import projection
from minirt.viewer.editing.projection import STEP_SHARE, UP, Aim, Projection, dot, field_names, position_of, subtract
from minirt.viewer.editing.rigid import frame_of, shifted
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import nice_number, round_changes, round_point

LEVEL = 0.35  # cosine of the slope of a surface, of 70 degrees, on which shapes without an axis still come to rest
POINT_ROUNDING = 1 / 100  # of a step, to a tenth of which the points of a standing shape are rounded
SAME = 1 / 50  # of a step: positions closer than this differ by rounding
FLAT_LIFT = 0.01  # of its radius: how far above a surface a flat shape lies
DOWN = (0.0, -1.0, 0.0)
GRID_REACH = 3.0  # cells of the grid between a point of a surface and the next one on the grid
AHEAD = 0.55  # of the picture's height: where an element goes while there is no pointer
PICTURE = 640, 360  # pixels of a usual window, where none is known
BACKGROUND = 4.0  # times the scene's size: what is farther away is background, on which nothing stands
SHARE = 1 / 4  # of the picture's shorter side: the size of a new element
TOP = 0.5  # cosine of the slope, of 60 degrees, up to which a surface is the top of its shape
TINY = 1 / 8  # of the usual size of an element that stands on nothing
TOP_SHARE, SIDE_SHARE = 1 / 2, 1 / 4  # of the breadth of a shape: the size of a new element on its top, or elsewhere


def aim(view: Projection, size: float, x: float, y: float, shape: Shape | None, point: Triple | None) -> Aim:
    """Aim through pixel x, y at the `point` of a `shape` that is seen there, or without a shape at the ground y = 0.

    Where the shape or the ground is farther away than BACKGROUND times `size`, the size of the scene, the aim is in the
    air, at `size` from the eye. On a surface it is at the nearest point whose coordinates along it are on a grid, of
    which a new element there spans at least two cells.
    """
    ray, height = view.ray(x, y), view.eye[1]
    to_ground = -height / ray[1] if height * ray[1] < 0 else inf  # distance; infinity where the ray goes away from it
    normal: Triple | None = None
    if shape and point and dist(view.eye, point) <= BACKGROUND * size:
        normal = surface_normal(shape, point, ray)
    elif shape or to_ground > BACKGROUND * size:  # a shape beyond that, too, is background
        shape, point = None, linear_combination(1.0, view.eye, size, ray)
    else:
        x, _, z = linear_combination(1.0, view.eye, to_ground, ray)
        point = x, 0.0, z
        normal = UP if height > 0 else DOWN
    if normal:
        cell = min(STEP_SHARE * size, size_of_new(view, shape, point, normal) / 2)
        point, normal = on_grid(shape, point, normal, nice_number(cell))
    return aim_at(view, shape, point, normal)


def aim_at(view: Projection, shape: Shape | None, point: Triple, normal: Triple | None) -> Aim:
    """Aim at a point with the `normal` of the surface there; without a shape of the ground, None in the air."""
    return Aim(
        eye=view.eye,
        point=point,
        normal=normal,
        size=size_of_new(view, shape, point, normal),
        usual=size_of_new(view, None, point, None),
        beneath=beneath(shape, normal),
    )


def aim_at_top(view: Projection, shape: Shape) -> Aim | None:
    """Aim at the top of a bounded shape, above its middle; None where what stands there would hardly be seen."""
    box, ((x, _, z), radius) = shape.bounds(), middle_of(shape)
    assert box
    found = first_hit(shape, (x, box[1][1] + radius, z), (0.0, -1.0, 0.0))
    point, normal = found or ((x, box[1][1], z), UP)
    there = aim_at(view, shape, point, normal)
    return there if there.size >= TINY * there.usual else None


def beneath(shape: Shape | None, normal: Triple | None) -> Shape | None:
    """The shape, if it is bounded and its surface there is its top."""
    return shape if shape and normal and normal[1] > TOP and shape.bounds() else None


def size_of_new(view: Projection, shape: Shape | None, point: Triple, normal: Triple | None) -> float:
    """Size of a new element at a point: SHARE of the picture, and at most a share of the shape that it stands on, which
    is None for other elements; `normal` is None in the air."""
    size = 2 * SHARE * view.depth(point) * min(hypot(*view.right), hypot(*view.up))
    box = shape.bounds() if shape and normal else None
    if box and normal:
        breadth = sorted(subtract(box[1], box[0]))[1]  # the second longest edge of the box
        size = min(abs(size), breadth * (TOP_SHARE if beneath(shape, normal) else SIDE_SHARE))
    return clamp_length(size)


def on_grid(shape: Shape | None, point: Triple, normal: Triple, grid: float) -> tuple[Triple, Triple]:
    """Return the point of a surface that is next to `point` and has two coordinates on a grid, and the normal there.

    The third coordinate is the one along which the `normal` at the point is longest. Without a shape the surface is the
    ground y = 0. Where the shape has no such point close by, the result is `point` and `normal` themselves. grid: scene
    units between its points.
    """
    along = max(range(3), key=lambda axis: abs(normal[axis]))
    x, y, z = (part if axis == along else grid * round(part / grid) for axis, part in enumerate(point))
    if shape is None:
        return (x, y, z), normal
    way, reach = [0.0, 0.0, 0.0], GRID_REACH * grid
    way[along] = -copysign(1.0, normal[along])
    inward = way[0], way[1], way[2]  # along the third coordinate
    start = linear_combination(1.0, (x, y, z), -reach, inward)
    found = first_hit(shape, start, inward)
    return found if found and dist(found[0], start) <= 2 * reach else (point, normal)


def aim_ahead(camera: Camera, size: float) -> Aim:
    """Aim through the middle of the picture, a little below it, without a look at the shapes."""
    width, height = PICTURE
    return aim(projection.projection_of(camera, width, height), size, width / 2, AHEAD * height, None, None)


def middle_of(shape: Shape) -> projection.Extent:
    """Return the centre and the radius of a bounded shape: see `projection.extent`."""
    found = projection.extent(shape)
    assert found
    return found


def settled(shape: Shape, aim: Aim, scene: Scene, stride: float) -> Shape:
    """Put a shape where the pointer aims, standing on the other shapes of a scene.

    Its axis is along the normal there. On top of things it is upright and comes to rest as if it were dropped there.
    """
    if aim.normal is None or shape.bounds() is None:
        return shape
    rests = aim.normal[1] > (TOP if direction_of(shape) else LEVEL)
    standing = stand(shape, aim.point, UP if rests else aim.normal)
    if rests and aim.normal[1] < 1:
        standing = dropped(standing, scene, None) or standing
    points = {name: getattr(standing, name) for name in field_names(type(shape), Point)}
    return standing.replace(**{name: round_point(each, POINT_ROUNDING * stride) for name, each in points.items()})


def direction_of(shape: Shape) -> Direction | None:
    """Return the field of the axis or the normal of a shape; None if another one would not change the picture."""
    if not isinstance(shape, Oriented) or not shape.shows_axis:
        return None
    return next(each for each in fields_of(type(shape)) if isinstance(each, Direction))


def turned_up(shape: Shape, field: Direction, up: Triple) -> Shape:
    """Turn a shape so that what is up in a new shape of its kind points along the unit vector `up`."""
    x, y, z = up
    sign = copysign(1.0, (field.initial or field.instead)[1])
    return shape.replace(**{field.name: neat((sign * x, sign * y, sign * z))})


def stand(shape: Shape, point: Triple, normal: Triple) -> Shape:
    """Put a bounded shape onto a point of a surface, turned so that it stands there as it would on level ground."""
    field = direction_of(shape)
    if field is None:
        at = shifted(shape, subtract(point, middle_of(shape)[0]))
        return shifted(at, normal, dot(point, normal) - lowest_along(at, normal) + lift_of(at, normal))
    level, turned = turned_up(shape, field, UP), turned_up(shape, field, normal)
    (x, _, z), position, there = middle_of(level)[0], position_of(level), position_of(turned)
    assert position and there  # noqa: PT018 - what has a direction has a position
    offset = subtract(position, (x, lowest_along(level, UP) - lift_of(level, UP), z))
    for old, new in zip(frame_of(level), frame_of(turned), strict=True):
        point = linear_combination(1.0, point, dot(offset, old), new)
    return shifted(turned, subtract(point, there))


def lift_of(shape: Shape, normal: Triple) -> float:
    """Distance of a shape above its surface: more than 0 for flat ones, which the surface would hide."""
    x, y, z = normal
    flat = -lowest_along(shape, normal) == lowest_along(shape, (-x, -y, -z))
    return FLAT_LIFT * middle_of(shape)[1] if flat else 0.0


def keep_standing(state: State, old: Element, changed: Element) -> Element:
    """Return the changed selected element, which was `old`, put so that it stands where it stood.

    An element that is moved, or is no bounded shape, is returned as it is. A shape that still is where it was added,
    and is not turned, is settled there again. Any other shape that stands on something keeps its lower end: it grows
    upwards, and neither sinks nor floats when it turns.
    """
    if not isinstance(old, Shape) or not isinstance(changed, Shape) or old.bounds() is None:
        return changed
    points = {name: getattr(old, name) for name in field_names(type(old), Point)}
    if any(getattr(changed, name) != point for name, point in points.items()):
        return changed
    turns = *field_names(type(old), Direction), "roll"
    turned = any(getattr(old, name, None) != getattr(changed, name, None) for name in turns)
    stride = state.stride
    if state.aim and not turned:
        scene = state.scene.edit(state.selected)
        there = settled(old, state.aim, scene, stride)
        near = all(dist(at, getattr(there, name)) < SAME * stride for name, at in points.items())
        if near and there.replace(**points) == old:
            return settled(changed, state.aim, scene, stride)
    if not turned:
        changed = round_changes(old, changed, stride)  # so that the end does not drift by what is rounded later
    rise = lowest_along(old, UP) - lowest_along(changed, UP)
    gap = gap_below(old, state.scene.edit(state.selected).shapes) if rise else inf
    if abs(gap) > SAME * stride:  # it stands on nothing, or its lower end has not moved
        return changed
    grid = POINT_ROUNDING * stride
    return shifted(changed, UP, grid * round((rise - gap) / grid) if turned else rise)


def gap_below(shape: Shape, others: Sequence[Shape]) -> float:
    """How far a bounded shape can fall onto others, or onto the ground y = 0."""
    gap, support = clearance(shape, others)
    box = shape.bounds()
    assert box
    on_ground = support is None and box[1][1] > 0
    return box[0][1] if on_ground else gap


def lowest_along(shape: Shape, direction: Triple) -> float:
    """Least coordinate of a bounded shape along a direction, by its box and its balls."""
    box = shape.bounds()
    assert box
    by_box = sum(min(low * part, high * part) for low, high, part in zip(*box, direction, strict=True))
    by_balls = (dot(centre, direction) - radius for centre, radius in shape.balls())
    return max(by_box, min(by_balls, default=by_box))


def dropped(shape: Shape, scene: Scene, grid: float | None) -> Shape | None:
    """Lower or raise a bounded shape onto what lies beneath it, or onto the ground y = 0; None if nothing is beneath.

    The middle of the shape goes above the middle of a bounded shape beneath, if that is within its radius, or else onto
    lines of a grid: `grid` scene units apart, None for no grid.
    """
    (x, _, z), radius = middle_of(shape)
    others = [each for each in scene.shapes if each is not shape]
    _, support = clearance(shape, others)
    box, below = shape.bounds(), support.bounds() if support else None
    assert box
    centre = middle_of(support)[0] if support and below else None
    rise = 0.0
    if below and centre and hypot(centre[0] - x, centre[2] - z) <= radius:
        (_, bottom, _), (_, top, _) = box[0], below[1]
        x_to, z_to, rise = centre[0], centre[2], max(0.0, top - bottom)  # wholly above the shape beneath
    else:
        x_to, z_to = (each if grid is None else grid * round(each / grid) for each in (x, z))
    there = shifted(shape, (x_to - x, rise, z_to - z))
    gap = gap_below(there, others)
    return shifted(there, DOWN, gap) if isfinite(gap) else None
