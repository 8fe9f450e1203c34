"""The pictures in scenes/textures are those that their script draws."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.materials.pictures import picture
from tests.paths import ROOT

FOLDER = ROOT / "scenes" / "textures"
GLOBE = ["earth-height.jpg", "earth.jpg", "space.png"]  # of make_globe.py
NAMES = sorted({path.name for path in FOLDER.iterdir()} - set(GLOBE))


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


def test_the_globe_is_the_one_that_its_script_draws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # A small one has the seas, the land and the clouds of the large one; another seed has others.
    monkeypatch.syspath_prepend(str(ROOT / "assets"))
    runpy.run_path(str(ROOT / "assets" / "make_globe.py"))["main"](str(tmp_path), "256")
    for name in ("earth.jpg", "earth-height.jpg"):
        small, large = (
            np.asarray(Image.open(folder / name).convert("RGB").resize((64, 32), Image.Resampling.BOX), float)
            for folder in (tmp_path, FOLDER)
        )
        assert np.abs(small - large).mean() < 8, name
        assert np.abs(np.roll(small, 16, axis=1) - large).mean() > 16, name


@pytest.mark.parametrize("name", NAMES)
def test_textures_have_no_seam(name: str) -> None:
    # Across the border neighbours differ no more than elsewhere; tiles fit to themselves from top to bottom, too.
    pixels = np.asarray(Image.open(FOLDER / name).convert("RGB"), float)
    for axis in (0, 1) if pixels.shape[0] == pixels.shape[1] else (1,):
        steps = np.abs(np.diff(pixels, axis=axis)).mean(axis=(1 - axis, 2))
        seam = np.abs(pixels.take(0, axis) - pixels.take(-1, axis)).mean()
        assert seam <= 1.5 * steps.max(), (name, axis)


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
