"""Aim of the pointer: the place in the scene where a new element goes, and the size that suits it there."""

from __future__ import annotations

from math import dist
from typing import NamedTuple

from minirt.fields import Triple
from minirt.rendering.queries.pick import surface_normal
from minirt.scene import Camera
from minirt.scene.camera_frame import linear_combination
from minirt.shapes import Shape
from minirt.viewer.editing.measure import UP, looked_at_distance
from minirt.viewer.editing.projection import Projection, projection_of

FAR = 4.0  # times the scene's size: what is farther away is background, on which nothing stands
SHARE = 1 / 4  # of the picture's shorter side: the size of a new element
PICTURE = 640, 360  # pixels of a usual window, where none is known


class Aim(NamedTuple):
    """The place where the line of sight through a pixel ends."""

    eye: Triple
    point: Triple
    normal: Triple | None  # of the surface there, towards the eye; None in the air
    size: float  # of an element that fills SHARE of the picture at this depth


def aim(view: Projection, size: float, x: float, y: float, shape: Shape | None, point: Triple | None) -> Aim:
    """Aim through a point of the picture, at the `point` of a shape, at the ground y = 0, or at `size` from the eye.

    size: of the scene.
    """
    ray = view.ray(x, y)
    normal: Triple | None = None
    if shape and point and dist(view.eye, point) <= FAR * size:
        normal = surface_normal(shape, point, ray)
    else:
        distance = ground_distance(view.eye, ray)
        point = linear_combination(1.0, view.eye, size if distance is None else distance, ray)
        if distance is None or shape or distance > FAR * size:
            point = linear_combination(1.0, view.eye, size, ray)
        else:
            point, normal = (point[0], 0.0, point[2]), UP if view.eye[1] > 0 else (0.0, -1.0, 0.0)
    return Aim(view.eye, point, normal, SHARE * picture_side(view, point))


def aim_ahead(camera: Camera, size: float) -> Aim:
    """Aim through the middle of the picture, a little below it, without a look at the shapes."""
    width, height = PICTURE
    view = projection_of(camera, width, height)
    return aim(view, size or looked_at_distance(camera), width / 2, 0.55 * height, None, None)


def ground_distance(eye: Triple, ray: Triple) -> float | None:
    """Distance along a ray to the ground y = 0; None where the ray does not reach it."""
    return -eye[1] / ray[1] if eye[1] * ray[1] < 0 else None


def picture_side(view: Projection, point: Triple) -> float:
    """Length of the picture's shorter side in the scene, at the depth of a point."""
    depth = view.depth(point)
    middle = view.point_at_depth(view.width / 2, view.height / 2, depth)
    sides = view.point_at_depth(0.0, view.height / 2, depth), view.point_at_depth(view.width / 2, 0.0, depth)
    return 2 * min(dist(middle, side) for side in sides)
