"""Notices about what of a scene is not seen, with a camera that would show it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from itertools import product
from math import atan2, ceil, cos, dist, floor, log10, pi, radians, sin, tan

import numpy as np

from minirt.errors import MiniRTError
from minirt.fields import FARTHEST, Triple, spelled
from minirt.rendering.notes import names_of, shape_name
from minirt.rendering.packing.camera import camera_frame, slopes_at_edges
from minirt.rendering.packing.lights import emitting_lights
from minirt.rendering.packing.materials import encloses
from minirt.rendering.packing.ray_casting import camera_ray, nearest_hits
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera, Scene, describe, load

# Places in a picture at which rays look for shapes, (n, 2), in shares of its width and height: some find one in most
# pictures. The last ones are for the rectangle around one shape, and begin in its middle.
MANY, SOME = ((np.argwhere(np.ones(counts)) + 0.5) / counts for counts in ((32, 18), (8, 5)))
AIMED = (0.5 + np.arange(64)[:, None] * (0.7548776662, 0.5698402910)) % 1.0
MOST_PRIMITIVES = 20_000  # that are looked for: in a second
TESTS = 4_000_000  # of rays against primitives, which choose a camera
AZIMUTHS, ELEVATIONS = 8, (25.0, -25.0, 70.0)  # degrees: places around the scene from which a camera may look
NARROWEST, WIDEST, USUAL = 20.0, 100.0, 60.0  # degrees of the field of view: others are replaced by the usual one
MARGIN = 1.15  # of the distance at which the bounding ball of the scene fills the picture
IN_PLANE = 1e-9  # distance from a plane, relative to the coordinates of the eye
DIGITS = 3  # of coordinates, relative to the size of the scene
PLACES = 4  # decimals of directions
SHOWN_BY = "; this line would show the scene: "
DARK = "no light is on: all that is in view is black"
DARK_BEFORE_BACKGROUND = f"{DARK}, but for the background"


def notice_about(scene: Scene, size: tuple[int, int], pixels: np.ndarray | None = None) -> str:
    """Return why a picture of that size has one colour or shows none of the bounded shapes, and the line of a camera
    that would show the scene; '' for any other picture, and for a scene of too many primitives.

    `pixels` are (h, w, channels), or None where the picture is not rendered: then rays alone tell what is in view.
    """
    is_even = pixels is not None and is_blank(pixels)
    if not scene.runs:
        return "the scene has no shapes" if is_even else ""
    arrays = arrays_of(scene)
    if arrays is None:
        return ""
    bounded = is_bounded(arrays)
    seen = visible_shapes(arrays, scene.camera, size, MANY if is_even else SOME)
    if not bounded[seen].any():
        seen = np.union1d(visible_shapes(arrays, scene.camera, size), aimed_shapes(arrays, scene.camera, size))
    if len(seen) and not is_lit(scene):
        return DARK_BEFORE_BACKGROUND if scene.background else DARK
    reason, options = around_eye(scene, arrays, is_even), ""
    if not reason:
        if not is_even and (bounded[seen].any() or not bounded.any()):
            return ""
        reason = reason_for(scene, arrays, seen, size)
        options = "" if bounded[seen].any() else "".join(other_readings(scene, arrays, size))
    camera = showing_camera(scene, size) if len(seen) < len(scene.shapes) else None
    return reason + options + (SHOWN_BY + line_of(camera) if camera else "")


def arrays_of(scene: Scene) -> ShapeArrays | None:
    """Return the shapes of a scene for rays that look for them; None where that would take too long."""
    if sum(map(len, scene.runs)) > MOST_PRIMITIVES or sum(each.parts for each in scene.shapes) > MOST_PRIMITIVES:
        return None
    arrays = ShapeArrays()
    arrays.update(*scene.runs)
    return arrays


def is_bounded(arrays: ShapeArrays) -> np.ndarray:
    """Return which shapes are bounded, (s,)."""
    return np.array([not shape.infinite for shape in arrays.shapes], bool)


def is_lit(scene: Scene) -> bool:
    """Whether anything gives light to shapes, or one of them shows the light of the background."""
    ambient, background = scene.ambient, scene.background
    is_ambient = bool(ambient and ambient.brightness and any(ambient.colour))
    is_bright = bool(background and (isinstance(background.paint, str) or any(background.paint)))
    shows_light = (each.glow or (is_bright and (each.mirror or each.glass)) for each in scene.shapes)
    return is_ambient or bool(emitting_lights(scene)) or any(shows_light)


def around_eye(scene: Scene, arrays: ShapeArrays, is_even: bool) -> str:
    """Return a sentence about the shape that the eye is in, or ''.

    Where the picture is not of one colour (`is_even`), only a shape counts that is not of glass and has other shapes
    wholly outside of it.
    """
    eye, bounded = np.array(scene.camera.position), is_bounded(arrays)
    starts, ends = arrays.boxes[:, 0], arrays.boxes[:, 1]
    for index in np.flatnonzero(~bounded | ((starts <= eye) & (eye <= ends)).all(axis=1)).tolist():
        shape, name = arrays.shapes[index], shape_name(scene, index)
        if plane := shape.infinite_plane():
            point, normal = plane
            distance = abs(np.dot(np.subtract(eye, point), normal))
            if is_even and distance <= IN_PLANE * (1 + np.abs(eye).max()):
                return f"the eye is in {name}"
        elif encloses(shape, eye):
            is_outside = bounded & ((starts > ends[index]) | (ends < starts[index])).any(axis=1)
            if is_outside.any() and not shape.glass:
                return f"the eye is inside {name}: nothing outside of it is seen"
            if is_even:
                return f"the eye is inside {name}"
    return ""


def reason_for(scene: Scene, arrays: ShapeArrays, seen: np.ndarray, size: tuple[int, int]) -> str:
    """Return why a picture of that size has one colour or shows no bounded shape; `seen` has the indices of the shapes
    in view."""
    bounded = is_bounded(arrays)
    if bounded[seen].any() or (len(seen) and not bounded.any()):
        return f"what is in view has one colour, or is smaller than a pixel: {names_of(scene, seen.tolist())}"
    if len(seen):
        kinds = [type(scene.shapes[index]) for index in seen.tolist()]
        names = " and ".join(kind.title if kinds.count(kind) == 1 else kind.plural for kind in dict.fromkeys(kinds))
        others = f"none of the {bounded.sum()} shapes" if bounded.sum() > 1 else "no shape"
        low, high = np.clip(rectangles(scene.camera, size, arrays.boxes[bounded]), 0.0, 1.0)
        behind = np.flatnonzero(bounded)[(low < high).all(axis=1)].tolist()
        hidden = f", behind which is {names_of(scene, behind)}" if behind else ""
        return f"{others} but the {names} is in view{hidden}"
    eye, forward = np.array(scene.camera.position), np.array(scene.camera.direction)
    # The depth of the corner of each box that is farthest along the viewing direction.
    depths = np.maximum((arrays.boxes[:, 0] - eye) * forward, (arrays.boxes[:, 1] - eye) * forward).sum(axis=1)
    is_behind = depths.max() < 0 and bounded.all()
    return "nothing is in view: all is behind the eye" if is_behind else "nothing is in view"


def other_readings(scene: Scene, arrays: ShapeArrays, size: tuple[int, int]) -> Iterator[str]:
    """Yield which options read the camera of the scene's file in another way, so that it sees bounded shapes; none if
    it was read so already."""
    from minirt.scene.dialect_tables import CAMERAS, OPTIONS

    bounded, ways = is_bounded(arrays), list[bool | str]((True, *CAMERAS))
    with suppress(MiniRTError, IndexError):  # the file was changed or deleted since
        as_written, *others = (load(scene.file or "", way).scene.cameras[scene.shown] for way in ways)
        for word, camera in zip(CAMERAS, others, strict=True) if as_written.direction == scene.camera.direction else ():
            if count := bounded[visible_shapes(arrays, camera, size)].sum():
                yield f"; {OPTIONS[word]} shows {count} of {bounded.sum()}"


def is_blank(pixels: np.ndarray) -> bool:
    """Whether all pixels have the same colour, up to a level of dithering."""
    coarse = pixels[::32, ::32]
    return bool(np.ptp(coarse, axis=(0, 1)).max() <= 1 and np.ptp(pixels, axis=(0, 1)).max() <= 1)


def visible_shapes(arrays: ShapeArrays, camera: Camera, size: tuple[int, int], places: np.ndarray = MANY) -> np.ndarray:
    """Return the indices of the shapes that are seen at some places of a picture of that size."""
    x, y = (places * size).T
    _, primitives = nearest_hits(arrays, *camera_ray(camera, *size, x, y))
    return np.flatnonzero(np.bincount(arrays.owner[primitives[primitives >= 0]]))


def aimed_shapes(arrays: ShapeArrays, camera: Camera, size: tuple[int, int]) -> np.ndarray:
    """Return the indices of the shapes that rays at all bounded ones hit first; all where that takes too long."""
    low, high = np.clip(rectangles(camera, size, arrays.boxes[is_bounded(arrays)]), 0.0, 1.0)[:, :, None]
    places = (low + AIMED * (high - low))[(low < high).all(axis=(1, 2))].reshape(-1, 2)
    is_quick = len(places) * len(arrays.slots) <= TESTS
    return visible_shapes(arrays, camera, size, places) if is_quick else np.arange(len(arrays.shapes))


def rectangles(camera: Camera, size: tuple[int, int], boxes: np.ndarray) -> np.ndarray:
    """Return the least and the greatest x and y of boxes (n, 2, 3) in a picture, in shares of its width and height,
    (2, n, 2): -1 for a box behind the eye, 0 and 1 for one that is so in part."""
    right, up, forward = camera_frame(camera)
    corners = boxes[:, [*product((0, 1), repeat=3)], [0, 1, 2]] - camera.position
    depths = (corners @ forward)[..., None]
    with np.errstate(all="ignore"):
        slopes = corners @ np.transpose([right, np.negative(up)]) / depths
        places = 0.5 + 0.5 * slopes / slopes_at_edges(camera, *size)
    ends = [(depths > 0).all(axis=1), (depths <= 0).all(axis=1)]
    return np.stack([np.select(ends, [places.min(1), -1.0], 0.0), np.select(ends, [places.max(1), -1.0], 1.0)])


def showing_camera(scene: Scene, size: tuple[int, int], *, straight: bool = False) -> Camera | None:
    """Return the first of the cameras that show the most bounded shapes; None where none shows any. In a scene without
    bounded shapes all shapes count.

    `size` is the picture's width and height. `straight`: a camera with the direction of the scene's camera is preferred
    if it shows any.
    """
    arrays = arrays_of(scene)
    if not arrays or not len(arrays.shapes):
        return None
    bounded = is_bounded(arrays)
    wanted = bounded if bounded.any() else ~bounded
    low, high = arrays.boxes[wanted, 0].min(axis=0), arrays.boxes[wanted, 1].max(axis=0)
    x, y, z = ((low + high) / 2).tolist()
    cameras = candidates(scene.camera, (x, y, z), dist(low, high) / 2 or 1.0, size[1] / size[0], straight)
    cameras = cameras[: max(1, TESTS // (len(MANY) * len(arrays.slots)))]
    shown = [wanted[visible_shapes(arrays, camera, size)].sum() for camera in cameras]
    if straight and any(shown[:1]):  # the first one looks as the scene's camera does
        return cameras[0]
    return cameras[np.argmax(shown)] if max(shown, default=0) else None


def candidates(camera: Camera, centre: Triple, radius: float, aspect: float, straight: bool) -> list[Camera]:
    """Return cameras all around a ball that see it whole, those near to where the camera is first, and none beyond the
    range of coordinates. The last one stays at the camera's place and turns to the ball's centre; there is none if the
    camera is at the centre.

    `aspect` is the height of the picture by its width. `straight`: one that keeps the camera's direction comes first.
    """
    fov = camera.fov if NARROWEST <= camera.fov <= WIDEST else USUAL
    half = tan(radians(fov) / 2) * min(1.0, aspect)
    distance = MARGIN * radius / sin(atan2(half, 1.0))
    from_x, _, from_z = (eye - middle for eye, middle in zip(camera.position, centre, strict=True))
    start = atan2(from_x, from_z) if from_x or from_z else pi
    digits = DIGITS - 1 - floor(log10(radius))
    turns = [(-1) ** i * ceil(i / 2) * 2 * pi / AZIMUTHS for i in range(AZIMUTHS)]  # 0, then to both sides in turn
    ways = [tuple(-part for part in camera.direction)] if straight else []  # from the centre to the eye
    for elevation in map(radians, ELEVATIONS):
        level = ((cos(elevation) * sin(start + turn), cos(elevation) * cos(start + turn)) for turn in turns)
        ways += [(x, sin(elevation), z) for x, z in level]
    cameras = []
    for way in ways:
        eye = tuple(round(a + distance * b, digits) for a, b in zip(centre, way, strict=True))
        if max(map(abs, eye)) <= FARTHEST:
            direction = tuple(round(-b, PLACES) for b in way)
            cameras.append(camera.replace(position=eye, direction=direction, fov=fov, roll=0.0))
    if away := dist(centre, camera.position):  # walls may hide the scene from all sides
        direction = tuple(round((b - a) / away, PLACES) for a, b in zip(camera.position, centre, strict=True))
        cameras.append(camera.replace(direction=direction, fov=fov, roll=0.0))
    return cameras


def line_of(camera: Camera) -> str:
    code, position, _, *others = describe(camera).split()
    direction = ",".join(spelled(round(part, PLACES)) for part in camera.direction)
    return " ".join((code, position, direction, *others))
