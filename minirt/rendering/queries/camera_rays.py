"""Primary rays of a camera, as the kernel generates them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minirt.errors import RenderError
from minirt.kernel.frame import ray_direction
from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.scene import Camera, Scene
from minirt.scene.arguments import check_scene


def camera_rays(scene: Scene | Camera, width: int, height: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the rays through the centres of all pixels: origins and unit directions, each (height, width, 3).

    They are the primary rays of a picture of that size with one sample a pixel; row 0 is the upper one. RenderError for
    a size below 1.

        origins, directions = minirt.camera_rays(scene, 640, 480)
        hits = minirt.trace(scene, origins.reshape(-1, 3), directions.reshape(-1, 3))
    """
    check_scene(scene, "camera_rays")
    if width < 1 or height < 1:
        raise RenderError(f"a picture has at least 1x1 pixels, got {width}x{height}")
    camera = scene if isinstance(scene, Camera) else scene.camera
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    y, x = np.mgrid[0:height, 0:width] + 0.5
    toward = ray_direction(numbers, x, y)
    directions = np.stack(np.broadcast_arrays(toward.x, toward.y, toward.z), axis=-1)
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return np.broadcast_to(numbers[:3], directions.shape).copy(), directions
