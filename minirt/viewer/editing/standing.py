"""Stand shapes on surfaces, drop them onto what lies beneath, and snap them to a grid."""

from __future__ import annotations

from math import dist, hypot, isfinite

from minirt.element import Element
from minirt.fields import Point, Triple
from minirt.rendering.queries.beneath import clearance
from minirt.scene import Scene
from minirt.shapes import Shape
from minirt.viewer.editing.motion import translate
from minirt.viewer.editing.projection import UP, Aim, dot, extent, subtract
from minirt.viewer.editing.state import State, field_names, position_of
from minirt.viewer.editing.values import round_point

LEVEL = 0.35  # cosine of the slope of a surface, of 70 degrees, on which shapes still come to rest
POINT_ROUNDING = 1 / 100  # of a step, to a tenth of which the points of a standing shape are rounded
SAME = 1 / 50  # of a step: positions closer than this differ by rounding
FLAT_LIFT = 0.01  # of its radius: how far above a surface a flat shape lies
DOWN = (0.0, -1.0, 0.0)


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
    at, _ = translate(shape, subtract(point, middle), 1.0)
    assert isinstance(at, Shape)
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


def shifted(shape: Shape, direction: Triple, distance: float) -> Shape:
    """Move a shape along a direction."""
    moved, _ = translate(shape, direction, distance)
    assert isinstance(moved, Shape)
    return moved


def middle_of(shape: Shape) -> tuple[Triple, float]:
    """Middle and radius of a bounded shape."""
    found = extent(shape)
    assert found
    return found


def aligned(shape: Shape, x: float, z: float) -> Shape:
    """Move a shape horizontally so that its middle lies above or below x, z."""
    middle, _ = middle_of(shape)
    return shifted(shifted(shape, (1.0, 0.0, 0.0), x - middle[0]), (0.0, 0.0, 1.0), z - middle[2])


def above(shape: Shape, support: Shape) -> Shape:
    """Raise a bounded shape until all of it is above another one."""
    box, other = shape.bounds(), support.bounds()
    assert box
    assert other
    return shifted(shape, UP, max(0.0, other[1][1] - box[0][1]))


def dropped(shape: Shape, scene: Scene, grid: float | None) -> Shape | None:
    """Lower or raise a bounded shape onto what lies beneath it, or onto the ground y = 0; None if nothing does.

    Its middle goes onto the middle of the shape beneath, if that is within its radius, or else onto lines of a grid.
    """
    (x, _, z), radius = middle_of(shape)
    others = [each for each in scene.shapes if each is not shape]
    _, support = clearance(shape, others)
    centre = middle_of(support)[0] if support and support.bounds() else None
    if support and centre and hypot(centre[0] - x, centre[2] - z) <= radius:
        there = above(aligned(shape, centre[0], centre[2]), support)
    else:
        there = shape if grid is None else aligned(shape, grid * round(x / grid), grid * round(z / grid))
    gap, support = clearance(there, others)
    box = there.bounds()
    if support is None and box and box[1][1] > 0:
        gap = box[0][1]
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
