"""The program's pictures, against those of the reference renderer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from tests.compare import assert_alike, edges, off
from tests.make_goldens import GOLDENS, SCENES, SIZE, golden
from tests.random_scenes import random_scene
from tests.reference import render, to_bytes


def stored(path: Path) -> np.ndarray:
    return np.asarray(pillow.open(GOLDENS / f"{path.stem}.png"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_looks_as_it_should(path: Path) -> None:
    assert_alike(path.stem, minirt.render(minirt.load(path), *SIZE).array, stored(path))


def test_there_is_a_golden_picture_for_every_scene_and_no_other() -> None:
    assert {path.stem for path in GOLDENS.glob("*.png")} == {path.stem for path in SCENES}


def test_the_golden_pictures_are_the_references() -> None:
    for path in SCENES[1:4]:
        assert (np.abs(golden(minirt.load(path)).astype(int) - stored(path)).max(axis=-1) > 0).mean() < 1e-3


def test_each_golden_picture_shows_something() -> None:
    for path in SCENES:
        colours = stored(path).astype(np.uint32) @ np.array([1, 2**8, 2**16], np.uint32)
        assert len(np.unique(colours)) > 20, path.stem


def test_a_picture_that_is_off_does_not_pass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    right = stored(SCENES[1])
    speck, smear = right.copy(), np.roll(right, 1, axis=1)
    y, x = np.argwhere(~edges(right))[5000]
    speck[y, x] ^= 2
    for wrong in (speck, smear):
        with pytest.raises(AssertionError, match="pixels are off"):
            assert_alike("wrong", wrong, right)
    names = {file.name for file in tmp_path.rglob("*.png")}
    assert names == {f"wrong-{part}.png" for part in ("picture", "reference", "difference")}


@pytest.mark.parametrize("batch", range(6))
def test_random_scenes(batch: int) -> None:
    wrong = total = 0
    for seed in range(batch * 25, batch * 25 + 25):
        scene = random_scene(seed)
        shown, right = minirt.render(scene, 48, 32).array, to_bytes(render(scene, 48, 32))
        bad = off(shown, right)
        assert bad.mean() < 0.01, f"seed {seed}"
        wrong, total = wrong + bad.sum(), total + bad.size
    assert wrong < 1e-4 * total
