"""The reference renderer gives pictures that are known analytically."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from minirt.element import Element
from minirt.fields import Triple
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from tests.reference import render, to_bytes

WHITE = (255, 255, 255)
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)
DIM = Ambient(0.2, WHITE)
ORIGIN = (0.0, 0.0, 0.0)
FORWARD = Camera(ORIGIN, (0, 0, 1), 90)  # the picture spans -1 to 1 at the distance 1
WALL = Plane((0, 0, 10), (0, 0, 1), (200, 100, 50))


def picture(*elements: Element, width: int = 1, height: int = 1) -> np.ndarray:
    """Render a scene of these elements."""
    return render(Scene(elements), width, height)


def pixel_centres(count: int) -> np.ndarray:
    """Return the pixel centres of a picture that spans -1 to 1."""
    return (2 * np.arange(count) + 1) / count - 1


def test_a_wall_lit_perpendicularly_gets_the_whole_light() -> None:
    assert_allclose(picture(DIM, FORWARD, Light(ORIGIN, 0.6), WALL)[0, 0], np.array([200, 100, 50]) / 255 * 0.8)


def test_a_wall_lit_at_an_angle_gets_the_cosine() -> None:
    # The rays of the outer of three pixels have slope 2/3; the light is at the eye.
    row = picture(FORWARD, Light(ORIGIN, 1.0), WALL, width=3)[0, :, 0]
    assert_allclose(row, 200 / 255 * np.array([3 / 13**0.5, 1, 3 / 13**0.5]))


def test_lights_add_up_in_their_own_colours() -> None:
    white_wall = WALL.replace(colour=WHITE)
    lights = Light(ORIGIN, 0.25, RED), FurtherLight(ORIGIN, 0.5, (255, 0, 255)), FurtherLight((0, 0, 20), 1.0, GREEN)
    assert_allclose(picture(FORWARD, *lights, white_wall)[0, 0], [0.75, 0, 0.5])


def test_the_outline_of_a_sphere_is_its_tangent_cone() -> None:
    x, y = pixel_centres(100), -pixel_centres(100)[:, None]
    sphere = Sphere((0, 0, 5), 6, WHITE)  # a 3-4-5 triangle: its edge is seen 3/4 off the axis
    shown = picture(DIM, FORWARD, sphere, width=100, height=100)[..., 0]
    assert np.array_equal(shown, 0.2 * (x**2 + y**2 < 9 / 16))


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1)])
def test_the_cap_of_a_cylinder_is_a_flat_disc(axis: Triple) -> None:
    x, y = pixel_centres(50), -pixel_centres(50)[:, None]
    cap = Cylinder((0, 0, 5), axis, 2, 6, WHITE)  # its near cap is at z = 2
    shown = picture(FORWARD, Light(ORIGIN, 1.0), cap, width=50, height=50)[..., 0]
    assert_allclose(shown, np.where(x**2 + y**2 < 1 / 4, 1 / np.sqrt(1 + x**2 + y**2), 0))


def test_the_shadow_of_a_sphere_is_bounded_by_similar_triangles() -> None:
    # The light, 5 from the centre of a sphere of radius 3, sees it within slope 3/4: a disc of radius 9 at 12 below.
    light, sphere, floor = Light((0, 12, 0), 0.5), Sphere((0, 7, 0), 6, WHITE), Plane(ORIGIN, (0, 1, 0), WHITE)
    below = Camera((0, 3, 0), (0, -1, 0), 2 * np.degrees(np.arctan(10 / 3)))  # spans -10 to 10 on the floor
    x, z = 10 * pixel_centres(100), 10 * pixel_centres(100)[:, None]
    cosine = 12 / np.sqrt(x**2 + z**2 + 144)
    shown = picture(DIM, below, light, sphere, floor, width=100, height=100)[..., 0]
    assert_allclose(shown, 0.2 + 0.5 * cosine * (x**2 + z**2 > 81), atol=1e-9)


@pytest.mark.parametrize("roll", [0, 90])
@pytest.mark.parametrize(
    ("direction", "right", "up"),
    [
        ((0, 0, 1), (-1, 0, 0), (0, 1, 0)),
        ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
        ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
        ((0, 1, 0), (1, 0, 0), (0, 0, 1)),
        ((0, -1, 0), (1, 0, 0), (0, 0, -1)),
    ],
)
def test_right_and_up_of_a_camera(direction: Triple, right: Triple, up: Triple, roll: float) -> None:
    forward, right_side, above = np.array(direction), np.array(right), np.array(up)
    if roll == 90:
        right_side, above = -above, right_side  # the camera's right points to the old down
    balls = [
        Sphere(tuple(3.0 * forward + offset), 0.8, colour)
        for offset, colour in ((right_side, RED), (above, GREEN), (-above, BLUE))
    ]
    eye = FORWARD.replace(direction=direction, roll=roll)
    shown = picture(Ambient(1.0, WHITE), eye, *balls, width=27, height=27)
    # An offset of 1 at the distance 3 is a third of half of the picture: 4.5 pixels from the middle.
    for channel, column, row in ((0, 4.5, 0), (1, 0, -4.5), (2, 0, 4.5)):
        rows, columns = np.nonzero(shown[..., channel])
        assert_allclose([columns.mean() - 13, rows.mean() - 13], [column, row], atol=0.5)


def test_the_field_of_view_is_horizontal() -> None:
    mark = Sphere((-9.9, 0, 10), 1, WHITE)  # at the right edge of 90 degrees
    wide = picture(DIM, FORWARD, mark, width=40, height=10)
    assert wide[4:6, -1].all()
    assert not wide[:, :-3].any()


@pytest.mark.parametrize("twins", [WALL, Sphere((0, 0, 5), 6, WHITE), Cylinder((0, 0, 5), (0, 0.6, 0.8), 3, 3, WHITE)])
def test_the_first_of_coincident_shapes_is_visible(twins: Shape) -> None:
    first, second = twins.replace(colour=GREEN), twins.replace(colour=RED)
    shown = picture(DIM, FORWARD, first, second, width=50, height=50)
    assert shown[..., 1].any()
    assert not shown[..., 0].any()


def test_bytes_are_clamped_and_rounded_to_nearest() -> None:
    values = [-1.0, 0.0, 0.49 / 255, 0.5 / 255, 1.5 / 255, 254.4 / 255, 1.0, 300.0]
    assert to_bytes(np.array(values)).tolist() == [0, 0, 0, 1, 2, 254, 255, 255]
