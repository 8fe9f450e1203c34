"""Pictures of scenes with hard lights or cameras, against known answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.materials import Specular
from minirt.rendering.renderer import Renderer
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Plane, Sphere
from tests import reference
from tests.compare import edges
from tests.kernel.pictures import linear
from tests.paths import scene_files

WHITE = (255, 255, 255)
DARK = Ambient(0.0, WHITE)
DIM = Ambient(0.25, WHITE)
ABOVE = Camera((0, 3, 0), (0, -1, 0), 90)
FLOOR = Plane((0, 0, 0), (0, 1, 0), WHITE)


@pytest.mark.parametrize("normal", [(0, 1, 0), (0, -1, 0)])
@pytest.mark.parametrize("height", [-1e-9, -3.0, -1e15, 0.0])
def test_a_lamp_behind_a_plane_or_on_it_lights_nothing(height: float, normal: tuple[float, float, float]) -> None:
    scene = Scene((DIM, ABOVE, Light((0.5, height, 0.2), 1.0), FLOOR.replace(normal=normal)))
    assert (linear(scene) == 0.25).all()


def test_a_lamp_at_the_eye_that_fades_and_its_highlight() -> None:
    shiny = FLOOR.replace(specular=Specular(0.4, 3))
    scene = Scene((ABOVE, Light((0, 3, 0), 1.0, fade=8), shiny))
    _, directions = reference.camera_rays(ABOVE, 24, 16)
    cosine = -directions[..., 1]
    strength = np.maximum(0, 1 - 3 / cosine / 8)
    shine = 0.4 * np.maximum(0, 2 * cosine**2 - 1) ** 3  # the mirrored ray leads away from the eye by twice the angle
    assert np.abs(linear(scene)[..., 0] - strength * (cosine + shine)).max() <= 1e-14


@pytest.mark.parametrize("place", [(0, 1e15, 0), (6e14, 8e14, 0), (-8e14, 1, 6e14)])
def test_a_lamp_at_the_end_of_the_world_lights_all_in_one_direction(place: tuple[float, float, float]) -> None:
    cosine = place[1] / np.linalg.norm(place)
    scene = Scene((ABOVE, Light(place, 1.0), FLOOR))
    assert np.abs(linear(scene) - cosine).max() <= 1e-14


@pytest.mark.parametrize("offset", [0.0, 1e8])
@pytest.mark.parametrize("scale", [2.0**-30, 1e-4, 1.0, 1e6])
@pytest.mark.parametrize("side", [(1, 0, 0), (0.6, 0.8, 0), (1, 0, 1e-3), (0, 0, 1)])
def test_the_terminator_has_no_specks(scale: float, offset: float, side: tuple[float, float, float]) -> None:
    # A ball is lit where the lamp is above its horizon, to the last pixel: it casts no shadow onto itself.
    found, right = linear(ball(scale, side, offset), 120, 120), reference.render(ball(scale, side), 120, 120)
    wrong = np.abs(found - right).max(axis=-1) > (1e-5 if offset else 1e-9)
    assert not (wrong & ~edges(reference.to_bytes(right))).any()
    assert wrong.sum() <= 4


def ball(scale: float, side: tuple[float, float, float], offset: float = 0.0) -> Scene:
    """A scene of a ball that fills the picture and a light beside it, moved by `offset` sizes along each axis."""
    centre = np.full(3, offset * scale)
    eye = Camera(tuple(centre - [0, 0, 4 * scale]), (0, 0, 1), 30)
    lamp = Light(tuple(centre + 1e3 * scale * np.array(side)), 1.0)
    return Scene((DARK, eye, lamp, Sphere(tuple(centre), 2 * scale, WHITE)))


@pytest.mark.parametrize(("width", "height"), [(4000, 2), (2, 4000), (1, 1000), (1000, 1)])
def test_long_pictures(width: int, height: int) -> None:
    scene = Scene((DIM, ABOVE.replace(fov=10), Light((1, 3, 2), 0.7), FLOOR))
    assert np.abs(linear(scene, width, height) - reference.render(scene, width, height)).max() <= 1e-9


@pytest.mark.parametrize("path", scene_files(), ids=lambda path: path.stem)
def test_the_light_of_every_ray_of_every_scene_is_finite(path: Path) -> None:
    renderer = Renderer(2)
    for samples in (1, 3):
        assert renderer.render(minirt.load(path, lenient=True), np.zeros((54, 96, 4), np.uint8), samples)
        assert renderer.not_finite == 0
