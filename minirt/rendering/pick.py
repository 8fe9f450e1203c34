"""Which shape a pixel shows: the formulas of the kernel, interpreted, for one ray and all shapes of a kind at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes import Vec, dot, sqrt
from minirt.rendering.camera import camera_numbers
from minirt.scene import Scene
from minirt.shapes import KINDS, Shape


def pick(scene: Scene, width: int, height: int, x: float, y: float) -> Shape | None:
    """The shape in the middle of pixel x, y of a picture of that size, or None where there is none."""
    numbers = camera_numbers(scene.camera, width, height)
    origin, right, up, forward = (Vec(*numbers[at : at + 3]) for at in (0, 3, 6, 9))
    direction = forward + (2 * (x + 0.5) / width - 1) * right + (1 - 2 * (y + 0.5) / height) * up
    direction = direction / sqrt(dot(direction, direction))
    found: Shape | None = None
    nearest = np.inf
    for kind in KINDS:
        shapes = [shape for shape in scene.shapes if type(shape) is kind.element]
        if shapes:
            with np.errstate(all="ignore"):
                hit, t = kind.intersect(columns([shape.pack() for shape in shapes]), origin, direction)
            t = np.where(hit, t, np.inf)
            first = int(np.argmin(t))
            if t[first] < nearest:
                found, nearest = shapes[first], t[first]
    return found


def columns(packed: list[Any]) -> Any:
    """Many packed shapes of a kind as one whose numbers are arrays."""
    parts: list[Any] = []
    for part in zip(*packed, strict=True):
        if isinstance(part[0], Vec):
            parts.append(Vec(*(np.array([getattr(v, axis) for v in part]) for axis in "xyz")))
        else:
            parts.append(np.array(part))
    return type(packed[0])(*parts)
