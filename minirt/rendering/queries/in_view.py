"""Notice about a picture in which nothing is in view, with a camera that would show the scene."""

from __future__ import annotations

from functools import partial
from math import atan2, ceil, cos, dist, floor, log10, pi, radians, sin, tan
from typing import Any

import numpy as np

from minirt.fields import Triple, spelled
from minirt.kernel.frame import ray_direction
from minirt.kernel.scene_arrays import kind_of
from minirt.lanes import Vec, unit
from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera, Scene, describe

COLUMNS, ROWS = 32, 18  # rays that look for shapes
MOST_PRIMITIVES = 20_000  # that are looked for: in a second
TESTS = 4_000_000  # of rays against primitives, which choose a camera
FEW_SHAPES, FEW_CAMERAS = 64, 4  # of a scene whose brightness chooses, too, and how many are compared
AZIMUTHS, ELEVATIONS = 8, (25.0, -25.0, 70.0)  # degrees: places around the scene from which a camera may look
NARROWEST, WIDEST, USUAL = 20.0, 100.0, 60.0  # degrees of the field of view: others are replaced by the usual one
MARGIN = 1.15  # of the distance at which the bounding ball of the scene fills the picture
DIGITS = 3  # of coordinates, relative to the size of the scene
PLACES = 4  # decimals of directions


def notice_about(scene: Scene, pixels: np.ndarray) -> str:
    """Return a sentence for a picture, (h, w, channels), in which nothing is in view; empty for any other."""
    height, width = pixels.shape[:2]
    if not scene.shapes or not is_blank(pixels):
        return ""
    arrays = ShapeArrays()
    arrays.update(scene.shapes)
    if len(arrays.slots) > MOST_PRIMITIVES or len(visible_shapes(arrays, scene.camera, width, height)):
        return ""
    camera = showing_camera(scene, arrays, width, height)
    return f"nothing is in view; this line would show the scene: {camera}" if camera else "nothing is in view"


def is_blank(pixels: np.ndarray) -> bool:
    """Whether all pixels have the same colour, up to a level of dithering."""
    coarse = pixels[::32, ::32]
    return bool(np.ptp(coarse, axis=(0, 1)).max() <= 1 and np.ptp(pixels, axis=(0, 1)).max() <= 1)


def visible_shapes(arrays: ShapeArrays, camera: Camera, width: int, height: int) -> np.ndarray:
    """Return the indices of the shapes that some rays of a picture of that size hit first."""
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    x: Any
    y: Any
    y, x = (np.mgrid[:ROWS, :COLUMNS].reshape(2, -1) + 0.5) * [[height / ROWS], [width / COLUMNS]]
    nearest, owner = np.full(x.size, np.inf), np.full(x.size, -1)
    with np.errstate(all="ignore"):
        origin, direction = Vec(*numbers[:3]), unit(ray_direction(numbers, x, y))
        for group, rows in enumerate(arrays.rows):
            primitives = np.flatnonzero(arrays.slots[:, 0] == group)
            for start in range(0, len(rows), 1024):
                hit, t = kind_of(rows.dtype.names).intersect(as_column(rows[start : start + 1024]), origin, direction)
                t = np.where(hit, t, np.inf)
                first = t.argmin(axis=0)
                least = t[first, np.arange(x.size)]
                closer = least < nearest
                nearest = np.where(closer, least, nearest)
                owner = np.where(closer, arrays.owner[primitives[start + first]], owner)
    return np.unique(owner[owner >= 0])


def as_column(rows: Any) -> Any:
    """Return rows of shapes of one kind as one shape, whose numbers are arrays (n, 1)."""
    parts = (rows[name][:, None] for name in rows.dtype.names)
    return kind_of(rows.dtype.names).packed(
        *(Vec(*np.moveaxis(part, 2, 0)) if part.ndim > 2 else part for part in parts)
    )


def showing_camera(scene: Scene, arrays: ShapeArrays, width: int, height: int) -> str:
    """Return the line of the camera that shows most shapes, and of those the one with most light; or an empty text."""
    centre, radius = bounding_ball(scene)
    count = max(1, TESTS // (COLUMNS * ROWS * len(arrays.slots)))
    cameras = candidates(scene.camera, centre, radius, height / width)[:count]
    shown = [len(visible_shapes(arrays, camera, width, height)) for camera in cameras]
    best = [camera for camera, shapes in zip(cameras, shown, strict=True) if shapes == max(shown) > 0]
    if len(best) > 1 and len(scene.shapes) <= FEW_SHAPES:
        return line_of(max(best[:FEW_CAMERAS], key=partial(brightness, scene)))
    return line_of(best[0]) if best else ""


def brightness(scene: Scene, camera: Camera) -> float:
    """Return the mean light of a picture, clamped to [0, 1]."""
    from minirt.rendering.queries.preview import render_interpreted

    _, light = render_interpreted(scene.replace(scene.camera, camera), COLUMNS, ROWS)
    return float(np.minimum(light, 1.0).mean())


def bounding_ball(scene: Scene) -> tuple[Triple, float]:
    """Return a ball around all bounded shapes; without any, around points of the infinite ones and the lights."""
    boxes = [box for box in (shape.bounds() for shape in scene.shapes) if box is not None]
    if not boxes:
        points = [flat[0] for flat in (shape.flat() for shape in scene.shapes) if flat is not None]
        points += [light.position for light in scene.lights if hasattr(light, "position")]
        boxes = [(point, point) for point in points or [(0.0, 0.0, 0.0)]]
    low, high = np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)
    x, y, z = (low + high).tolist()
    return (x / 2, y / 2, z / 2), dist(low, high) / 2 or 1.0


def candidates(camera: Camera, centre: Triple, radius: float, aspect: float) -> list[Camera]:
    """Return cameras all around a ball that see it whole, those near to where the camera is first."""
    fov = camera.fov if NARROWEST <= camera.fov <= WIDEST else USUAL
    half = tan(radians(fov) / 2) * min(1.0, aspect)
    distance = MARGIN * radius / sin(atan2(half, 1.0))
    x, _, z = (eye - middle for eye, middle in zip(camera.position, centre, strict=True))
    start = atan2(x, z) if x or z else pi
    turns = [(-1) ** i * ceil(i / 2) * 2 * pi / AZIMUTHS for i in range(AZIMUTHS)]
    cameras = []
    for elevation in map(radians, ELEVATIONS):
        for azimuth in (start + turn for turn in turns):
            towards = cos(elevation) * sin(azimuth), sin(elevation), cos(elevation) * cos(azimuth)
            eye = tuple(rounded(a + distance * b, radius) for a, b in zip(centre, towards, strict=True))
            direction = tuple(round(-b, PLACES) for b in towards)
            cameras.append(camera.replace(position=eye, direction=direction, fov=fov, roll=0.0))
    return cameras


def rounded(coordinate: float, size: float) -> float:
    """Round a coordinate to `DIGITS` digits of a size."""
    return round(coordinate, DIGITS - 1 - floor(log10(size)))


def line_of(camera: Camera) -> str:
    """Return the line of a camera, its direction rounded."""
    code, position, _, *others = describe(camera).split()
    direction = ",".join(spelled(round(part, PLACES)) for part in camera.direction)
    return " ".join((code, position, direction, *others))
