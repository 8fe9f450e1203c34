"""Pictures without the compiler: coarse ones until a kernel is there.

Previews run the kernel's formulas, interpreted, on all rays at once. Their time goes into calls of numpy: a fixed one
for each shape, which takes longer the more rays there are.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from minirt.kernel import interpreted
from minirt.kernel.frame import ray_direction
from minirt.kernel.shading.whitted import incoming_radiance
from minirt.lanes import Vec, unit
from minirt.rendering.frame import thread_memory
from minirt.rendering.packing.camera import Crop, Request
from minirt.rendering.scene_packing import BVH, LIGHT_BUFFERS, TILES, Packing
from minirt.rendering.tone_mapping import map_tones
from minirt.scene import Scene

BUDGET = 0.12  # seconds
SHAPE, RAY = 2e-4, 2e-7  # seconds to intersect a shape with all rays, and seconds more for each ray
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
        arrays = Packing(interpreted, depth=0, without=(TILES, LIGHT_BUFFERS, BVH)).pack(scene, width, height, crop, 1)
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
