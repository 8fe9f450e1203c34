"""The pictures in scenes/textures are those that their script draws."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.materials.picture_cache import picture
from tests.paths import ROOT

FOLDER = ROOT / "scenes" / "textures"
NAMES = sorted(path.name for path in FOLDER.iterdir())


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder into which the script has drawn the pictures."""
    folder: Path = tmp_path_factory.mktemp("textures")
    runpy.run_path(str(ROOT / "assets" / "make_textures.py"))["main"](folder)
    return folder


def test_the_script_draws_the_same_pictures_again(drawn: Path) -> None:
    assert sorted(path.name for path in drawn.iterdir()) == NAMES
    for name in NAMES:
        assert np.array_equal(picture(drawn / name), picture(FOLDER / name)), name


def test_textures_are_small() -> None:
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 700_000


@pytest.mark.parametrize("name", NAMES)
def test_textures_have_no_seam(name: str) -> None:
    # Across the border neighbours differ no more than elsewhere; tiles fit to themselves from top to bottom, too.
    pixels = np.asarray(Image.open(FOLDER / name).convert("RGB"), float)
    for axis in (0, 1) if pixels.shape[0] == pixels.shape[1] else (1,):
        steps = np.abs(np.diff(pixels, axis=axis)).mean(axis=(1 - axis, 2))
        seam = np.abs(pixels.take(0, axis) - pixels.take(-1, axis)).mean()
        assert seam <= 1.5 * steps.max(), (name, axis)


@pytest.mark.parametrize("name", ["planet.png", "stars.png", "evening.png"])
def test_maps_of_a_globe_are_one_colour_at_its_poles(name: str) -> None:
    pixels = picture(FOLDER / name).astype(float)
    assert pixels[[0, -1]].std(axis=1).max() < 12, name


def test_the_normals_of_bricks_are_those_of_their_heights() -> None:
    # Where the height rises to the right the normal leans to the left.
    heights = picture(FOLDER / "bricks-height.png")[..., 0].astype(float)
    red, green, blue = (
        picture(FOLDER / "bricks-normal.png")[..., part].astype(float) / 127 - 128 / 127 for part in range(3)
    )
    assert np.abs(red**2 + green**2 + blue**2 - 1).max() < 0.03
    rise = np.roll(heights, -1, 1) - np.roll(heights, 1, 1)
    assert np.corrcoef((red / blue).ravel(), rise.ravel())[0, 1] < -0.95
    fall = np.roll(heights, -1, 0) - np.roll(heights, 1, 0)
    assert np.corrcoef((green / blue).ravel(), fall.ravel())[0, 1] > 0.95
