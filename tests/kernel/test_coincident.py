"""Of surfaces that coincide the earlier owns the whole overlap, however the two are written, and both are lit."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from minirt.fields import unit
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import BLUE, GREEN, RED, linear

AMBIENT = Ambient(0.25, (255, 255, 255))
LAMP = Light((1, 9, -4), 0.5)
EYE = Camera((0.3, 6, -8), (0, -0.6, 0.8), 60)
FLAT = Camera((0.3, 0.2, -8), (0, -0.05, 1), 60)
N = unit((0.3, 1.0, -0.2))
T = unit((1.0, -0.3, 0.0))  # perpendicular to N


def along(s: float, normal: tuple[float, float, float] = N) -> tuple[float, float, float]:
    return tuple(s * x for x in normal)


# Each row is one surface written in different ways.
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
    "sphere in tube": [Sphere((0, 0, 0), 5, RED), Sphere((0, 0, 0), 5, RED), Sphere((-0.0, 0, 0), 5, RED)],
}


def scene(*shapes: Shape, camera: Camera = EYE) -> Scene:
    return Scene((AMBIENT, camera, LAMP, *shapes))


@pytest.mark.parametrize("camera", [EYE, FLAT], ids=["above", "flat"])
@pytest.mark.parametrize("name", SAME)
def test_the_earlier_owns_the_overlap(name: str, camera: Camera) -> None:
    for order in permutations(SAME[name], 2):
        first, second = order[0].replace(colour=GREEN), order[1].replace(colour=BLUE)
        both = linear(scene(first, second, camera=camera), 60, 40)
        alone = linear(scene(first, camera=camera), 60, 40)
        # Wherever the first is seen alone it is seen beside the second too, unless that stands before it.
        green, blue = both[..., 1] > 0, both[..., 2] > 0
        front = linear(scene(second, camera=camera), 60, 40)[..., 2] > 0
        assert not (green & blue).any()
        assert (alone[..., 1] > 0).sum() > 200
        if not covers(order[1], order[0]):
            assert np.array_equal(green, alone[..., 1] > 0)
        assert np.array_equal(green | blue, (alone[..., 1] > 0) | front)
        # Where it is seen it is as bright as alone, or in a shadow that the other throws: no specks of shadow.
        darker = green & (np.abs(both[..., 1] - alone[..., 1]) > 1e-9)
        assert specks(darker) == 0


def covers(front: Shape, behind: Shape) -> bool:
    """Whether a part of the one may stand before the other: of solids of which one is larger."""
    return isinstance(front, Cylinder) and not (isinstance(behind, Cylinder) and behind.height >= front.height)


def specks(mask: np.ndarray) -> int:
    """Pixels without a neighbour of their own."""
    padded = np.pad(mask, 1).astype(int)
    around = sum(
        np.roll(np.roll(padded, i, 0), j, 1) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)
    )[1:-1, 1:-1]
    return int((mask & (around == 0)).sum())
