"""The camera as numbers: where the rays of a picture come from and go to."""

from __future__ import annotations

from math import radians, tan

import numpy as np

from minirt.fields import clamp
from minirt.scene import Camera
from minirt.scene.view import view

NARROWEST, WIDEST = 1e-6, 179.9999  # degrees; fields of view of 0 and 180 are drawn as these


def camera_numbers(camera: Camera, width: int, height: int) -> np.ndarray:
    """Eye, right, up and forward; right and up reach from the middle of the picture, at distance 1, to its edges."""
    right, up, forward = map(np.array, view(camera))
    half = tan(radians(clamp(camera.fov, NARROWEST, WIDEST)) / 2)
    return np.concatenate([camera.position, right * half, up * (half * height / width), forward])
