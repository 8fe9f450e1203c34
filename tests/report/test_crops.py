"""Crops of a picture represent it, at their true pixel size, and a reference of them is that of the picture there."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.report.crops import SIDE, Crops, representative
from minirt.report.pictures import crops_for, reference
from minirt.scene import FurtherLight, Scene
from tests.kernel.pictures import ALL

HEIGHT, WIDTH = 300, 420  # 4 x 6 squares, and a border that is in none
CORNERS = [(top, left) for top in range(0, 256, SIDE) for left in range(0, 384, SIDE)]


def test_crops_are_squares_of_the_picture_beside_each_other() -> None:
    picture = np.arange(HEIGHT * WIDTH * 3).reshape(HEIGHT, WIDTH, 3)
    chosen = np.array([1, 5, 6, 7, 8, 9, 20, 23])
    mosaic = Crops(HEIGHT, WIDTH, chosen, across=4).of(picture)
    assert mosaic.shape == (2 * SIDE, 4 * SIDE, 3)
    for place, number in enumerate(chosen):
        (y, x), (top, left) = (each * SIDE for each in divmod(place, 4)), CORNERS[number]
        assert np.array_equal(mosaic[y : y + SIDE, x : x + SIDE], picture[top : top + SIDE, left : left + SIDE])
    assert Crops(HEIGHT, WIDTH).of(picture) is picture


def test_small_pictures_are_whole() -> None:
    squares = np.ones((HEIGHT, WIDTH))
    assert representative(squares, HEIGHT * WIDTH).chosen is None
    assert representative(squares, SIDE * SIDE - 1).chosen is None  # not even one crop
    thin = representative(np.ones((20, 4096)), 20 * 1024)
    assert thin.of(np.zeros((20, 4096, 3))).shape == (2 * 20, 6 * SIDE, 3)  # of 16 crops at most


def test_errors_in_crops_are_those_of_the_picture() -> None:
    """Twenty pictures have their errors at edges. Crops that are spread evenly, as a wrong variant, are far off."""
    doubts = dict[str, list[float]](chosen=[], evenly=[])
    for seed in range(20):
        random = np.random.default_rng(seed)
        squares = np.zeros((1024, 2048))
        for _ in range(60):
            top, left, size = random.integers(0, 900), random.integers(0, 1900), random.integers(3, 120)
            squares[top : top + size, left : left + 3] += random.lognormal()
        pilot = squares * random.lognormal(0, 0.5, squares.shape)  # another picture
        crops = representative(pilot, 2**18)
        assert crops.chosen is not None
        assert 0.8 * 2**18 < crops.of(squares[..., None]).size <= 2**18
        evenly = (np.arange(len(crops.chosen)) * 512 / len(crops.chosen)).astype(int)
        for name, chosen in (("chosen", crops.chosen), ("evenly", evenly)):
            found = crops._replace(chosen=chosen).of(squares[..., None])
            doubts[name].append(np.log(found.mean() / squares.mean()) / 2)
    chosen, evenly = (float(np.sqrt(np.mean(np.square(each)))) for each in doubts.values())
    assert chosen < 0.15 < evenly


@pytest.mark.parametrize("scene", [ALL, Scene((*ALL.elements, FurtherLight((3, 9, -9), 0.4, size=2.0)))])
def test_a_reference_of_crops_is_that_of_the_picture_there(scene: Scene) -> None:
    """Bit for bit, with soft light, too."""
    crops = crops_for(scene, 320, 200, 4 * SIDE * SIDE)
    assert crops.chosen is not None
    assert np.array_equal(crops.chosen, crops_for(scene, 320, 200, 4 * SIDE * SIDE).chosen)  # in every run
    part, whole = reference(scene, crops, 16, seed=1), reference(scene, Crops(200, 320), 16, seed=1)
    assert np.array_equal(part.picture, crops.of(whole.picture))
    assert part.error == pytest.approx(whole.error, rel=0.3)
