"""A second, independent renderer, which the tests compare the program with.

It draws planes, spheres, capped cylinders, ambient light and point lights with hard shadows, one ray a pixel, in plain
numpy float64. It shares no code with the program beyond the scene's dataclasses, and its geometry is written another
way: every solid is convex, so a ray is inside of it along one interval of distances, its chord, and the first end of
the chord in front of the origin is what is seen.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import singledispatch

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Camera, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere

Array = NDArray[np.float64]  # vectors have the shape (..., 3)

SAME_SURFACE = 1e-10  # relative difference of distances below which two surfaces count as coincident
OFF_SURFACE = 1e-10  # where a shadow ray starts, in distances from the surface relative to the coordinates


def render(scene: Scene, width: int, height: int) -> Array:
    """The linear picture, (height, width, 3), not clamped; the camera's field of view lies between 0 and 180."""
    origins, directions = camera_rays(scene.camera, width, height)
    distances, owners = first_hits(scene.shapes, origins, directions)
    picture = np.zeros((height, width, 3))
    for index, shape in enumerate(scene.shapes):
        seen = owners == index
        points = origins[seen] + distances[seen, None] * directions[seen]
        normal = normals(shape, points)
        facing = np.where(dot(normal, directions[seen])[:, None] > 0, -normal, normal)
        magnitude = distances[seen] + length(origins[seen]) + length(points)
        bent = np.where(dot(normal, directions[seen])[:, None] > 0, -1, 1) * shading(shape, points, normal)
        picture[seen] = rgb(shape.colour) * light_at(scene, points, facing, bent, OFF_SURFACE * magnitude)
    return picture


def to_bytes(linear: Array) -> NDArray[np.uint8]:
    """The picture as it is shown: clamped to [0, 1] and rounded to the nearest of 256 steps, halves upwards."""
    return np.floor(np.clip(linear, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def camera_rays(camera: Camera, width: int, height: int) -> tuple[Array, Array]:
    """Origin and unit direction of the ray through the centre of each pixel, (height, width, 3) each."""
    right, up, forward = camera_frame(camera)
    half = np.tan(np.radians(camera.fov) / 2)
    x = (2 * (np.arange(width) + 0.5) / width - 1) * half
    y = (1 - 2 * (np.arange(height) + 0.5) / height) * half * height / width
    rays = forward + x[None, :, None] * right + y[:, None, None] * up
    directions = rays / length(rays)[..., None]
    return np.broadcast_to(np.array(camera.position), directions.shape), directions


def camera_frame(camera: Camera) -> tuple[Array, Array, Array]:
    """What the camera calls right, up and forward: unit vectors."""
    forward = np.array(camera.direction)
    x, _, z = forward
    level = np.hypot(x, z)
    right = np.array([-z, 0.0, x]) / level if level > 0 else np.array([1.0, 0.0, 0.0])  # forward cross +y
    up = np.cross(right, forward)
    turn = np.radians(camera.roll)
    return np.cos(turn) * right - np.sin(turn) * up, np.cos(turn) * up + np.sin(turn) * right, forward


def first_hits(shapes: Iterable[Shape], origins: Array, directions: Array) -> tuple[Array, NDArray[np.int64]]:
    """For each ray the distance to what it meets first and the index of that shape, or infinity and -1.

    Of coincident surfaces the earlier one is met.
    """
    nearest = np.full(directions.shape[:-1], np.inf)
    owners = np.full(nearest.shape, -1)
    for index, shape in enumerate(shapes):
        distance = first_in_front(*chord(shape, origins, directions))
        closer = distance < nearest * (1 - SAME_SURFACE)
        nearest[closer] = distance[closer]
        owners[closer] = index
    return nearest, owners


def first_in_front(enter: Array, leave: Array) -> Array:
    """The first end of a chord at a distance > 0, or infinity where there is no chord or it lies behind."""
    first = np.where(enter > 0, enter, leave)
    return np.where((enter <= leave) & (first > 0), first, np.inf)


def light_at(scene: Scene, points: Array, facing: Array, bent: Array, offsets: Array) -> Array:
    """The light that points with unit normals towards the viewer receive, per colour, as if their normals were `bent`;
    shadow rays start at `offsets` above the points."""
    received = np.zeros_like(points)
    if scene.ambient is not None:
        received += scene.ambient.brightness * rgb(scene.ambient.colour)
    starts = points + offsets[:, None] * facing
    for light in scene.lights:
        way = np.array(light.position) - starts
        distance = length(way)
        towards = way / distance[:, None]
        cosine = np.maximum(0.0, dot(bent, towards))
        visible = np.ones(len(points), dtype=bool)
        for shape in scene.shapes:
            visible &= first_in_front(*chord(shape, starts, towards)) >= distance * (1 - OFF_SURFACE)
        received += (light.brightness * cosine * visible)[:, None] * rgb(light.colour)
    return received


@singledispatch
def chord(shape: Shape, origins: Array, directions: Array) -> tuple[Array, Array]:
    """Distances at which lines along unit directions enter and leave a shape; where they miss it, enter > leave."""
    raise TypeError(f"the reference renderer knows no {shape.title}")


@chord.register
def _(plane: Plane, origins: Array, directions: Array) -> tuple[Array, Array]:
    normal = np.array(plane.normal)
    above, rise = dot(origins - np.array(plane.point), normal), dot(directions, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        there = np.where(rise == 0, np.nan, -above / rise)
    return there, there


@chord.register
def _(sphere: Sphere, origins: Array, directions: Array) -> tuple[Array, Array]:
    to_centre = np.array(sphere.centre) - origins
    middle = dot(to_centre, directions)
    off_centre = length(np.cross(to_centre, directions))
    return around(middle, half_chord(sphere.diameter / 2, off_centre))


@chord.register
def _(cylinder: Cylinder, origins: Array, directions: Array) -> tuple[Array, Array]:
    axis, radius = np.array(cylinder.axis), cylinder.diameter / 2
    to_centre = np.array(cylinder.centre) - origins
    # What the ray does along the axis: the slab between the caps.
    along, slope = dot(to_centre, axis), dot(directions, axis)
    with np.errstate(divide="ignore", invalid="ignore"):
        slab_middle, slab_half = along / slope, cylinder.height / 2 / np.abs(slope)
    level = slope == 0
    within = np.where(np.abs(along) <= cylinder.height / 2, np.inf, np.nan)
    slab_enter, slab_leave = around(np.where(level, 0.0, slab_middle), np.where(level, within, slab_half))
    # What it does across the axis: a circle in the plane, at the speed |across|.
    across, centre_across = directions - slope[..., None] * axis, to_centre - along[..., None] * axis
    speed = length(across)
    with np.errstate(divide="ignore", invalid="ignore"):
        off_axis = np.abs(dot(np.cross(centre_across, across), axis)) / speed
        tube_middle, tube_half = dot(centre_across, across) / speed**2, half_chord(radius, off_axis) / speed
    parallel = speed == 0
    within = np.where(length(centre_across) <= radius, np.inf, np.nan)
    tube_enter, tube_leave = around(np.where(parallel, 0.0, tube_middle), np.where(parallel, within, tube_half))
    return np.maximum(slab_enter, tube_enter), np.minimum(slab_leave, tube_leave)


@singledispatch
def normals(shape: Shape, points: Array) -> Array:
    """The unit normals, to either side, of a shape at points on its surface."""
    raise TypeError(f"the reference renderer knows no {shape.title}")


@normals.register
def _(plane: Plane, points: Array) -> Array:
    return np.broadcast_to(np.array(plane.normal), points.shape)


@normals.register
def _(sphere: Sphere, points: Array) -> Array:
    from_centre = points - np.array(sphere.centre)
    return from_centre / length(from_centre)[..., None]


@normals.register
def _(cylinder: Cylinder, points: Array) -> Array:
    axis = np.array(cylinder.axis)
    from_centre = points - np.array(cylinder.centre)
    along = dot(from_centre, axis)
    across = from_centre - along[..., None] * axis
    on_cap = cylinder.height / 2 - np.abs(along) < cylinder.diameter / 2 - length(across)
    normal = np.where(on_cap[..., None], axis, across)
    return normal / length(normal)[..., None]


@singledispatch
def shading(shape: Shape, points: Array, normal: Array) -> Array:
    """The unit normals by which points are lit, on the side of those of the surface."""
    return normal


def half_chord(radius: float, off_centre: Array) -> Array:
    """Half of the length of a circle's chord that passes the centre at a distance; NaN where it is no chord."""
    with np.errstate(invalid="ignore"):
        return np.sqrt((radius - off_centre) * (radius + off_centre))


def around(middle: Array, half: Array) -> tuple[Array, Array]:
    """The two ends of a chord."""
    return middle - half, middle + half


def dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=-1))


def length(a: Array) -> Array:
    return np.sqrt(dot(a, a))


def rgb(colour: tuple[float, float, float]) -> Array:
    return np.array(colour) / 255.0
