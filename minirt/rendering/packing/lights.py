"""Packs the lights of a scene into the arrays of the kernel."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np

from minirt.rendering.packing.colours import Colours
from minirt.scene import Ambient, Lamp, Light, ParallelLight, Scene, SpotLight

ALL_DIRECTIONS = (0.0, 0.0, 0.0, -2.0, 1.0)  # axis, end and steepness of a light that shines in all directions
TURN = 2.4  # radians, from the samples of one light to those of the next: the golden angle, rounded
STEEPEST = 1e30  # the steepness of a spot whose rim has no width


def intensity(source: Ambient | Lamp, colours: Colours) -> np.ndarray:
    """The light of a source at full incidence: red, green, blue."""
    return colours.light(source.colour, source.brightness)


def emitting_lights(scene: Scene) -> list[Lamp]:
    """The lights of a scene that are neither off nor black."""
    return [light for light in scene.lights if light.brightness and any(light.colour)]


def positions_and_intensities(lights: list[Lamp], colours: Colours) -> np.ndarray:
    """A row for each of m lights, (m, 6): position and intensity."""
    rows = [(*light_position(light), *intensity(light, colours)) for light in lights]
    return np.array(rows, np.float64).reshape(len(lights), 6)


def light_position(light: Lamp) -> np.ndarray:
    """The position of a light; the origin for parallel light, which has none."""
    return np.array(light.position if isinstance(light, Light | SpotLight) else (0.0, 0.0, 0.0))


def radius_of(light: Lamp) -> float:
    """The radius of a light with a place; 0 for a point and for parallel light."""
    return (light.size or 0.0) / 2 if isinstance(light, Light | SpotLight) else 0.0


def tangent_of(light: Lamp) -> float:
    """The tangent of half the angular diameter of parallel light; 0 for other light."""
    return tan(radians(light.size or 0.0) / 2) if isinstance(light, ParallelLight) else 0.0


def sizes(lights: list[Lamp]) -> np.ndarray:
    """A row for each of m lights, (m, 4): see `minirt.kernel.shading.apertures`."""
    rows = [(radius_of(each), tangent_of(each), cos(TURN * i), sin(TURN * i)) for i, each in enumerate(lights)]
    return np.array(rows, np.float64).reshape(len(lights), 4)


def spot_parameters(lights: list[Lamp]) -> np.ndarray:
    """A row for each of m lights, (m, 7): cone and attenuation, see `minirt.kernel.shading.lights`."""
    return np.array([(*spot_cone(light), *attenuation(light)) for light in lights], np.float64).reshape(len(lights), 7)


def spot_cone(light: Lamp) -> tuple[float, ...]:
    """Axis, cosine at the edge of the cone, and steepness: 1 / (cosine at full intensity - cosine at the edge)."""
    if isinstance(light, ParallelLight):
        return (*light.direction, -2.0, 1.0)
    if isinstance(light, SpotLight):
        half = radians(light.angle) / 2
        end, full = cos(half), cos(half * (1 - light.rim))
        return (*light.direction, end, 1 / (full - end) if full - end > 1 / STEEPEST else STEEPEST)
    return ALL_DIRECTIONS


def attenuation(light: Lamp) -> tuple[float, float]:
    """1 / the distance at which a light has faded out, 0 if it never does; and 1 if it is parallel, else 0."""
    fade = light.fade if isinstance(light, Light | SpotLight) else None
    return 1 / fade if fade else 0.0, float(isinstance(light, ParallelLight))
