"""Light sources: direction, distance and strength of point, spot and parallel lights."""

from __future__ import annotations

from math import cos, inf, radians, sin
from typing import Any

import numpy as np
import pytest

from minirt.kernel.shading.lights import incident_light, specular
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


def test_parallel_light_comes_from_infinitely_far() -> None:
    for point in ((0.0, 0.0, 0.0), (7.0, -3.0, 1e9)):
        to_light, distance, strength = light_at(ParallelLight((0.6, -0.8, 0), 1), point)
        assert np.array_equal(to_light, [-0.6, 0.8, 0])
        assert (distance, strength) == (inf, 1.0)


RIM = (cos(radians(25)) - cos(radians(30))) / (cos(radians(18)) - cos(radians(30)))  # share of the way into the rim


@pytest.mark.parametrize(
    ("light", "point", "strength"),
    [
        # Half of 60 degrees is 30; the outer 0.4 of that is the rim, which begins at 18.
        (SPOT, spot_point(0), 1.0),
        (SPOT, spot_point(17.99), 1.0),
        (SPOT, spot_point(25), 3 * RIM**2 - 2 * RIM**3),
        (SPOT, spot_point(30.01), 0.0),
        (SPOT, (0, 20, 0), 0.0),
        (SPOT.replace(rim=0.0), spot_point(29.999), 1.0),
        (SPOT.replace(rim=0.0), spot_point(30.001), 0.0),
        (SPOT.replace(fade=10), spot_point(0), 0.5),
        (Light((0, 3, 4), 1, fade=20), (0, 0, 0), 0.75),
        (Light((0, 3, 4), 1, fade=20), (0, 3, 14), 0.5),
        (Light((0, 3, 4), 1, fade=20), (0, 3, 24), 0.0),
        (Light((0, 3, 4), 1, fade=20), (0, 3, 99), 0.0),
    ],
)
def test_spots_shine_within_their_cones_and_light_fades_linearly(light: Lamp, point: Any, strength: float) -> None:
    assert light_at(light, point)[2] == pytest.approx(strength, rel=1e-12, abs=0)


def test_lights_without_brightness_are_left_out() -> None:
    lights = Light((1, 2, 3), 0.5, (255, 0, 51)), FurtherLight((0, 0, 0), 0), SPOT.replace(colour=(0, 0, 0)), SPOT
    scene = Scene((Ambient(0.1, (255, 255, 255)), EYE, *lights))
    assert emitting_lights(scene) == [lights[0], SPOT]
    found = positions_and_intensities(emitting_lights(scene), Colours())
    assert np.allclose(found, [[1, 2, 3, 0.5, 0, 0.1], [0, 9, 0, 1, 1, 1]])


UP = Vec(*(np.full(16, each) for each in (0.0, 1.0, 0.0)))
LIT = np.ones(16, bool)


def highlight(light: float, eye: float, k: float, n: float, blinn: bool, lit: np.ndarray = LIT) -> float:
    """Return the highlight of a floor; light and eye are so many degrees from its normal, on opposite sides of it."""
    to_light = Vec(*(np.full(16, each) for each in (-sin(radians(light)), cos(radians(light)), 0.0)))
    direction = Vec(*(np.full(16, each) for each in (-sin(radians(eye)), -cos(radians(eye)), 0.0)))
    material = Vec(*(np.full(16, each) for each in (k, n, float(blinn))))
    share = specular(material, UP, to_light, direction, lit)
    assert np.array_equal(share, np.full(16, share[0]))
    return float(share[0])


@pytest.mark.parametrize("n", [1.0, 2.5, 50.0, 1000.0])
@pytest.mark.parametrize("eye", [20.0, 33.0, 35.0, 50.0])
def test_highlight_follows_the_power_of_the_cosine(eye: float, n: float) -> None:
    # Phong: the angle between mirrored light and eye; Blinn: half of that, between the normal and the halfway vector.
    assert highlight(35, eye, 0.7, n, False) == pytest.approx(0.7 * cos(radians(eye - 35)) ** n, rel=1e-10)
    assert highlight(35, eye, 0.7, n, True) == pytest.approx(0.7 * cos(radians((eye - 35) / 2)) ** n, rel=1e-10)


def test_no_highlight_behind_the_mirrored_direction_or_in_shadow() -> None:
    assert highlight(60, -40, 1, 1, False) == 0  # 100 degrees apart
    assert highlight(60, -40, 1, 1, True) == pytest.approx(cos(radians(50)))
    assert highlight(35, 35, 0.7, 50, False, ~LIT) == 0
    assert highlight(35, 35, 0, 50, False) == 0
