"""Pictures of the program equal those of the reference renderer."""

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
    """Return the stored golden picture of a scene file."""
    return np.asarray(pillow.open(GOLDENS / f"{path.stem}.png"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_equals_its_golden_picture(path: Path) -> None:
    assert_alike(path.stem, minirt.render(minirt.load(path), *SIZE).array, stored(path))


def test_every_scene_has_a_golden_picture_and_no_others_exist() -> None:
    assert {path.stem for path in GOLDENS.glob("*.png")} == {path.stem for path in SCENES}


def test_the_stored_goldens_are_those_of_the_reference_renderer() -> None:
    for path in SCENES[1:4]:
        assert (np.abs(golden(minirt.load(path)).astype(int) - stored(path)).max(axis=-1) > 0).mean() < 1e-3


def test_a_wrong_picture_fails() -> None:
    golden_picture = stored(SCENES[1])
    speck, shifted = golden_picture.copy(), np.roll(golden_picture, 1, axis=1)
    y, x = np.argwhere(~edges(golden_picture))[5000]
    speck[y, x] ^= 2
    for wrong in (speck, shifted):
        with pytest.raises(AssertionError, match="pixels are off"):
            assert_alike("wrong", wrong, golden_picture)


@pytest.mark.parametrize("batch", range(3))
def test_random_scenes_equal_the_reference(batch: int) -> None:
    wrong = total = 0
    for seed in range(batch * 25, batch * 25 + 25):
        scene = random_scene(seed)
        picture, reference = minirt.render(scene, 48, 32).array, to_bytes(render(scene, 48, 32))
        bad = off(picture, reference)
        assert bad.mean() < 0.01, f"seed {seed}"
        wrong, total = wrong + bad.sum(), total + bad.size
    assert wrong < 1e-4 * total
