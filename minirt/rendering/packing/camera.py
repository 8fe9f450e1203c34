"""The camera as numbers: where the rays of a picture come from and go to."""

from __future__ import annotations

from functools import cache
from math import radians, tan

import numpy as np

from minirt.fields import clamp
from minirt.kernel.frame import PACKET_HEIGHT
from minirt.lanes import width
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame

NARROWEST, WIDEST = 1e-6, 179.9999  # degrees; fields of view of 0 and 180 are drawn as these


def camera_numbers(camera: Camera, width: int, height: int) -> np.ndarray:
    """Eye, right, up and forward; right and up reach from the middle of the picture, at distance 1, to its edges."""
    right, up, forward = map(np.array, camera_frame(camera))
    half = tan(radians(clamp(camera.fov, NARROWEST, WIDEST)) / 2)
    return np.concatenate([camera.position, right * half, up * (half * height / width), forward])


def pixel_rays(camera: np.ndarray, width: int, height: int) -> np.ndarray:
    """The same as eye, direction through the upper left corner of the picture, and what a pixel to the right and one
    down change in it."""
    eye, right, up, forward = camera.reshape(4, 3)
    return np.concatenate([eye, forward - right + up, right * (2 / width), up * (-2 / height)])


def packet_rays(rays: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """For each sample of a pixel, (k, 3 * width): the directions of the rays of a packet as differences from the one
    through its upper left corner. `samples` are places in the pixel: (k, 2), or (k, width, 2) where each pixel of a
    packet has places of its own."""
    across_and_down = rays[6:].reshape(2, 3)
    places = packet_places(width(rays)) + samples.reshape(len(samples), -1, 2).swapaxes(1, 2)
    differences: np.ndarray = across_and_down.T @ places
    return differences.reshape(len(samples), -1).astype(rays.dtype)


@cache
def packet_places(rays: int) -> np.ndarray:
    """Where the pixels of the rays of a packet lie in it, x and y: (2, rays)."""
    return np.stack(np.divmod(np.arange(rays), rays // PACKET_HEIGHT)[::-1]).astype(np.float64)
