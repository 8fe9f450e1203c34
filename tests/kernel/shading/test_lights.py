"""Light sources: direction, distance and strength of point, spot and parallel lights."""

from __future__ import annotations

from math import cos, inf, radians, sin

import numpy as np
import pytest

from minirt.kernel.shading.lights import incident_light
from minirt.lanes import Vec
from minirt.rendering.packing.lights import (
    Colours,
    emitting_lights,
    light_position,
    positions_and_intensities,
    spot_parameters,
)
from minirt.scene import Ambient, Camera, FurtherLight, Lamp, Light, ParallelLight, Scene, SpotLight

EYE = Camera((0, 0, -5), (0, 0, 1), 60)
SPOT = SpotLight((0, 9, 0), (0, -1, 0), 60, 1, rim=0.4)


def light_at(light: Lamp, point: tuple[float, float, float]) -> tuple[np.ndarray, float, float]:
    """Return the direction to a light source, its distance and its relative strength at a point."""
    coordinates = [np.full(16, each) for each in point]
    with np.errstate(all="ignore"):
        numbers, position = spot_parameters([light]), Vec(*light_position(light))
        to_light, distance, strength = incident_light(numbers, 0, position, Vec(*coordinates))
    return np.array([to_light.x[0], to_light.y[0], to_light.z[0]]), float(distance[0]), float(strength[0])


def spot_point(angle: float) -> tuple[float, float, float]:
    """Return a point whose direction from the spot is so many degrees from the spot's axis."""
    return 5 * sin(radians(angle)), 9 - 5 * cos(radians(angle)), 0


def test_a_point_light_shines_equally_in_all_directions() -> None:
    to_light, distance, strength = light_at(Light((0, 3, 4), 1), (0, 0, 0))
    assert np.allclose(to_light, [0, 0.6, 0.8], rtol=1e-15)
    assert (distance, strength) == (pytest.approx(5, rel=1e-15), 1.0)


def test_fading_light_decreases_linearly() -> None:
    light = Light((0, 3, 4), 1, fade=20)
    assert light_at(light, (0, 0, 0))[2] == pytest.approx(0.75, rel=1e-15)
    assert light_at(light, (0, 3, 14))[2] == pytest.approx(0.5, rel=1e-15)
    assert light_at(light, (0, 3, 24))[2] == 0
    assert light_at(light, (0, 3, 99))[2] == 0


def test_parallel_light_comes_from_infinitely_far() -> None:
    for point in ((0.0, 0.0, 0.0), (7.0, -3.0, 1e9)):
        to_light, distance, strength = light_at(ParallelLight((0.6, -0.8, 0), 1), point)
        assert np.array_equal(to_light, [-0.6, 0.8, 0])
        assert (distance, strength) == (inf, 1.0)


def test_a_spot_shines_within_its_cone() -> None:
    # Half of 60 degrees is 30; the outer 0.4 of that is the rim, which begins at 18.
    assert light_at(SPOT, spot_point(0))[2] == 1
    assert light_at(SPOT, spot_point(17.99))[2] == 1
    assert light_at(SPOT, spot_point(30.01))[2] == 0
    assert light_at(SPOT, (0, 20, 0))[2] == 0
    t = (cos(radians(25)) - cos(radians(30))) / (cos(radians(18)) - cos(radians(30)))
    assert light_at(SPOT, spot_point(25))[2] == pytest.approx(3 * t**2 - 2 * t**3, rel=1e-12)


def test_a_spot_without_rim_has_a_sharp_edge() -> None:
    sharp = SPOT.replace(rim=0.0)
    assert light_at(sharp, spot_point(29.999))[2] == 1
    assert light_at(sharp, spot_point(30.001))[2] == 0


def test_a_spot_fades_too() -> None:
    assert light_at(SPOT.replace(fade=10), spot_point(0))[2] == pytest.approx(0.5, rel=1e-15)


def test_lights_without_brightness_are_left_out() -> None:
    lights = Light((1, 2, 3), 0.5, (255, 0, 51)), FurtherLight((0, 0, 0), 0), SPOT.replace(colour=(0, 0, 0)), SPOT
    scene = Scene((Ambient(0.1, (255, 255, 255)), EYE, *lights))
    assert emitting_lights(scene) == [lights[0], SPOT]
    found = positions_and_intensities(emitting_lights(scene), Colours())
    assert np.allclose(found, [[1, 2, 3, 0.5, 0, 0.1], [0, 9, 0, 1, 1, 1]])
