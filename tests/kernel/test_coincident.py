"""Coincident surfaces: the shape that comes first in the scene owns the whole overlap, and both are lit."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from minirt.fields import unit
from minirt.kernel import trace
from minirt.lanes import Vec
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Shape, plane
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests import reference
from tests.compare import edges
from tests.kernel.pictures import BLUE, GREEN, RED, linear

AMBIENT = Ambient(0.25, (255, 255, 255))
LAMP = Light((1, 9, -4), 0.5)
EYE = Camera((0.3, 6, -8), (0, -0.6, 0.8), 60)
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


def scene(*shapes: Shape, camera: Camera = EYE) -> Scene:
    """A scene of some shapes with a light and ambient light."""
    return Scene((AMBIENT, camera, LAMP, *shapes))


@pytest.mark.parametrize("camera", [EYE, FLAT], ids=["above", "flat"])
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
    state = best, np.ones_like(best), np.zeros_like(best)
    hit, t = plane.intersect(rival.pack(), origin, direction)
    return trace.closer_hit(rival.pack(), 0, 0.0, hit, t, origin, direction, state)[1]


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
