"""Absorption along known chords, fading at known distances, and glow, by the interpreted kernel."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.materials import Glass, Tint
from minirt.rendering.packing.materials import encloses
from minirt.scene import Ambient, Background, Camera, Light, Scene
from minirt.shapes import KINDS, Plane, Sphere, Square
from tests.kernel.pictures import Array, interpreted
from tests.shapes.examples import example

WHITE, GREEN, ROSE = (255, 255, 255), (102, 204, 153), (230, 128, 140)
SKY = Background((204, 153, 102))
LIGHT = Ambient(1.0, WHITE)
CLEAR = Glass(1.0)
BALL = Sphere((0, 0, 0), 4, WHITE, glass=CLEAR, tint=Tint(GREEN, 3.0))
LEFT, RED_LEFT, BEYOND = np.divide(GREEN, 255), np.divide(ROSE, 255), np.array([0.8, 0.6, 0.4])


def seen(*elements: Any, eye: tuple[float, ...] = (0, 0, -9), towards: tuple[float, ...] = (0, 0, 1)) -> Array:
    """Light along the ray from an eye into a direction."""
    return interpreted(Scene((Camera(eye, towards, 1e-6), *elements)), 4, 4)[1][0, 0]  # type: ignore[arg-type]


def test_an_eye_inside_and_shapes_inside() -> None:
    core = Sphere((0, 0, 0), 1, (0, 0, 255))
    assert np.allclose(seen(LIGHT, SKY, BALL, core), LEFT**0.5 * (0, 0, 1), rtol=1e-9)
    assert np.allclose(seen(SKY, BALL, eye=(0, 0, 0.5)), LEFT**0.5 * BEYOND, rtol=1e-9)
    assert np.allclose(seen(LIGHT, SKY, BALL, core, eye=(0, 0, -1.4)), LEFT**0.3 * (0, 0, 1), rtol=1e-9)


# Light that falls straight down from (0, 9, 0) onto the floor below the balls.
FLOOR, LAMP = Plane((0, -3, 0), (0, 1, 0), WHITE), Light((0, 9, 0), 1.0)
SECOND = Sphere((0, 5, 0), 2, (0, 0, 0), glass=Glass(1.5, 0.5), tint=Tint(ROSE, 1.0))


def lit_below(*shapes: Any, lamp: Light = LAMP) -> Array:
    """Light of the floor below the balls, seen from beside them."""
    return seen(lamp, FLOOR, *shapes, eye=(8, -1, 0), towards=(-8 / sqrt(68), -2 / sqrt(68), 0))


def test_light_through_glass() -> None:
    assert np.allclose(lit_below(), 1.0)
    assert np.allclose(lit_below(BALL), LEFT ** (4 / 3), rtol=1e-6)
    assert np.allclose(lit_below(BALL, SECOND), 0.25 * LEFT ** (4 / 3) * RED_LEFT**2, rtol=1e-6)
    assert np.allclose(lit_below(SECOND.replace(fresnel=1.0)), (0.5 * 0.96) ** 2 * RED_LEFT**2, rtol=1e-6)
    pane = Square((0, 3, 0), (0, 1, 0), 2, WHITE, glass=Glass(1.5, 0.7), tint=Tint(GREEN, 1.0))
    assert np.allclose(lit_below(pane), 0.7 * LEFT, rtol=1e-6)
    assert not lit_below(BALL, Sphere((0, 5, 0), 2, WHITE)).any()
    assert not lit_below(BALL, Sphere((0, 5, 0), 2, WHITE, mirror=1.0)).any()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
def test_a_solid_encloses_the_points_before_its_surface(kind: Any) -> None:
    shape = example(kind, np.random.default_rng(5))
    bounds = shape.bounds()
    if not shape.solid or bounds is None:
        assert not encloses(shape, np.array([1e9, 1e9, 1e9])) or bounds is None
        return
    random = np.random.default_rng(1)
    points = random.uniform(*bounds, (40, 3))
    inside = [encloses(shape, point) for point in points]
    scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), shape))
    hits = minirt.trace(scene, points, np.tile([0.1, 0.7, -0.7], (40, 1)))
    leaving = np.einsum("ij,j->i", np.nan_to_num(hits.normal), [0.1, 0.7, -0.7]) > 0
    assert inside == leaving.tolist()
