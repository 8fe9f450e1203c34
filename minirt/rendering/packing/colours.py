"""Colours of a scene as light, and as shares of light: decoded where its tone asks for it, and exposed.

Light is linear in its sources: an exposure multiplies each source, and so the whole picture.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from minirt.materials import picture_cache
from minirt.rendering.developing.tone import decode_srgb, tone_named
from minirt.scene import Camera

BYTES = np.arange(256, dtype=np.float32) * np.float32(1 / 255)  # as the kernel reads bytes that are shares of light


class Colours(NamedTuple):
    """The reading of a scene's colours, as its tone and exposure ask for it."""

    decodes: bool = False  # whether they are decoded by the transfer function of sRGB
    gain: float = 1.0  # factor of each source of light

    def shares(self, colour: tuple[float, ...]) -> np.ndarray:
        """Return the shares of light of a colour, such as that of a surface: red, green, blue in [0, 1]."""
        return self.decoded(np.divide(colour, 255))

    def light(self, colour: tuple[float, ...], brightness: float = 1.0) -> np.ndarray:
        """Return the light of a source of that colour."""
        return self.shares(colour) * (brightness * self.gain)

    def decoded(self, colours: np.ndarray) -> np.ndarray:
        """Return colours in [0, 1] as shares of light."""
        return decode_srgb(colours) if self.decodes else colours

    def surface_colours(self, colours_and_extents: np.ndarray) -> np.ndarray:
        """Return `minirt.kernel.scene_arrays.SceneArrays.colours_and_extents` with colours as shares of light."""
        if not self.decodes:
            return colours_and_extents
        return np.hstack([decode_srgb(colours_and_extents[:, :3]), colours_and_extents[:, 3:]])

    @property
    def texture(self) -> Callable[[Path], np.ndarray]:
        """The function that reads a picture file as shares of light, as bytes where they are in proportion to them."""
        return decoded_texture if self.decodes else picture_cache.picture

    def sky(self, path: Path) -> np.ndarray:
        """Read a picture file as the light of a sky, exposed; bytes where they are in proportion to light in [0, 1]."""
        pixels = picture_cache.sky(path)
        if pixels.dtype == np.uint8 and (self.decodes or self.gain != 1):
            pixels = self.of_bytes.take(pixels)
        if self.gain == 1:
            return pixels
        with np.errstate(over="ignore"):
            return np.minimum(pixels * np.float32(self.gain), np.finfo(np.float32).max)

    @property
    def of_bytes(self) -> np.ndarray:
        """The share of light that each byte stands for, float32 (256,)."""
        return self.decoded(np.arange(256) / 255).astype(np.float32) if self.decodes else BYTES


def decoded_texture(path: Path) -> np.ndarray:
    """Read a picture file as shares of light, decoded by the transfer function of sRGB."""
    return Colours(decodes=True).of_bytes.take(picture_cache.picture(path))


def colours_of(camera: Camera) -> Colours:
    """Return how the colours of a scene with this camera are read."""
    return Colours(tone_named(camera.tone).decodes, 2.0**camera.exposure)
