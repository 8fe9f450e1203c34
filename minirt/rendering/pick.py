"""Which shape a pixel shows: the formulas of the kernel, interpreted, for one ray and all shapes of a kind at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.kernel import lists
from minirt.kernel.frame import TILE, tiles, towards
from minirt.kernel.trace import NEARBY, nearest
from minirt.lanes import Vec, lane, splat, unit
from minirt.rendering.camera import camera_numbers, pixel_rays
from minirt.rendering.packing import Packing
from minirt.scene import Scene
from minirt.shapes import KINDS, Shape


def pick(scene: Scene, width: int, height: int, x: int, y: int) -> Shape | None:
    """The shape in the middle of pixel x, y of a picture of that size, or None where there is none."""
    camera = pixel_rays(camera_numbers(scene.camera, width, height), width, height)
    origin, direction = Vec(*camera[:3]), unit(towards(camera, x + 0.5, y + 0.5))
    with np.errstate(all="ignore"):
        shapes = in_front(scene.shapes, origin, direction)
        if len(shapes) < 2:
            return shapes[0] if shapes else None
        # Surfaces that may coincide: the kernel has a rule for them.
        traced = Packing(lists).pack(Scene((scene.camera, *shapes)), width, height)
        rays = Vec(*(splat(part, camera) for part in (direction.x, direction.y, direction.z)))
        _, owner, _ = nearest(traced, y // TILE * tiles(width) + x // TILE, origin, rays)
    return shapes[int(lane(owner, 0))]


def in_front(shapes: tuple[Shape, ...], origin: Vec, direction: Vec) -> list[Shape]:
    """Of the shapes that a ray hits the nearest, and those so close to it that they may be in the same place."""
    distance = np.full(len(shapes), np.inf)
    for kind in KINDS:
        places = [place for place, shape in enumerate(shapes) if type(shape) is kind.element]
        if places:
            hit, t = kind.intersect(columns([shapes[place].pack() for place in places]), origin, direction)
            distance[places] = np.where(hit, t, np.inf)
    least = distance.min(initial=np.inf)
    return [shapes[place] for place in np.flatnonzero(np.isfinite(distance) & (distance <= least * (1 + 2 * NEARBY)))]


def columns(packed: list[Any]) -> Any:
    """Many packed shapes of a kind as one whose numbers are arrays."""
    parts: list[Any] = []
    for part in zip(*packed, strict=True):
        if isinstance(part[0], Vec):
            parts.append(Vec(*(np.array([getattr(v, axis) for v in part]) for axis in "xyz")))
        else:
            parts.append(np.array(part))
    return type(packed[0])(*parts)
