"""Pictures without the compiler: coarse ones until a kernel is there, and a camera where nothing is in view.

Previews run the kernel's formulas, interpreted, on all rays at once. Their time goes into calls of numpy: a fixed one
for each shape, which takes longer the more rays there are.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, islice, product
from math import atan2, ceil, cos, dist, floor, log10, pi, radians, sin, tan
from typing import Any

import numpy as np

from minirt.fields import FARTHEST, Triple, spelled
from minirt.kernel import interpreted
from minirt.kernel.frame import ray_direction
from minirt.kernel.shading.whitted import incoming_radiance
from minirt.lanes import Vec, unit
from minirt.rendering.frame import thread_memory
from minirt.rendering.notes import shape_name
from minirt.rendering.packing.camera import Crop, Request
from minirt.rendering.packing.lights import emitting_lights
from minirt.rendering.packing.materials import encloses
from minirt.rendering.packing.ray_casting import camera_ray, nearest_hits
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.scene_packing import BVH, LIGHT_BUFFERS, TILES, Packing
from minirt.rendering.tone_mapping import map_tones
from minirt.scene import Camera, Scene, describe
from minirt.shapes import Box, Cone, Cylinder, Ellipsoid, Sphere

BUDGET = 0.12  # seconds
SHAPE, RAY = 2e-4, 2e-7  # seconds to intersect a shape with all rays, and seconds more for each ray
UNBOUNDED = ((-np.inf,) * 3, (np.inf,) * 3)  # box of a plane
FEWEST = 400  # rays of a picture worth showing


def preview(scene: Scene, width: int, height: int) -> np.ndarray | None:
    """Render a scene as finely as possible in about `BUDGET` seconds, in the proportions of the given size and at most
    of that size: uint8 (h, w, 4) in the order blue, green, red, alpha. None where the scene has too many shapes."""
    tests = max(1, sum(shape.parts for shape in scene.shapes)) * (1 + len(scene.lights))
    rays = (BUDGET / tests - SHAPE) / RAY
    if rays < min(FEWEST, width * height):
        return None
    divisor = max(1, ceil((width * height / rays) ** 0.5))
    return render_interpreted(scene, -(-width // divisor), -(-height // divisor))[0]


def render_interpreted(scene: Scene, width: int, height: int, crop: Crop | None = None) -> tuple[np.ndarray, ...]:
    """Return the picture of a scene in that size, or a rectangle of that size of a larger picture, and its light,
    (h, w, 3)."""
    with np.errstate(all="ignore"):
        arrays = Packing(interpreted, depth=0, without=(TILES, LIGHT_BUFFERS, BVH)).pack(scene, width, height, crop)
        arrays = arrays._replace(soft=None, lens=None)
        y, x = np.mgrid[:height, :width].reshape(2, -1) + 0.5
        direction = unit(ray_direction(arrays.camera, x + arrays.camera[12], y + arrays.camera[13]))
        colour = incoming_radiance(arrays, thread_memory(arrays)[0], 0, Vec(*arrays.camera[:3]), direction)
    light = np.stack([colour.x, colour.y, colour.z], axis=-1).reshape(height, width, 3)
    pixels = np.empty((height, width, 4), np.uint8)
    map_tones(light, pixels, scene.camera.tone)
    return pixels, light


def draw_background(request: Request) -> None:
    """Draw a scene without shapes: its background, or black."""
    scene, pixels, linear, crop = request
    if scene.background and pixels.size:
        pixels[...], light = render_interpreted(scene, pixels.shape[1], pixels.shape[0], crop)
        linear[...] = light if len(linear) else linear
    else:
        pixels[...] = (0, 0, 0, 255)
        linear[...] = 0.0


# Notices about what is not seen, with a camera that would show the scene.

COLUMNS, ROWS = 32, 18  # rays that look for shapes
MOST_PRIMITIVES = 20_000  # that are looked for: in a second
TESTS = 4_000_000  # of rays against primitives, which choose a camera
AZIMUTHS, ELEVATIONS = 8, (25.0, -25.0, 70.0)  # degrees: places around the scene from which a camera may look
NARROWEST, WIDEST, USUAL = 20.0, 100.0, 60.0  # degrees of the field of view: others are replaced by the usual one
MARGIN = 1.15  # of the distance at which the bounding ball of the scene fills the picture
IN_PLANE = 1e-9  # distance from a plane, relative to the coordinates of the eye
CONVEX = (Sphere, Box, Cylinder, Cone, Ellipsoid)
MOST_NAMED = 3  # shapes in a notice
MOST_COMPARED = 200  # shapes of which one may be inside of another
CERTAIN = 1e-3  # of the size of a shape by which its bounding box is grown
DIGITS = 3  # of coordinates, relative to the size of the scene
PLACES = 4  # decimals of directions


def notice_about(scene: Scene, pixels: np.ndarray) -> str:
    """Return a sentence for a picture, (h, w, channels), of one colour: why, and which camera would show the scene;
    empty for any other."""
    height, width = pixels.shape[:2]
    if not is_blank(pixels):
        return ""
    if not scene.runs:
        return "the scene has no shapes"
    arrays = ShapeArrays()
    arrays.update(*scene.runs)
    if len(arrays.slots) > MOST_PRIMITIVES:
        return ""
    seen = visible_shapes(arrays, scene.camera, width, height)
    if len(seen) and not is_lit(scene):
        return "no light is on: all that is in view is black"
    reason = reason_for(scene, arrays, seen)
    camera = len(seen) < len(scene.shapes) and showing_camera(scene, arrays, width, height)
    return f"{reason}; this line would show the scene: {camera}" if camera else reason


def is_lit(scene: Scene) -> bool:
    ambient, background = scene.ambient, scene.background
    is_ambient = bool(ambient and ambient.brightness and any(ambient.colour))
    is_bright = bool(background and (isinstance(background.paint, str) or any(background.paint)))
    return is_ambient or is_bright or bool(emitting_lights(scene)) or any(shape.glow for shape in scene.shapes)


def reason_for(scene: Scene, arrays: ShapeArrays, seen: np.ndarray) -> str:
    """Return why a picture has one colour, in which the shapes with the indices `seen` are in view."""
    eye, forward = np.array(scene.camera.position), np.array(scene.camera.direction)
    for index, shape in enumerate(scene.shapes):
        flat = shape.flat()
        if flat and abs(np.dot(np.subtract(eye, flat[0]), flat[1])) <= IN_PLANE * (1 + np.abs(eye).max()):
            return f"the eye is in {shape_name(scene.shapes, index)}"
        if not flat and encloses(shape, eye):
            return f"the eye is inside {shape_name(scene.shapes, index)}"
    if len(seen):
        names = ", ".join(shape_name(scene.shapes, index) for index in seen[:MOST_NAMED].tolist())
        names += ", ..." * (len(seen) > MOST_NAMED)
        return f"what is in view has one colour, or is smaller than a pixel: {names}"
    depths = np.maximum((arrays.boxes[:, 0] - eye) * forward, (arrays.boxes[:, 1] - eye) * forward).sum(axis=1)
    is_behind = depths.max() < 0 and not any(kind.infinite for kind in arrays.group_numbers)
    return "nothing is in view: all is behind the eye" if is_behind else "nothing is in view"


def hidden_shapes(scene: Scene) -> Iterator[str]:
    """Yield sentences about shapes that are never seen, as they are inside an opaque convex one that the eye is not in.

    Only what is certain counts: the corners of the bounding box, grown, are inside the other one.
    """
    eye, shapes = np.array(scene.camera.position), [*islice(chain.from_iterable(scene.runs), MOST_COMPARED)]
    boxes = np.array([shape.bounds() or UNBOUNDED for shape in shapes]).reshape(-1, 2, 3)
    starts, ends = boxes[:, 0], boxes[:, 1]
    grown = CERTAIN * (ends - starts)
    for outer, shape in enumerate(shapes):
        if isinstance(shape, CONVEX) and not shape.glass and not scene.camera.lens and not encloses(shape, eye):
            within = (starts >= starts[outer]).all(axis=1) & (ends <= ends[outer]).all(axis=1)
            for index in np.flatnonzero(within).tolist():
                corners = product(*zip(starts[index] - grown[index], ends[index] + grown[index], strict=True))
                if index != outer and all(encloses(shape, np.array(at)) for at in corners):
                    names = (shape_name(shapes, each) for each in (index, outer))
                    yield "{} is never seen: it is inside {}, which is opaque".format(*names)


def is_blank(pixels: np.ndarray) -> bool:
    """Whether all pixels have the same colour, up to a level of dithering."""
    coarse = pixels[::32, ::32]
    return bool(np.ptp(coarse, axis=(0, 1)).max() <= 1 and np.ptp(pixels, axis=(0, 1)).max() <= 1)


def visible_shapes(arrays: ShapeArrays, camera: Camera, width: int, height: int) -> np.ndarray:
    """Return the indices of the shapes that some rays of a picture of that size hit first."""
    x: Any
    y: Any
    y, x = (np.mgrid[:ROWS, :COLUMNS].reshape(2, -1) + 0.5) * [[height / ROWS], [width / COLUMNS]]
    _, primitives = nearest_hits(arrays, *camera_ray(camera, width, height, x, y))
    return np.unique(arrays.owner[primitives[primitives >= 0]])


def showing_camera(scene: Scene, arrays: ShapeArrays, width: int, height: int) -> str:
    """Return the line of the first camera that shows most shapes, or an empty text."""
    centre, radius = bounding_ball(arrays)
    count = max(1, TESTS // (COLUMNS * ROWS * len(arrays.slots)))
    cameras = candidates(scene.camera, centre, radius, height / width)[:count]
    shown = [len(visible_shapes(arrays, camera, width, height)) for camera in cameras]
    return line_of(cameras[np.argmax(shown)]) if max(shown, default=0) else ""


def bounding_ball(arrays: ShapeArrays) -> tuple[Triple, float]:
    """Return a ball around all bounded shapes; without any, around points of the infinite ones."""
    is_bounded = np.array([not shape.infinite for shape in arrays.shapes], bool)
    boxes = arrays.boxes[is_bounded] if is_bounded.any() else arrays.boxes
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    x, y, z = (low + high).tolist()
    return (x / 2, y / 2, z / 2), dist(low, high) / 2 or 1.0


def candidates(camera: Camera, centre: Triple, radius: float, aspect: float) -> list[Camera]:
    """Return cameras all around a ball that see it whole, those near to where the camera is first, and none beyond the
    range of coordinates."""
    fov = camera.fov if NARROWEST <= camera.fov <= WIDEST else USUAL
    half = tan(radians(fov) / 2) * min(1.0, aspect)
    distance = MARGIN * radius / sin(atan2(half, 1.0))
    x, _, z = (eye - middle for eye, middle in zip(camera.position, centre, strict=True))
    start = atan2(x, z) if x or z else pi
    digits = DIGITS - 1 - floor(log10(radius))
    turns = [(-1) ** i * ceil(i / 2) * 2 * pi / AZIMUTHS for i in range(AZIMUTHS)]
    cameras = []
    for elevation in map(radians, ELEVATIONS):
        for azimuth in (start + turn for turn in turns):
            towards = cos(elevation) * sin(azimuth), sin(elevation), cos(elevation) * cos(azimuth)
            eye = tuple(round(a + distance * b, digits) for a, b in zip(centre, towards, strict=True))
            if max(map(abs, eye)) > FARTHEST:
                continue
            direction = tuple(round(-b, PLACES) for b in towards)
            cameras.append(camera.replace(position=eye, direction=direction, fov=fov, roll=0.0))
    return cameras


def line_of(camera: Camera) -> str:
    code, position, _, *others = describe(camera).split()
    direction = ",".join(spelled(round(part, PLACES)) for part in camera.direction)
    return " ".join((code, position, direction, *others))
