"""Pictures of the reference renderer with many samples a pixel: soft shadows and depth of field by random points."""

from __future__ import annotations

import numpy as np

from minirt.scene import Camera, Scene
from tests.reference import DEPTH, camera_frame, light_along
from tests.reference.hits import first_hits
from tests.reference.light import RANDOM, random_in_disc
from tests.reference.vectors import DECODED, Array, length


def render_sampled(
    scene: Scene, width: int, height: int, samples: int, seed: int, along_the_ray: bool = False
) -> Array:
    """Render a scene with random samples: the mean of their light, each clamped to nothing, (height, width, 3).

    `along_the_ray` is a planted error: focus measured along each ray, in place of the camera's direction.
    """
    before = DECODED.set(scene.camera.tone != "plain"), RANDOM.set(np.random.default_rng(seed))
    total = np.zeros((height * width, 3))
    for _ in range(samples):
        origins, directions = lens_rays(scene, width, height, along_the_ray)
        total += light_along(scene, origins, directions, np.ones((width * height, 3)), DEPTH)
    DECODED.reset(before[0])
    RANDOM.reset(before[1])
    return total.reshape(height, width, 3) * (2.0**scene.camera.exposure / samples)


def lens_rays(scene: Scene, width: int, height: int, along_the_ray: bool) -> tuple[Array, Array]:
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
        if along_the_ray:
            ways = ways / length(ways)[:, None]
        sharp = origins + (camera.focus or focus_in_the_middle(scene, camera)) * ways
        on_x, on_y = random_in_disc(len(ways))
        origins = origins + camera.lens / 2 * (on_x[:, None] * right + on_y[:, None] * up)
        ways = sharp - origins
    return origins, ways / length(ways)[:, None]


def focus_in_the_middle(scene: Scene, camera: Camera) -> float:
    """The distance of what the middle of the picture shows."""
    distances, _ = first_hits(scene.shapes, np.array([camera.position]), np.array([camera.direction]))
    return float(distances[0])
