"""Orientation of textures on shapes as a camera sees them: not mirrored, not upside down, centred."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.fields import Triple
from minirt.scene import Ambient, Camera, Scene
from minirt.shapes import KINDS, Shape
from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.kernel.pictures import BLUE, GREEN, RED, WHITE, interpreted, linear
from tests.skipping import skip_incomplete

GREY = (9, 9, 9)
UP, DOWN, FRONT = (0, 1, 0), (0, -1, 0), (0, 0, -1)
SHAPES: tuple[Shape, ...] = (
    Sphere((0, 0, 0), 4, GREY),
    Plane((0.5, -0.5, 0), FRONT, GREY),
    Cylinder((0, 0, 0), UP, 3, 3, GREY),
    Cone((0, 2, 0), DOWN, 3, 4, GREY),
    Paraboloid((0, -0.5, 0), UP, 3, 2, GREY),
    Hyperboloid((0, 0, 0), UP, 2, 3, 3, GREY),
    Triangle((1.95, -1.95, 0), (-2.05, -1.95, 0), (1.95, 2.05, 0), GREY),  # its longest edge goes through the middle
    Square((0, 0, 0), FRONT, 3, GREY),
    Disc((0, 0, 0), FRONT, 3, GREY),
    Box((0, 0, 0), UP, (3, 3, 3), GREY),
    Torus((0, 0, 0), UP, 3, 2, GREY),
    Ellipsoid((0, 0, 0), UP, (3, 4, 2), GREY),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a picture of four squares: red and green above, blue and white below."""
    squares = np.array([[RED, GREEN], [BLUE, WHITE]], np.uint8)
    Image.fromarray(squares.repeat(32, 0).repeat(32, 1)).save(tmp_path / "quarters.png")
    return tmp_path


def scene_of(folder: Path, shape: Shape, eye: Triple = (0, 0, -9), direction: Triple = (0, 0, 1)) -> Scene:
    """A textured shape under ambient light alone, which shows the texture's own colours."""
    textured = shape.replace(texture="quarters.png")
    return Scene((Ambient(1, WHITE), Camera(eye, direction, 10), textured), folder / "scene.rt")


def quarter_colours(light: np.ndarray) -> np.ndarray:
    """Return the colours of four pixels around the middle: upper left, upper right, lower left, lower right."""
    high, wide = light.shape[:2]
    rows, columns = (np.array([n // 2 - n // 8, n // 2 + n // 8]) for n in (high, wide))
    found: np.ndarray = light[np.ix_(rows, columns)].reshape(4, 3) * 255
    return found


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.title)
def test_a_texture_seen_from_the_front_is_upright_and_not_mirrored(shape: Shape, folder: Path) -> None:
    scene = scene_of(folder, shape)
    for light in (linear(scene, 32, 32), interpreted(scene, 32, 32)[1]):
        expected = [RED, (0, 0, 0) if isinstance(shape, Triangle) else GREEN, BLUE, WHITE]
        assert np.abs(quarter_colours(light) - expected).max() < 1e-3


@pytest.mark.parametrize("kind", [Plane, Square, Disc])
@pytest.mark.parametrize(("normal", "eye"), [(UP, (0, 9, 0)), (DOWN, (0, -9, 0))])
def test_textures_of_floors_and_ceilings_are_upright_seen_vertically(
    kind: type[Shape], normal: Triple, eye: Triple, folder: Path
) -> None:
    corner = (-0.5, 0, normal[1] * 0.5) if kind is Plane else (0, 0, 0)
    shape = kind(corner, normal, *(() if kind is Plane else (3.0,)), GREY)
    light = linear(scene_of(folder, shape, eye, (0, -normal[1], 0)), 32, 32)
    assert np.abs(quarter_colours(light) - [RED, GREEN, BLUE, WHITE]).max() < 1e-3


def test_every_kind_is_tested() -> None:
    missing = {kind.element for kind in KINDS} - {type(shape) for shape in SHAPES}
    if missing:
        skip_incomplete(f"no painted {', '.join(kind.title for kind in missing)}: add one to SHAPES in {__file__}")
