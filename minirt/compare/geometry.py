"""Geometry under a guess: rays of another camera, through a scene whose shapes mean something else."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import cos, hypot, radians, sin, tan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.compare.changed_shapes import Floats, Mask, as_written, changed_scene, rotation
from minirt.compare.table import Guess
from minirt.element import fields_of
from minirt.materials import Attributes
from minirt.rendering.queries.rays import trace
from minirt.scene import Camera, Scene
from minirt.scene.dialect_tables import CAMERAS
from minirt.shapes.shape import Capped

AXES = {"y": (0, 1, 0), "-y": (0, -1, 0), "z": (0, 0, 1), "-z": (0, 0, -1), "x": (1, 0, 0), "-x": (-1, 0, 0)}
MOST_LAYERS = 4  # of caps or inner sides that a ray passes
PLAIN = {"specular", "roll"}  # attributes of shapes whose colour is the same everywhere
ON_CAP = 0.999  # cosine between the normal of a cap and the axis


class Seen(NamedTuple):
    """Hits of n rays, and the ways from there to each of the lamps."""

    owner: NDArray[np.int64]  # index in `scene.shapes`, -1 for the background
    point: Floats
    normal: Floats  # outward, 0 where nothing is met
    direction: Floats  # of the ray
    to_light: Floats  # (lamps, n, 3)
    distance: Floats  # (lamps, n) to the lamp
    strength: Floats  # (lamps, n) of spots and lamps that fade
    open_to: Mask  # (lamps, n) whether nothing lies between the point and the lamp
    open_beyond: Mask  # (lamps, n) nor behind the lamp
    mirror: Seen | None = None  # what the reflected rays meet


def plain_shapes(scene: Scene) -> Mask:
    """Whether the light of each shape is that of its colour alone, without mirrors, glass and textures; and True for
    the background, unless it is a picture."""
    names = [each.name for each in fields_of(Attributes) if each.name not in PLAIN]
    shapes = [all(getattr(shape, name, None) is None for name in names) for shape in scene.shapes]
    has_colour = [getattr(shape, "colour", None) is not None for shape in scene.shapes]
    sky = not scene.background or not isinstance(scene.background.paint, str)
    return np.array([is_plain and has for is_plain, has in zip(shapes, has_colour, strict=True)] + [sky])


def unit(v: Floats) -> Floats:
    """Scale vectors to length 1; those of length 0 stay."""
    result: Floats = v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)
    return result


def dots(one: Floats, other: Floats) -> Floats:
    """Scalar products of vectors."""
    result: Floats = np.einsum("...ij,...ij->...i", one, other)
    return result


def frame(camera: Camera, guess: Guess) -> Floats:
    """Return right, up and forward of a picture, (3, 3)."""
    way = camera.direction
    if guess["direction"] in CAMERAS:
        way = CAMERAS[guess["direction"]](camera, as_written(camera))["direction"]
    right, over, forward = looking(way, guess["up"], camera.roll + guess["roll"])
    if guess["yaw"] or guess["pitch"]:
        aside, above = radians(guess["yaw"]), radians(guess["pitch"])
        right, forward = cos(aside) * right - sin(aside) * forward, sin(aside) * right + cos(aside) * forward
        over, forward = cos(above) * over - sin(above) * forward, sin(above) * over + cos(above) * forward
    if guess["mirrored"] != camera.left_handed:
        right = -right
    return np.array([right, -over if guess["flipped"] else over, forward])


@lru_cache(256)
def looking(direction: tuple[float, float, float], way_up: str, roll: float) -> Floats:
    """Return right, up and forward of a camera, (3, 3): `way_up` is a value of the parameter "up", which says how they
    are made from the direction; `roll` is in degrees."""
    forward = np.array(direction)
    if way_up.startswith("from the "):
        axis = np.array(AXES[way_up.removeprefix("from the ")], float)
        matrix = rotation(axis, forward)
        right, up = matrix @ np.cross(axis, (0.0, 1.0, 0.0)), matrix @ np.array([0.0, 1.0, 0.0])
    elif way_up == "x first":
        up = unit(np.cross((-1.0, 0.0, 0.0), forward))
        up = up if up.any() else np.array([0.0, 0.0, 1.0])  # it looks along x
        right = np.cross(forward, up)
    else:
        right = np.cross(forward, AXES[way_up])
        right = unit(right) if np.linalg.norm(right) > 1e-9 else np.array([1.0, 0.0, 0.0])  # it looks along the axis
        up = np.cross(right, forward)
    turn = radians(roll)
    return np.array([cos(turn) * right - sin(turn) * up, sin(turn) * right + cos(turn) * up, forward])


def slopes(camera: Camera, aspect: float, guess: Guess) -> tuple[float, float]:
    """Return the slopes, to the side and up, of the rays through the edges of the picture; their angles, in radians,
    for pixels at equal angles."""
    angle = camera.fov if guess["fov"] == "full angle" else camera.fov / 2
    angle = radians(min(max(angle, 1e-6), 89.99))
    half = {"ignored": 1.0, "sine": sin(angle), "equal angles": angle}.get(guess["fov"], tan(angle)) * guess["scale"]
    level = max(hypot(camera.direction[0], camera.direction[2]), 1e-6)  # cosine of the tilt
    half *= {"not normalised": level, "too near": 1 / level}.get(guess["fov"], 1.0)
    if guess["fov"] == "vertical":
        return half * aspect, half
    return half, half if guess["fov"] == "square" else half / aspect


def directions(scene: Scene, size: tuple[int, int], x: Floats, y: Floats, guess: Guess) -> Floats:
    """Return the unit directions, (n, 3), of the rays through pixels of a picture of this size, of columns x and rows y
    from the upper left corner, (n,)."""
    width, height = size
    across, upward = slopes(scene.camera, width / height, guess)
    inset = 0.5 if guess["pixel"] == "centre" else 0.0
    right, up, forward = frame(scene.camera, guess)
    sideways = across * (2 * (x + inset) / width - 1)
    above = upward * (1 - 2 * (y + inset) / height)
    ahead = np.ones(len(x))
    if guess["fov"] == "equal angles":
        sideways, above, ahead = np.sin(sideways), np.sin(above), np.cos(sideways) * np.cos(above)
    ways = ahead[:, None] * forward + sideways[:, None] * right + above[:, None] * up
    if guess["direction"] == "position added":  # in units of pixels, where it is hardly seen
        ways += 2 * across / width * np.array(scene.camera.position)
    return unit(ways)


def on_cap(scene: Scene, owner: NDArray[np.int64], normal: Floats) -> Mask:
    """Whether hits lie on caps of cylinders and cones."""
    axes = np.array([shape.axis if isinstance(shape, Capped) else (0, 0, 0) for shape in scene.shapes] + [(0, 0, 0)])
    result: Mask = np.abs(dots(normal, axes[owner])) > ON_CAP
    return result


def hits(scene: Scene, origins: Floats, ways: Floats, guess: Guess) -> tuple[Any, ...]:
    """Return distance, owner, point and normal of what rays meet, arrays of n, as `trace` does. Rays pass MOST_LAYERS
    surfaces that the guess does not draw; one more counts as met."""
    found = trace(scene, origins, ways, threads=1)
    undrawn = np.array([shape.plural in guess["missing"] for shape in scene.shapes] + [False])
    if guess["caps"] and guess["inside"] and not undrawn.any():
        return tuple(found)
    distance, owner, point, normal = found
    for _ in range(MOST_LAYERS):
        passed = undrawn[owner]
        if not guess["caps"]:
            passed |= on_cap(scene, owner, normal)
        if not guess["inside"]:
            closed = np.array([shape.solid for shape in scene.shapes] + [False])[owner]
            passed |= closed & (dots(normal, ways) > 0)
        if not passed.any():
            break
        further = trace(scene, point[passed], ways[passed], threads=1)
        distance[passed] += further.distance
        owner[passed], point[passed], normal[passed] = further.owner, further.point, further.normal
    return distance, owner, point, normal


def see(scene: Scene, size: tuple[int, int], x: Floats, y: Floats, guess: Guess) -> Seen:
    """Trace pixels of a picture, from what they show to all lamps, and the same of what mirrors show."""
    (seen,) = see_each(scene, size, x, y, [guess])
    if not guess["reflections"]:
        return seen
    there = (seen.owner >= 0)[:, None]
    mirrored = seen.direction - 2 * dots(seen.direction, seen.normal)[:, None] * seen.normal
    origins = np.where(there, seen.point, scene.camera.position)
    return seen._replace(mirror=met(changed_scene(scene, guess), origins, mirrored, guess))


def see_each(scene: Scene, size: tuple[int, int], x: Floats, y: Floats, guesses: Sequence[Guess]) -> Iterator[Seen]:
    """Trace the same pixels under guesses that differ in the camera alone, all at once; without mirrors."""
    ways = np.concatenate([directions(scene, size, x, y, guess) for guess in guesses])
    origins = np.broadcast_to(np.array(scene.camera.position), ways.shape)
    seen = met(changed_scene(scene, guesses[0]), origins, ways, guesses[0])
    for start in range(0, len(ways), len(x)):
        part = slice(start, start + len(x))
        parts: list[Any] = [*(each[part] for each in seen[:4]), *(each[:, part] for each in seen[4:9])]
        yield Seen(*parts)


def met(scene: Scene, origins: Floats, ways: Floats, guess: Guess) -> Seen:
    """Trace rays, and from what they meet to all lamps; return what is seen, without mirrors.

    `scene` is the changed one. The second half of a cone, one of its last shapes, counts as the cone itself.
    """
    _, owner, point, normal = hits(scene, origins, ways, guess)
    if guess["cone"] == "both halves":
        cones = scene.cones[: len(scene.cones) // 2]
        as_in_scene = len(scene.shapes) - len(cones)  # shapes before the second halves
        owner = np.array([*range(as_in_scene), *map(scene.shapes.index, cones), -1])[owner]
    lamps, count = scene.lights, len(owner)
    to_light, distance = np.zeros((len(lamps), count, 3)), np.full((len(lamps), count), np.inf)
    strength, open_to, open_beyond = np.ones((len(lamps), count)), *np.zeros((2, len(lamps), count), bool)
    there = owner >= 0
    for i, lamp in enumerate(lamps):
        *axis, edge, steepness = lamp.cone()
        if lamp.position is None:
            to_light[i] = -np.array(axis)
        else:
            offset = np.array(lamp.position) - point[there]
            distance[i, there] = np.linalg.norm(offset, axis=-1)
            to_light[i, there] = offset / np.maximum(distance[i, there], 1e-30)[:, None]
            is_spot = edge > -2.0  # the cosine at the edge of other lamps
            if is_spot or lamp.fading():
                rim = np.clip((-(to_light[i] @ axis) - edge) * steepness, 0, 1)
                faded = np.maximum(1 - distance[i, there] * lamp.fading(), 0)
                strength[i, there] = (rim * rim * (3 - 2 * rim))[there] * faded
        occluder, *_ = hits(scene, point[there], to_light[i, there], guess)  # how far away it is
        open_to[i, there] = occluder >= distance[i, there] * (1 - 1e-9)  # but for rounding
        open_beyond[i, there] = np.isinf(occluder)
    return Seen(owner, point, np.nan_to_num(normal), ways, to_light, distance, strength, open_to, open_beyond)


def cosines(seen: Seen, guess: Guess) -> tuple[Floats, Floats]:
    """Return the normals that light falls onto, and the cosine for each lamp, (lamps, n), 0 on the other side."""
    normal = seen.normal
    if guess["normals"] != "outward":
        away = dots(normal, seen.direction) > 0
        normal = np.where(away[:, None], -normal, normal)
    cosine = dots(seen.to_light, normal)
    return normal, np.abs(cosine) if guess["normals"] == "both sides" else np.maximum(cosine, 0)


def arriving(seen: Seen, guess: Guess) -> Floats:
    """Return the share of each lamp's light that reaches each point, (lamps, n)."""
    if guess["shadows"] == "none":
        return seen.strength
    return seen.strength * (seen.open_beyond if guess["shadows"] == "behind the lamp" else seen.open_to)


def highlights(seen: Seen, normal: Floats, form: str, power: Any) -> Floats:
    """Return the highlights of each lamp, (lamps, n), without its colour."""
    if form == "blinn":
        base = dots(unit(seen.to_light - seen.direction), normal)
    else:
        along = dots(seen.to_light, normal) * dots(normal, -seen.direction)
        base = 2 * along + dots(seen.to_light, seen.direction)
    result: Floats = np.clip(base, 0, 1) ** power
    return result


def reach(scene: Scene) -> float:
    """The median distance of lamps from the camera: the unit in which light fades."""
    places = [lamp.position for lamp in scene.lights if lamp.position is not None]
    away = [float(np.linalg.norm(np.subtract(place, scene.camera.position))) for place in places]
    return max(float(np.median(away)), 1e-3) if away else 1.0
