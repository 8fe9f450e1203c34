"""Tone curves: which light each of the 256 levels of a picture stands for.

- plain: levels are in proportion to light.
- srgb: the transfer function of sRGB (IEC 61966-2-1).
- filmic: Narkowicz's fit to the tone curve of ACES (Narkowicz, ACES Filmic Tone Mapping Curve, 2015), applied to red,
  green and blue each, then the transfer function of sRGB. Light up to 7.24 keeps differences.

With srgb and filmic the colours and pictures of a scene are decoded by the transfer function of sRGB before they become
shares of light; with plain they are shares of light as they are.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

LEVELS = 256
PLAIN, SRGB, FILMIC = "plain", "srgb", "filmic"
TOE, SLOPE, OFFSET, GAMMA = 0.04045, 12.92, 0.055, 2.4  # IEC 61966-2-1
A, B, C, D, E = 2.51, 0.03, 2.43, 0.59, 0.14  # Narkowicz: (A x^2 + B x) / (C x^2 + D x + E)


class Tone(NamedTuple):
    """A tone curve by its values at the levels of a picture."""

    light: np.ndarray  # (256,) the light that each level stands for
    halfway: np.ndarray  # (255,) the light from which on a level and not the one below it is nearer, on the curve
    decodes: bool  # whether colours are decoded by the transfer function of sRGB


@cache
def tone_named(name: str) -> Tone:
    """Return the tone curve with a name; KeyError for an unknown one."""
    levels = np.arange(LEVELS)
    return Tone(light_of(levels / 255, name), light_of((levels[1:] - 0.5) / 255, name), name != PLAIN)


def light_of(levels: np.ndarray, name: str) -> np.ndarray:
    """Return the light that levels in [0, 1] stand for on a tone curve."""
    return {PLAIN: levels, SRGB: decode_srgb(levels), FILMIC: uncompressed(decode_srgb(levels))}[name]


def decode_srgb(levels: np.ndarray) -> np.ndarray:
    """Return the light of levels in [0, 1] of sRGB."""
    light: np.ndarray = np.where(levels <= TOE, levels / SLOPE, ((levels + OFFSET) / (1 + OFFSET)) ** GAMMA)
    return light


def levels_of(light: np.ndarray, name: str) -> np.ndarray:
    """Return the levels in [0, 1] of light on a tone curve: the inverse of `light_of`, clamped."""
    if name == FILMIC:
        bounded = np.minimum(light, 1e6)  # whose square is finite; the curve has long passed 1
        light = bounded * (A * bounded + B) / (bounded * (C * bounded + D) + E)
    light = np.clip(light, 0.0, 1.0)
    return light if name == PLAIN else encode_srgb(light)


def encode_srgb(light: np.ndarray) -> np.ndarray:
    """Return the levels in [0, 1] of light in [0, 1]."""
    steep = (1 + OFFSET) * light ** (1 / GAMMA) - OFFSET
    levels: np.ndarray = np.where(light <= TOE / SLOPE, light * SLOPE, steep)
    return levels


def uncompressed(shown: np.ndarray) -> np.ndarray:
    """Return the light that Narkowicz's curve maps to some light in [0, 1]."""
    a, b, c = A - C * shown, B - D * shown, -E * shown
    light: np.ndarray = (np.sqrt(b * b - 4 * a * c) - b) / (2 * a)
    return light
