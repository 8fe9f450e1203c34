"""Texture lookup: bilinear interpolation and repeat addressing, against weighted sums over all pixels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.fields import Triple
from minirt.kernel.shading import texturing
from minirt.lanes import load
from minirt.rendering.packing.materials import Reader
from minirt.scene import Ambient, Background, Camera, Scene
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
from tests.kernel.pictures import BLUE, GREEN, RED, WHITE, Array, interpreted, linear
from tests.shapes.execution_modes import on_lanes
from tests.skipping import skip_incomplete

RANDOM = np.random.default_rng(1)
IMAGES = [  # three channels or one; one pixel wide or high; landscape and portrait
    RANDOM.integers(0, 256, shape, np.uint8)
    for shape in ((5, 7, 3), (1, 1, 3), (8, 8, 3), (4, 1, 3), (1, 6, 3), (9, 2, 3))
]
IMAGES += [RANDOM.random(shape).astype(np.float32) for shape in ((6, 4), (1, 1))]
COLOURED = range(6)


def all_pictures() -> tuple[Any, Any]:
    """Return all pictures as the kernel reads them: texels and layout."""
    pool = Reader.__new__(Reader)
    pool.images = IMAGES
    return tuple(pool.arrays().values())  # type: ignore[return-value]


TEXELS, PICTURES = all_pictures()


def colour_lanes(i: int, texels: Any, pictures: Any, which: int, u: Any, v: Any) -> Any:
    colour = texturing.texture_lookup(texels, pictures, which, load(u, i), load(v, i))
    return colour.x, colour.y, colour.z


def gradient_lanes(i: int, texels: Any, pictures: Any, which: int, u: Any, v: Any) -> Any:
    return texturing.height_gradient(texels, pictures, which, load(u, i), load(v, i))


def compiled(which: int, u: Array, v: Array) -> Array:
    """Look up colours by the compiled kernel, (n, 3)."""
    return on_lanes(colour_lanes, 3, TEXELS, PICTURES, which, u, v).T


def looked_up(which: int, u: Array, v: Array) -> Array:
    """Look up colours by the interpreted kernel, (n, 3)."""
    with np.errstate(invalid="ignore"):
        colour = texturing.texture_lookup(TEXELS, PICTURES, which, u, v)
    return np.stack([colour.x, colour.y, colour.z], axis=-1)


Lookup = Callable[[int, Array, Array], Array]
EITHER = pytest.mark.parametrize("lookup", [looked_up, compiled])


def picture_of(which: int) -> Array:
    """Return a picture with channels from 0 to 1, (h, w, channels)."""
    pixels = IMAGES[which]
    return (pixels / 255.0 if pixels.dtype == np.uint8 else pixels.astype(float)).reshape(*pixels.shape[:2], -1)


def weights(count: int, places: Array) -> Array:
    """Return the weight of each of `count` pixels in a row at some places, which may lie beyond [0, 1].

    It is a tent function, two pixels wide, around the centre of the pixel and of each of its repetitions.
    """
    centres = (np.arange(-4 * count, 5 * count) + 0.5) / count
    tents = np.maximum(0, 1 - np.abs(places[:, None] - centres) * count)
    result: Array = tents.reshape(len(places), -1, count).sum(axis=1)
    return result


def expected_colours(which: int, u: Array, v: Array) -> Array:
    """Return the colours of a picture at u, v as weighted sums over all pixels."""
    pixels = picture_of(which)
    down, across = weights(pixels.shape[0], 1 - v), weights(pixels.shape[1], u)
    result: Array = np.einsum("nh,nw,hwc->nc", down, across, pixels)
    return result


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_lookup_is_bilinear_and_repeats_beyond_the_edges(which: int, lookup: Lookup) -> None:
    u, v = np.random.default_rng(which).uniform(-3, 3, (2, 320))
    assert np.abs(lookup(which, u, v) - expected_colours(which, u, v)).max() < 1e-6


@pytest.mark.parametrize("which", range(len(IMAGES)))
def test_gradients_are_central_differences_over_a_pixel(which: int) -> None:
    height, width = IMAGES[which].shape[:2]
    u, v = np.random.default_rng(which).uniform(-2, 2, (2, 160))
    slope_u = expected_colours(which, u + 0.5 / width, v) - expected_colours(which, u - 0.5 / width, v)
    slope_v = expected_colours(which, u, v + 0.5 / height) - expected_colours(which, u, v - 0.5 / height)
    expected = np.stack([slope_u[:, 0] * width, slope_v[:, 0] * height])
    lanes = on_lanes(gradient_lanes, 2, TEXELS, PICTURES, which, u, v)
    for found in (np.stack(texturing.height_gradient(TEXELS, PICTURES, which, u, v)), lanes):
        assert np.abs(found - expected).max() < 1e-5


@EITHER
@pytest.mark.parametrize("which", COLOURED)
def test_no_texture_coordinate_leads_out_of_the_picture(which: int, lookup: Lookup) -> None:
    special = np.array([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e17, -1e17, 0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 5e-324])
    u, v = (each.ravel() for each in np.meshgrid(np.resize(special, 16), np.resize(special, 16)))
    got = lookup(which, u, v)
    assert np.isfinite(got).all()
    assert got.min() >= picture_of(which).min() - 1e-6
    assert got.max() <= picture_of(which).max() + 1e-6


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


def test_every_kind_is_tested() -> None:
    missing = {kind.element for kind in KINDS} - {type(shape) for shape in SHAPES}
    if missing:
        skip_incomplete(f"no painted {', '.join(kind.title for kind in missing)}: add one to SHAPES in {__file__}")


PALE = (255, 255, 255)
FAR_OFF = Sphere((0, 0, 1e6), 1e-3, PALE)  # so that the scene is not empty
# Eight columns of 45 degrees, four rows of 45 degrees: red encodes the column, green the row.
COLUMNS, ROWS = 8, 4
SQUARES = np.stack([*np.mgrid[:ROWS, :COLUMNS][::-1] * 30, np.zeros((ROWS, COLUMNS))], axis=-1).astype(np.uint8)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    # Large squares, so that interpolation leaves the middle of each in one colour.
    large = np.repeat(np.repeat(SQUARES, 16, axis=0), 16, axis=1)
    Image.fromarray(large).save(tmp_path / "sky.png")
    return tmp_path / "scene.rt"


def middle_colour(file: Path, direction: Triple, *shapes: Shape) -> tuple[int, int, int]:
    """Return the colour of the single pixel of a picture in some direction."""
    items = (Ambient(1, PALE), Camera((5, 6, 7), direction, 1e-3), Background("sky.png"), *shapes)
    red, green, blue = minirt.render(Scene(items, file), 1, 1).array[0, 0].tolist()
    return red, green, blue


def test_straight_up_is_the_upper_row_of_the_environment_map(file: Path) -> None:
    assert middle_colour(file, (0, 1, 0), FAR_OFF)[1] == 0
    assert middle_colour(file, (0, -1, 0), FAR_OFF)[1] == 90  # not interpolated with the row at the other pole
