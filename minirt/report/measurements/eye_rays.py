"""Random rays from the eye of a scene at its own shapes."""

from __future__ import annotations

import numpy as np

from minirt.rendering.packing.camera import camera_numbers
from minirt.report.measurements.random_rays import Array, Random, Rays, unit
from minirt.scene import Scene
from minirt.shapes import Kind, Shape


def rays_from_the_eye(kind: Kind, scene: Scene, random: Random, m: int, n: int) -> Rays:
    """Make n rays at each of up to m shapes of a type: into its bounding box, or into the picture if it is infinite."""
    shapes = [shape for shape in scene.shapes if type(shape) is kind.element]
    if len(shapes) > m:
        shapes = [shapes[index] for index in sorted(random.choice(len(shapes), m, replace=False))]
    eye = np.array(scene.camera.position)
    directions = np.stack([directions_towards(shape, scene, random, n) for shape in shapes])
    return Rays(shapes, np.broadcast_to(eye, directions.shape).copy(), directions)


def directions_towards(shape: Shape, scene: Scene, random: Random, n: int) -> Array:
    """Return random unit directions from the eye to a shape, (n, 3)."""
    box = shape.bounds()
    if not box:
        _, right, up, forward = camera_numbers(scene.camera, 16, 9).reshape(4, 3)
        x, y = random.uniform(-1, 1, (2, n, 1))
        return unit(forward + x * right + y * up)
    way = random.uniform(*box, (n, 3)) - scene.camera.position
    return unit(np.where(way.any(axis=1, keepdims=True), way, 1.0))
