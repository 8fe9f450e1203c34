"""Background colours and environment maps, seen directly and in a mirror."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.fields import Triple
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes import Shape
from minirt.shapes.sphere import Sphere

WHITE = (255, 255, 255)
FAR_OFF = Sphere((0, 0, 1e6), 1e-3, WHITE)  # so that the scene is not empty
# Eight columns of 45 degrees, four rows of 45 degrees: red encodes the column, green the row.
COLUMNS, ROWS = 8, 4
SQUARES = np.stack([*np.mgrid[:ROWS, :COLUMNS][::-1] * 30, np.zeros((ROWS, COLUMNS))], axis=-1).astype(np.uint8)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    # Large squares, so that interpolation leaves the middle of each in one colour.
    large = np.repeat(np.repeat(SQUARES, 16, axis=0), 16, axis=1)
    pillow.fromarray(large).save(tmp_path / "sky.png")
    return tmp_path / "scene.rt"


def middle_colour(file: Path, direction: Triple, *shapes: Shape) -> tuple[int, int, int]:
    """Return the colour of the single pixel of a picture in some direction."""
    items = (Ambient(1, WHITE), Camera((5, 6, 7), direction, 1e-3), Background("sky.png"), *shapes)
    red, green, blue = minirt.render(Scene(items, file), 1, 1).array[0, 0].tolist()
    return red, green, blue


@pytest.mark.parametrize("shapes", [(FAR_OFF,), ()])
@pytest.mark.parametrize(
    ("longitude", "latitude", "column", "row"),
    # Longitude from +z towards -x, which is to the right looking along +z; latitude from the horizon towards +y.
    [(22.5, 22.5, 4, 1), (-22.5, 22.5, 3, 1), (112.5, -22.5, 6, 2), (-157.5, 67.5, 0, 0), (157.5, -67.5, 7, 3)],
)
def test_directions_map_to_pixels_of_the_environment_map(
    file: Path, longitude: float, latitude: float, column: int, row: int, shapes: tuple[Shape, ...]
) -> None:
    a, b = np.radians([longitude, latitude])
    direction = (-np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b))
    assert middle_colour(file, direction, *shapes) == (30 * column, 30 * row, 0)


def test_straight_up_is_the_upper_row_of_the_environment_map(file: Path) -> None:
    assert middle_colour(file, (0, 1, 0), FAR_OFF)[1] == 0
    assert middle_colour(file, (0, -1, 0), FAR_OFF)[1] == 90  # not interpolated with the row at the other pole


def test_a_mirror_reflects_the_environment_map(file: Path) -> None:
    ball = Sphere((5, 6, 9), 2, WHITE, mirror=1.0)
    # Straight back, which is on the seam.
    assert middle_colour(file, (0, 0, 1), ball) in {(0, 45, 0), (210, 45, 0), (105, 45, 0)}
    # The normal is halfway between the directions to the eye and to the mirrored square.
    mirrored = np.array([-np.sin(np.radians(112.5)), 0, np.cos(np.radians(112.5))]) * np.cos(np.radians(22.5))
    mirrored[1] = np.sin(np.radians(22.5))
    normal = mirrored - [0, 0, 1]
    normal /= np.linalg.norm(normal)
    hit = np.array([5, 6, 9]) + normal
    eye = hit - [0, 0, 2]
    items = (Camera(tuple(eye), (0, 0, 1), 1e-6), Background("sky.png"), ball)
    assert minirt.render(Scene(items, file), 1, 1).array[0, 0].tolist() == [180, 30, 0]


def test_a_background_colour_fills_pixels_without_shapes() -> None:
    items = (Ambient(1, WHITE), Camera((0, 0, -9), (0, 0, 1), 60), Background((20, 130, 240)))
    for shapes in ((), (Sphere((0, 0, 0), 2, (255, 0, 0)),)):
        picture = minirt.render(Scene((*items, *shapes)), 16, 16).array
        assert picture[0, 0].tolist() == [20, 130, 240]
        assert picture[8, 8].tolist() == ([255, 0, 0] if shapes else [20, 130, 240])
