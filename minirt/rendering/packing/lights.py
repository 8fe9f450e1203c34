"""The lamps of a scene as the tables of the kernel."""

from __future__ import annotations

from math import cos, radians

import numpy as np

from minirt.scene import Ambient, Lamp, Light, ParallelLight, Scene, SpotLight

ALL_DIRECTIONS = (0.0, 0.0, 0.0, -2.0, 1.0)  # axis, end and steepness of a lamp that shines into all directions
STEEPEST = 1e30  # the rim of a spot that has none


def intensity(source: Ambient | Lamp) -> np.ndarray:
    """The light of a source at full incidence: red, green, blue."""
    return np.divide(source.colour, 255) * source.brightness


def emitting_lights(scene: Scene) -> list[Lamp]:
    """The lamps that give any light."""
    return [lamp for lamp in scene.lights if lamp.brightness and any(lamp.colour)]


def positions_and_intensities(lamps: list[Lamp]) -> np.ndarray:
    """Place and light of each, (m, 6)."""
    numbers = [(*light_position(lamp), *intensity(lamp)) for lamp in lamps]
    return np.array(numbers, np.float64).reshape(len(lamps), 6)


def light_position(lamp: Lamp) -> np.ndarray:
    """Where a lamp is; parallel light comes from no place, and is given the origin."""
    return np.array(lamp.position if isinstance(lamp, Light | SpotLight) else (0.0, 0.0, 0.0))


def spot_parameters(lamps: list[Lamp]) -> np.ndarray:
    """How the light of each goes, (m, 7), see `minirt.kernel.shading.lights`."""
    return np.array([(*spot_cone(lamp), *attenuation(lamp)) for lamp in lamps], np.float64).reshape(len(lamps), 7)


def spot_cone(lamp: Lamp) -> tuple[float, ...]:
    """Axis, cosine of the end, and one over what the cosine is greater by where all of the light is."""
    if isinstance(lamp, ParallelLight):
        return (*lamp.direction, -2.0, 1.0)
    if isinstance(lamp, SpotLight):
        half = radians(lamp.angle) / 2
        end, full = cos(half), cos(half * (1 - lamp.rim))
        return (*lamp.direction, end, 1 / (full - end) if full - end > 1 / STEEPEST else STEEPEST)
    return ALL_DIRECTIONS


def attenuation(lamp: Lamp) -> tuple[float, float]:
    """One over the distance at which its light is gone, and whether it is parallel."""
    fade = lamp.fade if isinstance(lamp, Light | SpotLight) else None
    return 1 / fade if fade else 0.0, float(isinstance(lamp, ParallelLight))
