"""Stack of secondary rays that wait to be traced, in packets."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.bvh.nodes import put, put_vec
from minirt.kernel.scene_arrays import SceneArrays
from minirt.lanes import BYTES, Number, Vec, lane, load, splat, width

MIN_WEIGHT = 2.0**-10  # rays that would add less than this share of their light to a pixel are not traced
MAX_DEPTH = 32  # the largest depth that a scene may ask for
# Where a packet of waiting rays has its parts, in rows of lanes; scenes without a feature leave its rows unused.
DIRECTION, WEIGHT, LEVEL, FADE, COLOUR, MEDIUM = 3, 6, 7, 8, 9, 12
RAY_ROWS = 15  # rows of lanes of a packet of waiting rays
STACK_SIZE = (MAX_DEPTH + 2) * RAY_ROWS * BYTES // 8


class Ray(NamedTuple):
    """A packet of rays."""

    origin: Vec
    direction: Vec
    weight: Number  # of its light in the pixel
    fade: Number  # one over the distance at which the light is gone, or 0
    colour: Vec  # shares of red, green and blue that tinted glass has left, in scenes that have any
    medium: Vec  # absorption of red, green and blue along the ray, likewise


def ray_stack() -> Any:
    """Allocate the stack of rays still to trace; compiled, it lies on the stack of the thread."""
    return np.zeros(STACK_SIZE)


def push_rays(scene: SceneArrays, stack: Any, waiting: int, ray: Ray, level: int) -> int:
    """Push a packet of rays, one level deeper, onto the stack, and return the new number of packets on it."""
    count = width(ray.weight)
    at = waiting * RAY_ROWS * count
    put_vec(stack, at, ray.origin)
    put_vec(stack, at + DIRECTION * count, ray.direction)
    put(stack, at + WEIGHT * count, ray.weight)
    put(stack, at + LEVEL * count, splat(level + 1.0, ray.weight))
    if scene.fades is not None:
        put(stack, at + FADE * count, ray.fade)
    if scene.media is not None:
        put_vec(stack, at + COLOUR * count, ray.colour)
        put_vec(stack, at + MEDIUM * count, ray.medium)
    return waiting + 1


def load_rays(scene: SceneArrays, stack: Any, number: int, zero: Number) -> tuple[Ray, int]:
    """Load a packet of rays from the stack, and its level."""
    count = width(zero)
    at = number * RAY_ROWS * count
    fade = zero
    colour = medium = Vec(zero, zero, zero)
    if scene.fades is not None:
        fade = load(stack, at + FADE * count)
    if scene.media is not None:
        colour, medium = load_vec(stack, at + COLOUR * count, count), load_vec(stack, at + MEDIUM * count, count)
    origin, direction = load_vec(stack, at, count), load_vec(stack, at + DIRECTION * count, count)
    level = int(lane(load(stack, at + LEVEL * count), 0))
    return Ray(origin, direction, load(stack, at + WEIGHT * count), fade, colour, medium), level


def load_vec(stack: Any, at: int, count: int) -> Vec:
    """Load vectors, of which there are `count`, from index `at` of the stack."""
    return Vec(load(stack, at), load(stack, at + count), load(stack, at + 2 * count))
