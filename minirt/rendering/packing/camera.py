"""Packs the camera into numbers, and generates its primary rays for the packets of a picture."""

from __future__ import annotations

from functools import cache
from math import radians, tan

import numpy as np

from minirt.fields import clamp
from minirt.kernel.stored_light import PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.crop import Crop
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame

NARROWEST, WIDEST = 1e-6, 179.9999  # degrees; fields of view of 0 and 180 are drawn as these


def camera_numbers(camera: Camera, width: int, height: int) -> np.ndarray:
    """Eye, right, up and forward, (12,); right and up reach from the centre of the image plane, at distance 1, to its
    edges."""
    right, up, forward = map(np.array, camera_frame(camera))
    half = tan(radians(clamp(camera.fov, NARROWEST, WIDEST)) / 2)
    return np.concatenate([camera.position, right * half, up * (half * height / width), forward])


def pixel_rays(camera: np.ndarray, width: int, height: int) -> np.ndarray:
    """Convert `camera_numbers` to eye, direction through the upper left corner of the picture, and the changes of that
    direction a pixel to the right and a pixel down, (12,)."""
    eye, right, up, forward = camera.reshape(4, 3)
    return np.concatenate([eye, forward - right + up, right * (2 / width), up * (-2 / height)])


def placed_rays(camera: np.ndarray, crop: Crop) -> np.ndarray:
    """Return `pixel_rays` of a picture, and the pixel at which a rectangle of it begins, (14,)."""
    return np.append(pixel_rays(camera, crop.width, crop.height), (crop.left, crop.top))


def packet_rays(rays: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """The directions of the rays of a packet for each sample, (k, 3 * width), as differences from the direction through
    the upper left corner of the packet.

    `rays` are `pixel_rays` or `placed_rays`; `samples` are positions in a pixel, (k, 2), or (k, width, 2) where each
    pixel of a packet has its own.
    """
    across_and_down = rays[6:12].reshape(2, 3)
    positions = packet_pixels(width(rays)) + samples.reshape(len(samples), -1, 2).swapaxes(1, 2)
    differences: np.ndarray = across_and_down.T @ positions
    return differences.reshape(len(samples), -1).astype(rays.dtype)


@cache
def packet_pixels(rays: int) -> np.ndarray:
    """The x and y of the pixel of each ray within a packet, (2, rays)."""
    return np.stack(np.divmod(np.arange(rays), rays // PACKET_HEIGHT)[::-1]).astype(np.float64)
