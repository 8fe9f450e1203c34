"""A coarse picture without a compiler: the kernel's own formulas, interpreted, on all rays of the picture at once.

The time goes into calls of numpy: so many for a shape, and each takes longer the more rays there are.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from minirt.kernel.culling import binning
from minirt.kernel.frame import ray_direction, to_byte_range
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.whitted import incoming_radiance
from minirt.lanes import Vec, unit
from minirt.rendering.frame_arguments import memory_for
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

BUDGET = 0.12  # seconds
SHAPE, RAY = 2e-4, 2e-7  # seconds for the hits of all rays on a shape, and what each ray adds to it
FEWEST = 400  # rays of a picture that is worth showing


def preview(scene: Scene, width: int, height: int) -> np.ndarray | None:
    """A picture of the scene, uint8 (h, w, 4) in the order blue, green, red, alpha, as fine as can be made in about
    `BUDGET` seconds and at most of that size, in its proportions; None where the scene has too many shapes for one."""
    tries = max(1, sum(shape.parts for shape in scene.shapes)) * (1 + len(scene.lights))
    rays = (BUDGET / tries - SHAPE) / RAY
    if rays < min(FEWEST, width * height):
        return None
    divisor = max(1, ceil((width * height / rays) ** 0.5))
    return picture(scene, -(-width // divisor), -(-height // divisor))[0]


def picture(scene: Scene, width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    """The picture of that size, and its light, (h, w, 3)."""
    traced = in_one_list(Packing(binning, depth=0).pack(scene, width, height))
    y, x = np.mgrid[:height, :width].reshape(2, -1) + 0.5
    with np.errstate(all="ignore"):
        direction = unit(ray_direction(traced.camera, x, y))
        seen = incoming_radiance(traced, memory_for(traced), 0, Vec(*traced.camera[:3]), direction)
    light = np.stack([seen.x, seen.y, seen.z], axis=-1).reshape(height, width, 3)
    pixels = np.full((height, width, 4), 255, np.uint8)
    pixels[..., :3] = to_byte_range(light[..., ::-1])
    return pixels, light


def in_one_list(traced: SceneArrays) -> SceneArrays:
    """The scene without mirrors, with a single tile, and around each lamp a single cell, in which all shapes are."""
    kinds = traced.slots[:, 0]
    starts = np.searchsorted(np.sort(kinds), np.arange(len(traced.groups) + 1))
    lamps = np.arange(len(traced.lights))[:, None] * len(kinds)
    by_lamp = [np.lexsort((near, kinds)) for near in traced.light_cones[..., 4]]
    return traced._replace(
        tile_shapes=np.lexsort((traced.cones[:, 4], kinds)),
        light_buffer_cells=1,
        bvh=None,
        light_shapes=np.array(by_lamp, np.int64).ravel(),
        groups=tuple(
            group._replace(tile_starts=starts[kind : kind + 2], light_starts=lamps + starts[kind : kind + 2])
            for kind, group in enumerate(traced.groups)
        ),
    )
