"""The reference renderer: a second, independent renderer that the tests compare the program with.

It draws all shapes, materials, lights with hard shadows, mirrors, glass and backgrounds, one ray a pixel, in plain
numpy float64, following the manual pages of the program. It shares no code with the program except the scene's
dataclasses, and its geometry is written differently: all crossings of a line and a surface are computed, and the first
one in front of the origin is the hit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from minirt.materials import Mirror
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from tests.reference.hits import first_hits
from tests.reference.light import (
    OFF_SURFACE,
    RANDOM,
    Surface,
    is_sheet,
    is_tinted,
    left_by_media,
    mirror_and_glass,
    random_in_disc,
    shaded,
    shares,
    surface_of,
)
from tests.reference.texturing import bilinear, colour_and_normal, footprint, patterned, patterns_of, picture
from tests.reference.uv_mapping import normals
from tests.reference.vectors import DECODED, Array, dot, length, rgb, right_and_up

Parts = TypeVar("Parts", bound=tuple[Any, ...])  # a NamedTuple of arrays with an entry for each ray or point
DEPTH = 8  # reflections and refractions along a path, at most
LEAST = 2.0**-10  # share of the light of a pixel up to which rays are not followed


def render(scene: Scene, width: int, height: int, depth: int = DEPTH) -> Array:
    """Render a scene: linear light, (height, width, 3), not clamped. The field of view must be between 0 and 180."""
    origins, directions = camera_rays(scene.camera, width, height)
    before = DECODED.set(scene.camera.tone != "plain")
    pixel = 2 * np.tan(np.radians(scene.camera.fov) / 2) / width
    radiance = light_along(scene, origins.reshape(-1, 3), directions.reshape(-1, 3), depth, pixel)
    DECODED.reset(before)
    return radiance.reshape(height, width, 3) * 2.0**scene.camera.exposure


def to_bytes(linear: Array, tone: str = "plain") -> NDArray[np.uint8]:
    """Quantise linear light to bytes: clamped to [0, 1] and rounded to the nearest of 256 steps, halves upwards."""
    if tone == "filmic":
        linear = linear * (2.51 * linear + 0.03) / (linear * (2.43 * linear + 0.59) + 0.14)
    shown = np.clip(linear, 0.0, 1.0)
    if tone != "plain":
        shown = np.where(shown > 0.0031308, 1.055 * shown ** (1 / 2.4) - 0.055, 12.92 * shown)
    return np.floor(shown * 255.0 + 0.5).astype(np.uint8)


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
    """Right, up and forward of the camera: unit vectors."""
    forward = np.array(camera.direction)
    right, up = right_and_up(forward)
    turn = np.radians(camera.roll)
    return np.cos(turn) * right - np.sin(turn) * up, np.cos(turn) * up + np.sin(turn) * right, forward


class Rays(NamedTuple):
    """n rays of one generation: those of the eye, or those that hits of the generation before have sent."""

    origins: Array  # (n, 3)
    directions: Array  # (n, 3), unit
    weights: Array  # (n, 3) shares of the light of the pixel
    fade: Array  # (n,) distance at which the light along them has lost all strength, 0 for none
    pixel: Array  # (n,) index of the ray of the eye that they continue


def light_along(scene: Scene, origins: Array, directions: Array, depth: int, pixel: float = 0.0) -> Array:
    """The radiance along n rays, (n, 3), by ray tracing (Whitted 1980), one generation of rays after the other.

    `pixel` is the width of a pixel at distance 1 from the eye.
    """
    light, count = np.zeros(directions.shape), len(directions)
    rays = Rays(origins, directions, np.ones((count, 3)), np.zeros(count), np.arange(count))
    for left in range(depth, -1, -1):
        distances, owners = first_hits(scene.shapes, rays.origins, rays.directions)
        weights = rays.weights * left_by_media(scene, rays.origins, rays.directions, distances)
        fades = rays.fade > 0
        weights[fades] *= np.maximum(0, 1 - distances[fades] / rays.fade[fades])[:, None]
        rays, missed = rays._replace(weights=weights), owners < 0
        np.add.at(light, rays.pixel[missed], weights[missed] * sky(scene, rays.directions[missed]))
        if missed.all():
            break
        owned = [(index, owners == index) for index in np.unique(owners[~missed])]
        hit = [(scene.shapes[i], joined([rays], which), distances[which]) for i, which in owned]
        surfaces = [surface_hit(scene, *each, pixel) for each in hit]
        together = joined([each for _, each, _ in hit])
        np.add.at(light, together.pixel, together.weights * shaded(scene, joined([each for each, _ in surfaces])))
        sent = [
            rays
            for (shape, arrived, _), each in zip(hit, surfaces, strict=True)
            for rays in sent_on(shape, arrived, *each)
        ]
        if not left or not sent:
            break
        rays = joined(sent)
    return light


def joined(parts: Sequence[Parts], which: Any = slice(None)) -> Parts:
    """All rays, or all points, of several parts, or those of one part that are chosen."""
    return type(parts[0])(*(np.concatenate(each)[which] for each in zip(*parts, strict=True)))


def surface_hit(scene: Scene, shape: Shape, rays: Rays, distances: Array, pixel: float) -> tuple[Surface, Leaving]:
    """The points at which rays hit a shape, and what leaves there."""
    direction = rays.directions
    points = rays.origins + distances[:, None] * direction
    far = OFF_SURFACE * (distances + length(rays.origins) + length(points))
    normal = normals(shape, points)
    colour, bent = colour_and_normal(scene, shape, points, normal)
    if patterns_of(shape):
        wide = footprint(scene.camera, pixel, points, distances, direction, normal)
        colour, bent = patterned(shape, points, wide, colour, bent)
    outside = dot(normal, direction) <= 0
    facing, bent = (np.where(outside[:, None], n, -n) for n in (normal, bent))
    # The bumped normal counts, unless the mirrored ray would go through the surface.
    mirrored = direction - 2 * dot(bent, direction)[:, None] * bent
    sound = (dot(bent, direction) < 0) & (dot(mirrored, facing) > 0)
    tilted = np.where(sound[:, None], bent, facing)
    back, through = shares(shape, -dot(tilted, direction), outside)
    surface = surface_of(shape, points, facing, bent, colour, direction, far, 1 - back - through)
    return surface, Leaving(tilted, outside, back, through)


class Leaving(NamedTuple):
    """The values at n points that mirrored and refracted rays depend on."""

    tilted: Array  # (n, 3) normal of the mirror
    outside: NDArray[np.bool_]  # (n,) whether rays arrive from outside of the shape
    back: Array  # (n,) share of mirrored light
    through: Array  # (n,) share of refracted light


def sent_on(shape: Shape, rays: Rays, at: Surface, leaving: Leaving) -> list[Rays]:
    """The rays that a mirror or glass sends on, of those that hit it."""
    if not sum(mirror_and_glass(shape)):
        return []
    direction, tilted = rays.directions, leaving.tilted
    above, below = (at.points + sign * at.far[:, None] * at.normal for sign in (1, -1))
    cosine = -dot(tilted, direction)[:, None]
    mirrored = direction + 2 * cosine * tilted
    ratio = np.where(leaving.outside, 1 / shape.glass.ior, shape.glass.ior) if shape.glass else np.ones(len(direction))
    sine = ratio[:, None] * (direction + cosine * tilted)  # Snell's law: the component along the surface
    squared = dot(sine, sine)
    total = squared > 1  # total internal reflection
    refracted = sine - np.sqrt(np.maximum(0, 1 - squared))[:, None] * tilted
    tint = rgb(shape.tint.colour) if shape.tint and is_tinted(shape) and is_sheet(shape) else np.ones(3)
    mirror_fade = shape.mirror.fade if isinstance(shape.mirror, Mirror) else 0.0
    glass_fade = shape.glass.fade if shape.glass else 0.0
    back, through = leaving.back[:, None], leaving.through[:, None]
    ways = (
        (~total, above, mirrored, back * rays.weights, mirror_fade),
        (total, above, mirrored, (back + through) * rays.weights, glass_fade),
        (~total, below, refracted, through * rays.weights * tint, glass_fade),
    )
    sent = []
    for which, starts, towards, share, end in ways:
        followed = which & (share.max(axis=1) > LEAST)
        fade = np.full(followed.sum(), end)
        sent.append(Rays(starts[followed], towards[followed], share[followed], fade, rays.pixel[followed]))
    return sent


def sky(scene: Scene, directions: Array) -> Array:
    """The background in directions in which no shape is hit."""
    if scene.background is None:
        return np.zeros_like(directions)
    if not isinstance(scene.background.paint, str):
        return np.broadcast_to(rgb(scene.background.paint), directions.shape)
    pixels = rgb(255 * picture(scene.beside(scene.background.paint)))
    x, y, z = np.moveaxis(directions, -1, 0)
    edge = 0.5 / len(pixels)  # no interpolation beyond the upper and lower rows of pixels
    v = np.clip(0.5 + np.arcsin(np.clip(y, -1, 1)) / np.pi, edge, 1 - edge)
    return bilinear(pixels, 0.5 + np.arctan2(-x, z) / (2 * np.pi), v)


def render_sampled(scene: Scene, width: int, height: int, samples: int, seed: int) -> Array:
    """Render a scene with random samples: the mean of their light, not clamped, (height, width, 3)."""
    before = DECODED.set(scene.camera.tone != "plain"), RANDOM.set(np.random.default_rng(seed))
    rays = zip(*(lens_rays(scene, width, height) for _ in range(samples)), strict=True)
    light = light_along(scene, *map(np.concatenate, rays), DEPTH)
    DECODED.reset(before[0])
    RANDOM.reset(before[1])
    return light.reshape(samples, height, width, 3).mean(axis=0) * 2.0**scene.camera.exposure


def lens_rays(scene: Scene, width: int, height: int) -> tuple[Array, Array]:
    """A ray through a random place of each pixel, from a random point of the lens."""
    camera, random = scene.camera, RANDOM.get()
    assert random
    right, up, forward = camera_frame(camera)
    half = np.tan(np.radians(camera.fov) / 2)
    column, row = np.arange(width * height) % width, np.arange(width * height) // width
    x = (2 * (column + random.random(len(column))) / width - 1) * half
    y = (1 - 2 * (row + random.random(len(row))) / height) * half * height / width
    ways = forward + x[:, None] * right + y[:, None] * up
    origins = np.broadcast_to(np.array(camera.position), ways.shape)
    if camera.lens:
        sharp = origins + (camera.focus or focus_in_the_middle(scene, camera)) * ways
        on_x, on_y = random_in_disc(len(ways))
        origins = origins + camera.lens / 2 * (on_x[:, None] * right + on_y[:, None] * up)
        ways = sharp - origins
    return origins, ways / length(ways)[:, None]


def focus_in_the_middle(scene: Scene, camera: Camera) -> float:
    """The distance of what the middle of the picture shows."""
    distances, _ = first_hits(scene.shapes, np.array([camera.position]), np.array([camera.direction]))
    return float(distances[0])
