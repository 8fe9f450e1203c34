"""Rendering of frames: every pixel once, at any size, on any number of threads, interpreted or compiled; and coincident
surfaces, of which the first in the scene owns the whole overlap."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from minirt.fields import unit
from minirt.kernel import frame, trace
from minirt.lanes import Vec
from minirt.rendering.packing import lights
from minirt.rendering.renderer import Renderer
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Cylinder, Plane, Shape, Sphere, plane
from tests import reference
from tests.compare import edges
from tests.kernel.pictures import ALL, BLUE, GREEN, RED, TWO, interpreted, linear, picture

SIZES = [(1, 1), (1, 9), (9, 1), (5, 3), (4, 2), (3, 2), (13, 11), (4, 33), (33, 8)]


def test_one_thread_and_many_give_the_same_bits() -> None:
    pixels, light = picture(ALL, 150, 83, renderer=Renderer(1))
    for threads in (TWO, Renderer(7)):
        again, same = picture(ALL, 150, 83, renderer=threads)
        assert np.array_equal(pixels, again)
        assert np.array_equal(light, same)


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_every_pixel_is_rendered_at_every_size(width: int, height: int) -> None:
    pixels, light = picture(ALL, width, height)
    assert np.isfinite(light).all()
    assert (pixels[..., 3] == 255).all()
    interpreted_pixels, interpreted_light = interpreted(ALL, width, height)
    assert np.abs(light - interpreted_light).max() <= 1e-12
    assert np.array_equal(pixels, interpreted_pixels)


@pytest.mark.parametrize(("width", "height"), [*SIZES, (60, 40), (150, 83)])
def test_the_picture_is_the_same_with_and_without_linear_output(width: int, height: int) -> None:
    with_light, _ = picture(ALL, width, height)
    padded = np.full((height + 6, width, 4), 77, np.uint8)
    assert TWO.render(ALL, padded[3:-3])
    assert np.array_equal(padded[3:-3], with_light)
    assert (padded[:3] == 77).all()
    assert (padded[-3:] == 77).all()


def test_radiance_that_is_not_finite_becomes_black_and_is_counted() -> None:
    light = np.full((3, 16), 0.5)
    light[0, 3], light[1, 5] = np.nan, np.inf
    memory = np.zeros((3, 4))
    mended = frame.without_non_finite(Vec(*light), memory)
    assert memory[2, 1] == 2
    assert memory.sum() == 2
    light[0, 3] = light[1, 5] = 0.0
    assert np.array_equal(np.stack([mended.x, mended.y, mended.z]), light)
    frame.without_non_finite(Vec(*light), memory)
    assert memory.sum() == 2


def test_a_renderer_counts_rays_whose_light_is_not_finite(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, pixels = Renderer(2), np.zeros((32, 32, 4), np.uint8)
    assert renderer.render(ALL, pixels)
    assert renderer.not_finite == 0
    rows = lights.positions_and_intensities
    factors = [1, 1, 1, np.nan, 1, 1]
    monkeypatch.setattr(lights, "positions_and_intensities", lambda some, colours: rows(some, colours) * factors)
    spoiled = Renderer(2)
    assert spoiled.render(ALL, pixels)
    assert 100 < spoiled.not_finite <= 32 * 32


# Coincident surfaces: the shape that comes first in the scene owns the whole overlap, and both are lit.


DIM = Ambient(0.25, (255, 255, 255))
HIGH = Light((1, 9, -4), 0.5)
ABOVE = Camera((0.3, 6, -8), (0, -0.6, 0.8), 60)
FLAT = Camera((0.3, 0.2, -8), (0, -0.05, 1), 60)
N = unit((0.3, 1.0, -0.2))
T = unit((1.0, -0.3, 0.0))  # perpendicular to N


def along(s: float, normal: tuple[float, float, float] = N) -> tuple[float, float, float]:
    """The point at distance s from the origin along a normal."""
    return tuple(s * x for x in normal)


# Each entry is one surface, written in different ways.
SAME = {
    "planes, axis": [Plane((0, 0, 0), (0, 1, 0), RED), Plane((7.3, 0, -0.9), (0, -1, 0), RED)],
    "planes": [Plane((0, 0, 0), N, RED), Plane(along(37.1, T), N, RED), Plane(along(-0.3, T), along(-1), RED)],
    "plane and cap": [Plane((0, 0, 0), (0, 1, 0), RED), Cylinder((0, -1.1, 0), (0, 1, 0), 7, 2.2, RED)],
    "plane and cap, turned": [Plane((0, 0, 0), N, RED), Cylinder(along(-1.7), along(-1), 7, 3.4, RED)],
    "caps": [Cylinder(along(-0.35), N, 7, 0.7, RED), Cylinder(along(-1.7), along(-1), 5, 3.4, RED)],
    "cylinders": [
        Cylinder((0, 0, 0), N, 3.3, 4.2, RED),
        Cylinder((0, 0, 0), along(-1), 3.3, 4.2, RED),
        Cylinder(along(0.7), N, 3.3, 2.8, RED),
    ],
    "spheres": [Sphere((0.1, 0.2, 0.3), 4.4, RED), Sphere((0.1 + 1e-16, 0.2, 0.1 + 0.2), 4.4, RED)],
    "equal spheres": [Sphere((0, 0, 0), 5, RED), Sphere((0, 0, 0), 5, RED), Sphere((-0.0, 0, 0), 5, RED)],
}


# Black as the background, below all that is seen: with them each scene has the kernel that other tests compile.
BLACK = (0, 0, 0)
UNSEEN = Plane((0, -90, 0), (0, 1, 0), BLACK), Sphere((0, -95, 0), 1, BLACK), Cylinder((0, -95, 0), N, 1, 1, BLACK)


def scene(*shapes: Shape, camera: Camera = ABOVE) -> Scene:
    """A scene of some shapes with a light and ambient light."""
    return Scene((DIM, camera, HIGH, *shapes, *UNSEEN))


@pytest.mark.parametrize("camera", [ABOVE, FLAT], ids=["above", "flat"])
@pytest.mark.parametrize("name", SAME)
def test_the_first_shape_owns_the_overlap_without_specks_of_shadow(name: str, camera: Camera) -> None:
    for order in permutations(SAME[name], 2):
        twins = scene(order[0].replace(colour=GREEN), order[1].replace(colour=BLUE), camera=camera)
        picture = linear(twins, 60, 40)
        expected = reference.render(twins, 60, 40)
        assert (expected[..., 1] > 0).sum() > 50
        wrong = np.abs(picture - expected).max(axis=-1) > 1e-6
        assert not (wrong & ~edges(reference.to_bytes(expected))).any()
        assert wrong.sum() <= 2


def owners(best: np.ndarray, rival: Plane, origin: Vec, direction: Vec) -> np.ndarray:
    """Return the owner of each hit: 1, the shape that was hit at `best`, or 0, a plane that is tested after it."""
    state = best, np.ones_like(best), np.zeros_like(best), 1
    hit, t = plane.intersect(rival.pack(), origin, direction)
    found = trace.closer_hit(rival.pack(), 0, 0.0, hit, t, origin, direction, state)
    assert found[3] in found[1]  # a shape that some ray hits
    return found[1]


def test_the_first_of_two_planes_tilted_by_rounding_owns_the_overlap_to_the_horizon() -> None:
    """Seen from one unit above, at slopes of 1.5e-12 to 3e-12, where t differs by up to 0.9 COINCIDENT."""
    slopes, azimuths = np.geomspace(1.5e-12, 3e-12, 1000), np.linspace(0, 200, 1000)
    level = [np.cos(azimuths) * t + np.sin(azimuths) * b for t, b in zip(T, np.cross(N, T), strict=True)]
    direction = Vec(*(x - slopes * n for x, n in zip(level, N, strict=True)))
    origin = Vec(*(np.full(1000, n) for n in N))
    tilted = Plane((0, 0, 0), (np.nextafter(N[0], 1), N[1], np.nextafter(N[2], 1)), RED)
    _, t = plane.intersect(Plane((0, 0, 0), N, RED).pack(), origin, direction)
    farther = t < plane.intersect(tilted.pack(), origin, direction)[1]
    assert farther.sum() > 300
    assert (owners(t, tilted, origin, direction) == 0).all()


def test_a_surface_at_grazing_angle_is_not_coincident_with_one_in_front() -> None:
    """A plane behind a hit 1e-4 nearer, at slopes so small that 1e-4 along the ray hardly leaves the plane."""
    slopes = np.geomspace(1e-14, 1e-12, 100)
    origin, direction = Vec(*np.zeros((3, 100))), Vec(np.ones(100), -slopes, np.zeros(100))
    floors = [Plane((0, -slope, 0), (0, 1, 0), RED) for slope in slopes]  # all are met at 1
    owned = [owners(np.full(100, 1 - 1e-4), floor, origin, direction)[i] for i, floor in enumerate(floors)]
    assert owned == [1] * 100
