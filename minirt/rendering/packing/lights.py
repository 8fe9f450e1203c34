"""The lamps of a scene as the tables of the kernel."""

from __future__ import annotations

from math import cos, radians

import numpy as np

from minirt.scene import Ambient, Lamp, Light, ParallelLight, Scene, SpotLight

EVERYWHERE = (0.0, 0.0, 0.0, -2.0, 1.0)  # axis, end and steepness of a lamp that shines into all directions
STEEPEST = 1e30  # the rim of a spot that has none


def light_of(source: Ambient | Lamp) -> np.ndarray:
    """The light of a source at full incidence: red, green, blue."""
    return np.divide(source.colour, 255) * source.brightness


def shining(scene: Scene) -> list[Lamp]:
    """The lamps that give any light."""
    return [lamp for lamp in scene.lights if lamp.brightness and any(lamp.colour)]


def light_numbers(lamps: list[Lamp]) -> np.ndarray:
    """Place and light of each, (m, 6)."""
    numbers = [(*place_of(lamp), *light_of(lamp)) for lamp in lamps]
    return np.array(numbers, np.float64).reshape(len(lamps), 6)


def place_of(lamp: Lamp) -> np.ndarray:
    """Where a lamp is; parallel light comes from no place, and is given the origin."""
    return np.array(lamp.position if isinstance(lamp, Light | SpotLight) else (0.0, 0.0, 0.0))


def spot_numbers(lamps: list[Lamp]) -> np.ndarray:
    """How the light of each goes, (m, 7), see `minirt.kernel.shading.lights`."""
    return np.array([(*cone_of(lamp), *reach_of(lamp)) for lamp in lamps], np.float64).reshape(len(lamps), 7)


def cone_of(lamp: Lamp) -> tuple[float, ...]:
    """Axis, cosine of the end, and one over what the cosine is greater by where all of the light is."""
    if isinstance(lamp, ParallelLight):
        return (*lamp.direction, -2.0, 1.0)
    if isinstance(lamp, SpotLight):
        half = radians(lamp.angle) / 2
        end, full = cos(half), cos(half * (1 - lamp.rim))
        return (*lamp.direction, end, 1 / (full - end) if full - end > 1 / STEEPEST else STEEPEST)
    return EVERYWHERE


def reach_of(lamp: Lamp) -> tuple[float, float]:
    """One over the distance at which its light is gone, and whether it is parallel."""
    fade = lamp.fade if isinstance(lamp, Light | SpotLight) else None
    return 1 / fade if fade else 0.0, float(isinstance(lamp, ParallelLight))
