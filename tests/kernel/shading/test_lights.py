"""How light comes from a lamp."""

from __future__ import annotations

from math import cos, inf, radians, sin

import numpy as np
import pytest

from minirt.kernel.shading.lights import arrival
from minirt.lanes import Vec
from minirt.rendering.packing.lights import emitting_lights, light_position, positions_and_intensities, spot_parameters
from minirt.scene import Ambient, Camera, FurtherLight, Lamp, Light, ParallelLight, Scene, SpotLight

EYE = Camera((0, 0, -5), (0, 0, 1), 60)
SPOT = SpotLight((0, 9, 0), (0, -1, 0), 60, 1, rim=0.4)


def came(lamp: Lamp, point: tuple[float, float, float]) -> tuple[np.ndarray, float, float]:
    """The direction, the distance and the strength of a lamp's light as a point sees it."""
    spread = [np.full(16, each) for each in point]
    with np.errstate(all="ignore"):
        towards, distance, strength = arrival(spot_parameters([lamp]), 0, Vec(*light_position(lamp)), Vec(*spread))
    return np.array([towards.x[0], towards.y[0], towards.z[0]]), float(distance[0]), float(strength[0])


def below(angle: float) -> tuple[float, float, float]:
    """A point that the spot sees so many degrees from its axis."""
    return 5 * sin(radians(angle)), 9 - 5 * cos(radians(angle)), 0


def test_a_point_light_shines_everywhere_alike() -> None:
    towards, distance, strength = came(Light((0, 3, 4), 1), (0, 0, 0))
    assert np.allclose(towards, [0, 0.6, 0.8], rtol=1e-15)
    assert (distance, strength) == (pytest.approx(5, rel=1e-15), 1.0)


def test_light_that_fades_goes_down_in_a_line() -> None:
    lamp = Light((0, 3, 4), 1, fade=20)
    assert came(lamp, (0, 0, 0))[2] == pytest.approx(0.75, rel=1e-15)
    assert came(lamp, (0, 3, 14))[2] == pytest.approx(0.5, rel=1e-15)
    assert came(lamp, (0, 3, 24))[2] == 0
    assert came(lamp, (0, 3, 99))[2] == 0


def test_parallel_light_comes_from_infinitely_far() -> None:
    for point in ((0.0, 0.0, 0.0), (7.0, -3.0, 1e9)):
        towards, distance, strength = came(ParallelLight((0.6, -0.8, 0), 1), point)
        assert np.array_equal(towards, [-0.6, 0.8, 0])
        assert (distance, strength) == (inf, 1.0)


def test_a_spot_shines_within_its_cone() -> None:
    # Half of 60 degrees is 30; the outer 0.4 of that is the rim, which begins at 18.
    assert came(SPOT, below(0))[2] == 1
    assert came(SPOT, below(17.99))[2] == 1
    assert came(SPOT, below(30.01))[2] == 0
    assert came(SPOT, (0, 20, 0))[2] == 0
    t = (cos(radians(25)) - cos(radians(30))) / (cos(radians(18)) - cos(radians(30)))
    assert came(SPOT, below(25))[2] == pytest.approx(3 * t**2 - 2 * t**3, rel=1e-12)


def test_a_spot_without_rim_has_a_sharp_edge() -> None:
    sharp = SPOT.replace(rim=0.0)
    assert came(sharp, below(29.999))[2] == 1
    assert came(sharp, below(30.001))[2] == 0


def test_a_spot_fades_too() -> None:
    assert came(SPOT.replace(fade=10), below(0))[2] == pytest.approx(0.5, rel=1e-15)


def test_lamps_that_give_no_light_are_left_out() -> None:
    lamps = Light((1, 2, 3), 0.5, (255, 0, 51)), FurtherLight((0, 0, 0), 0), SPOT.replace(colour=(0, 0, 0)), SPOT
    scene = Scene((Ambient(0.1, (255, 255, 255)), EYE, *lamps))
    assert emitting_lights(scene) == [lamps[0], SPOT]
    assert np.allclose(positions_and_intensities(emitting_lights(scene)), [[1, 2, 3, 0.5, 0, 0.1], [0, 9, 0, 1, 1, 1]])
