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
