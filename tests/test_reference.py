"""The program, and the reference renderer with which it is compared, give pictures that are known analytically."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_allclose

import minirt
from minirt.fields import Triple
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import Cylinder, Plane, Sphere
from tests.reference import render

Render = Callable[[Scene, int, int], np.ndarray]
WHITE = (255, 255, 255)
DIM, ORIGIN = Ambient(0.2, WHITE), (0.0, 0.0, 0.0)
FORWARD = Camera(ORIGIN, (0, 0, 1), 90)  # the picture spans -1 to 1 at the distance 1
SIZE = 60
X = (2 * np.arange(SIZE) + 1) / SIZE - 1  # of the pixel centres
Y = -X[:, None]

pytestmark = pytest.mark.parametrize("light_of", [render, lambda *args: minirt.render(*args).linear], ids=["ref", ""])


def test_lights_add_up_in_their_own_colours_by_the_cosine(light_of: Render) -> None:
    wall = Plane((0, 0, 10), (0, 0, 1), (255, 128, 51))
    lights = Light(ORIGIN, 0.25, (255, 0, 0)), FurtherLight(ORIGIN, 0.5, (255, 0, 255))
    shown = light_of(Scene((DIM, FORWARD, *lights, FurtherLight((0, 0, 20), 1.0, WHITE), wall)), SIZE, SIZE)
    cosine = 1 / np.sqrt(1 + X**2 + Y**2)[..., None]
    expected = np.array([1, 128 / 255, 0.2]) * (0.2 + cosine * [0.75, 0, 0.5])
    assert_allclose(shown, expected, rtol=1e-7)


def test_the_outline_of_a_sphere_is_its_tangent_cone(light_of: Render) -> None:
    sphere = Sphere((0, 0, 5), 6, WHITE)  # a 3-4-5 triangle: its edge is seen 3/4 off the axis
    shown = light_of(Scene((DIM, FORWARD, sphere)), SIZE, SIZE)[..., 0]
    assert_allclose(shown, 0.2 * (X**2 + Y**2 < 9 / 16))


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1)])
def test_the_cap_of_a_cylinder_is_a_flat_disc(light_of: Render, axis: Triple) -> None:
    cap = Cylinder((0, 0, 5), axis, 2, 6, WHITE)  # its near cap is at z = 2
    shown = light_of(Scene((Ambient(0, WHITE), FORWARD, Light(ORIGIN, 1.0), cap)), SIZE, SIZE)[..., 0]
    assert_allclose(shown, np.where(X**2 + Y**2 < 1 / 4, 1 / np.sqrt(1 + X**2 + Y**2), 0))


def test_the_shadow_of_a_sphere_is_bounded_by_similar_triangles(light_of: Render) -> None:
    # The light, 5 from the centre of a sphere of radius 3, sees it within slope 3/4: a disc of radius 9 at 12 below.
    light, sphere, floor = Light((0, 12, 0), 0.5), Sphere((0, 7, 0), 6, WHITE), Plane(ORIGIN, (0, 1, 0), WHITE)
    below = Camera((0, 3, 0), (0, -1, 0), 2 * np.degrees(np.arctan(10 / 3)))  # spans -10 to 10 on the floor
    squared = 100 * (X**2 + Y**2)
    shown = light_of(Scene((DIM, below, light, sphere, floor)), SIZE, SIZE)[..., 0]
    assert_allclose(shown, 0.2 + 0.5 * 12 / np.sqrt(squared + 144) * (squared > 81), atol=1e-9)
