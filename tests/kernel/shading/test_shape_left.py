"""Shadow rays of packets that leave a convex shape are not tested against it: faster, and no picture changes."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.kernel import scene_arrays, shadow_rays
from minirt.kernel.shading import shade
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Cylinder, Shape, Sphere
from tests.kernel.pictures import ALL, EVERY, interpreted, linear

WHITE = (255, 255, 255)
AHEAD = Camera((0, 0, 0), (0, 0, 1), 60)
INSIDE = Sphere((0, 0, 0), 4, WHITE), Cylinder((0, 0, 0), (0.2, 1, 0.1), 3, 5, WHITE)


@pytest.mark.parametrize("scene", [ALL, EVERY], ids=["common", "every"])
def test_light_is_the_same_bits_with_and_without_all_tests(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    _, light = interpreted(scene)
    monkeypatch.setattr(shade, "shape_left", lambda *_: -1)
    assert np.array_equal(interpreted(scene)[1], light)


def test_a_lit_sphere_is_not_tested_against_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    tested = []
    original = scene_arrays.occludes
    monkeypatch.setattr(shadow_rays, "occludes", lambda shape, *rays: tested.append(shape) or original(shape, *rays))
    eye, lamp = Camera((0, 0, -9), (0, 0, 1), 2), Light((3, 3, -9), 1, WHITE)
    interpreted(Scene((Ambient(0, WHITE), eye, lamp, Sphere((0, 0, 0), 4, WHITE))))
    assert not tested


@pytest.mark.parametrize("shape", INSIDE, ids=lambda shape: shape.title)
def test_inside_a_shape_the_light_outside_is_hidden(shape: Shape) -> None:
    assert (linear(Scene((Ambient(0, WHITE), AHEAD, Light((0, 0, -9), 1, WHITE), shape))) == 0.0).all()
    assert (linear(Scene((Ambient(0, WHITE), AHEAD, Light((0.1, 0.1, 0.1), 1, WHITE), shape))) > 0.0).all()
