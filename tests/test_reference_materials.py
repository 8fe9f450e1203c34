"""Lights, materials and backgrounds of the reference renderer give light that is known analytically."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from minirt.element import Element
from minirt.materials import Bump, Checker, Glass, Specular
from minirt.scene import Ambient, Background, Camera, FurtherLight, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from tests.reference import LEAST, light_along, render, sky
from tests.reference.uv_mapping import normals, surface_point
from tests.reference.vectors import dot, unit

WHITE, BLACK, GREY = (255, 255, 255), (0, 0, 0), (51, 51, 51)
AHEAD = Camera((0, 0, 0), (0, 0, 1), 90)
WALL = Plane((0, 0, 10), (0, 0, -1), WHITE)
BLUE_SKY = Background((51, 102, 204))


def middle(*elements: Element, depth: int = 8) -> np.ndarray:
    """Return the radiance of the pixel in the middle."""
    return render(Scene(elements), 1, 1, depth)[0, 0]


def radiance(scene: Scene, direction: tuple[float, float, float]) -> np.ndarray:
    """Return the radiance along a ray from the origin."""
    return light_along(scene, np.zeros((1, 3)), unit(np.array([direction])), np.ones((1, 3)), 8)[0]


def test_parallel_light_has_no_distance() -> None:
    sun = ParallelLight((0, -0.6, 0.8), 0.5)
    for far in (1.0, 1e4):
        assert_allclose(middle(AHEAD, sun, WALL.replace(point=(0, 0, far))), 0.5 * 0.8)
    occluder = Sphere((0, 600, -790), 2, WHITE)  # far away, between the light and the middle of the wall
    assert not middle(AHEAD, sun, WALL, occluder).any()


@pytest.mark.parametrize(("rim", "offset", "share"), [(0.0, 0.99, 1.0), (0.0, 1.01, 0.0), (1.0, 0.0, 1.0)])
def test_a_spot_ends_at_half_its_angle(rim: float, offset: float, share: float) -> None:
    spot = SpotLight((0, 0, 9), (0, 0, 1), 90, 1.0, rim=rim)  # one unit before the wall: a disc of radius 1
    scene = Scene([AHEAD, spot, WALL])
    assert_allclose(radiance(scene, (offset, 0, 10)), share / np.hypot(1, offset), atol=1e-9)


def test_the_rim_of_a_spot_follows_the_cubic() -> None:
    half = np.radians(40)
    spot = SpotLight((0, 0, 0), (0, 0, 1), 80, 1.0, rim=0.5)
    for t in (0.25, 0.5, 0.9):
        cosine = np.cos(half) + t * (np.cos(half / 2) - np.cos(half))
        slope = np.sqrt(1 - cosine**2) / cosine
        light = radiance(Scene([AHEAD, spot, WALL]), (slope, 0, 1))
        assert_allclose(light, cosine * (3 * t**2 - 2 * t**3))


def test_light_fades_with_the_distance() -> None:
    assert_allclose(middle(AHEAD, Light((0, 0, 0), 1.0, fade=40.0), WALL), 0.75)
    assert not middle(AHEAD, FurtherLight((0, 0, 0), 1.0, fade=9.0), WALL).any()


def test_specular_highlights_of_phong_and_blinn() -> None:
    # Seen from the wall the light is 2a from the eye: a from the halfway vector, 2a from the mirrored ray.
    a = np.radians(10)
    light = Light((10 * np.tan(2 * a), 0, 0), 0.5)
    black = WALL.replace(colour=BLACK)
    assert_allclose(middle(AHEAD, light, black.replace(specular=Specular(0.6, 9))), 0.3 * np.cos(2 * a) ** 9)
    assert_allclose(middle(AHEAD, light, black.replace(specular=Specular(0.6, 9, blinn=True))), 0.3 * np.cos(a) ** 9)


def test_a_mirror_reflects_its_share() -> None:
    mirror = WALL.replace(mirror=0.25)
    assert_allclose(middle(AHEAD, Ambient(1.0, WHITE), BLUE_SKY, mirror), 0.75 + 0.25 * np.array([0.2, 0.4, 0.8]))
    assert_allclose(middle(AHEAD, Ambient(1.0, WHITE), BLUE_SKY, mirror, depth=0), 0.75)
    faint = WALL.replace(colour=BLACK, mirror=LEAST)
    assert not middle(AHEAD, BLUE_SKY, faint).any()


def test_glass_bends_light_by_snells_law() -> None:
    # A ray enters water at 30 degrees and hits a board of two colours, whose edge is where it should arrive.
    below, angle = 4.0, np.radians(30)
    arrives = 5 * np.tan(angle) + below * np.tan(np.arcsin(np.sin(angle) / 1.33))
    water = Plane((0, -5, 0), (0, 1, 0), BLACK, glass=Glass(1.33))
    for side, colour in ((-0.01, 1.0), (0.01, 0.0)):
        ground = Plane((arrives + side, -9, 0), (0, 1, 0), BLACK, checker=Checker(100, WHITE))
        scene = Scene([AHEAD, Ambient(1.0, WHITE), water, ground])
        assert_allclose(radiance(scene, (np.sin(angle), -np.cos(angle), 1e-6)), colour)


def test_total_internal_reflection_in_glass() -> None:
    ceiling = Plane((0, 5, 0), (0, 1, 0), BLACK, glass=Glass(1.5))  # the eye is inside
    ground = Plane((0, -5, 0), (0, 1, 0), GREY)
    scene = Scene([AHEAD, Ambient(1.0, WHITE), BLUE_SKY, ceiling, ground])
    limit = np.arcsin(1 / 1.5)
    for angle, light in ((limit - 0.01, [0.2, 0.4, 0.8]), (limit + 0.01, [0.2] * 3)):
        assert_allclose(radiance(scene, (np.sin(angle), np.cos(angle), 0)), light)


def test_a_checkerboard_begins_at_the_lower_left() -> None:
    board = Square((0, 0, 10), (0, 0, -1), 8, WHITE, checker=Checker(0.25, BLACK))
    shown = render(
        Scene([Camera((0, 0, 0), (0, 0, 1), 2 * np.degrees(np.arctan(0.4))), Ambient(1.0, WHITE), board]), 8, 8
    )
    lower_left = np.kron(np.indices((4, 4)).sum(axis=0) % 2 == 0, np.ones((2, 2)))
    assert np.array_equal(shown[::-1, :, 0], lower_left)


def test_a_texture_is_interpolated_bilinearly(tmp_path: Path) -> None:
    Image.fromarray(np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [0, 0, 0]]], np.uint8)).save(tmp_path / "a.png")
    wall = Square((0, 0, 10), (0, 0, -1), 4, WHITE, texture="a.png")
    scene = Scene([AHEAD, Ambient(1.0, WHITE), wall], tmp_path / "scene.rt")
    # Right is -x: the red pixel is to the upper left. In the middle all four have equal weight.
    assert_allclose(radiance(scene, (1, 1, 10)), [1, 0, 0])
    assert_allclose(radiance(scene, (-1, 1, 10)), [0, 1, 0])
    assert_allclose(radiance(scene, (1, -1, 10)), [0, 0, 1])
    assert_allclose(radiance(scene, (0, 0, 10)), [0.25, 0.25, 0.25])
    assert_allclose(radiance(scene, (0.5, 1, 10)), [0.75, 0.25, 0])


def test_a_bump_map_of_a_ramp_tilts_the_normal_by_its_slope(tmp_path: Path) -> None:
    # Heights that grow by 1 over the picture, times 0.5 of its width: the normal leans by atan 0.5 to the left.
    ramp = np.repeat(np.linspace(0, 255, 256)[None], 2, axis=0).astype(np.uint8)
    Image.fromarray(ramp).save(tmp_path / "ramp.png")
    wall = Square((0, 0, 10), (0, 0, -1), 7, WHITE, bump=Bump("ramp.png", 0.5 * 255 / 256))
    scene = Scene([AHEAD, ParallelLight((0, 0, 1), 1.0), wall], tmp_path / "scene.rt")
    assert_allclose(radiance(scene, (0.1, 0.2, 10)), 1 / np.hypot(1, 0.5), rtol=1e-9)
    lit_from_the_left = Scene([AHEAD, ParallelLight((-0.6, 0, 0.8), 1.0), wall], tmp_path / "scene.rt")
    fading = 2 / (1 + np.sqrt(1 + 0.5**2 / 8 * 0.75**2))
    assert_allclose(
        radiance(lit_from_the_left, (0.1, 0.2, 10)), fading * (0.8 + 0.6 * 0.5) / np.hypot(1, 0.5), rtol=1e-9
    )
    setting = Scene([AHEAD, ParallelLight((-1, 0, 0), 1.0), wall], tmp_path / "scene.rt")
    assert not radiance(setting, (0.1, 0.2, 10)).any()


def test_a_normal_map_replaces_the_normal(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (255, 128, 128)).save(tmp_path / "right.png")
    wall = WALL.replace(normal_map="right.png")
    scene = Scene([AHEAD, ParallelLight((0.8, 0, 0.6), 1.0), wall], tmp_path / "scene.rt")
    # Lit from the right, which is -x; of this light, at a slope of 4 / 3, the roughest bumps let 3 / 4 through.
    assert_allclose(radiance(scene, (0, 0, 1)), 0.8 * 0.75, rtol=1e-12)


def test_directions_of_an_environment_map(tmp_path: Path) -> None:
    pixels = np.zeros((4, 8, 3), np.uint8)
    pixels[1:3, 3:5] = 255, 0, 0  # around +z
    pixels[1:3, 5:7] = 0, 255, 0  # around -x
    pixels[0] = 0, 0, 255
    Image.fromarray(pixels).save(tmp_path / "sky.png")
    scene = Scene([AHEAD, Background("sky.png")], tmp_path / "scene.rt")
    directions = np.array([[0, 0, 1], [-1, 0, 0], [0, 1, 0], [0, 0, -1]], float)
    assert_allclose(sky(scene, directions), [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], atol=1e-12)


@pytest.mark.parametrize(
    "shape",
    [
        Sphere((1, 2, 3), 4, WHITE),
        Cylinder((1, 2, 3), (0.6, 0, 0.8), 4, 5, WHITE),
        Disc((1, 2, 3), (0, 0.6, 0.8), 4, WHITE),
    ],
)
def test_each_tangent_changes_its_own_texture_coordinate(shape: Sphere | Cylinder | Disc) -> None:
    # A small step along a tangent changes only its own coordinate.
    random = np.random.default_rng(3)
    points = np.array([1, 2, 3]) + 0.9 * random.normal(size=(50, 3))
    if isinstance(shape, Disc):
        points -= dot(points - [1, 2, 3], np.array(shape.normal))[:, None] * shape.normal
    elif isinstance(shape, Sphere):
        points = np.array([1, 2, 3]) + 2 * unit(points - [1, 2, 3])
    else:
        axis = np.array(shape.axis)
        p = points - [1, 2, 3]
        points = np.array([1, 2, 3]) + dot(p, axis)[:, None] * axis + 2 * unit(p - dot(p, axis)[:, None] * axis)
    here, step = surface_point(shape, points), 1e-6
    for tangent, u, v in ((here.along_u, step, 0), (here.along_v, 0, step)):
        there = surface_point(shape, points + step * tangent)
        assert_allclose((there.u - here.u + 0.5) % 1 - 0.5, u, atol=1e-10)
        assert_allclose(there.v - here.v, v, atol=1e-10)
    assert (dot(np.cross(here.along_u, here.along_v), normals(shape, points)) > 0).all()
