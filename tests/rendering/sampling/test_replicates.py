"""The two halves of a picture: their means, their errors, and the picture that they make."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.kernel.frame import PACKET_HEIGHT
from minirt.rendering.sampling.replicates import Replicates

RANDOM = np.random.default_rng(7)


def filled(height: int, width: int, packet_width: int) -> Replicates:
    """Halves of a picture whose light is 0.5 with a noise of 0.1; nothing outside of the picture."""
    halves = Replicates(height, width, packet_width)
    halves.means[:, :height, :width] = RANDOM.normal(0.5, 0.1, (2, height, width, 3))
    halves.compare()
    return halves


@pytest.mark.parametrize("packet_width", [4, 8])
@pytest.mark.parametrize("size", [(400, 300), (129, 250), (1, 3000), (3000, 1)])
def test_the_estimated_error_is_that_of_the_mean_of_both_halves(size: tuple[int, int], packet_width: int) -> None:
    assert filled(*size, packet_width).squared_error == pytest.approx(0.1**2 / 2, rel=0.15)


def test_a_picture_of_one_pixel_has_an_estimate() -> None:
    assert filled(1, 1, 4).squared_error > 0


def test_guides_and_judges_alternate_like_a_chessboard() -> None:
    halves = Replicates(8, 12, 4)
    for y, x in np.ndindex(8, 12):
        halves.means[...] = 0
        halves.means[0, y, x] = 0.5
        halves.compare()
        one, none = (halves.judges, halves.guides) if (x + y) % 2 == 0 else (halves.guides, halves.judges)
        assert one[y // PACKET_HEIGHT, x // 4] == one.sum() == pytest.approx(3 * 0.5**2 / 4)
        assert not none.any()


def test_differences_that_a_picture_does_not_show_are_no_error() -> None:
    halves = Replicates(4, 4, 4)
    halves.means[0], halves.means[1] = 1.5, 9.0
    halves.means[:, 0, 0] = np.nan
    halves.compare()
    assert halves.squared_error == 0


def test_samples_are_added_with_their_weights_and_compared() -> None:
    halves = filled(45, 50, 4)
    before = halves.means.copy()
    wanted = RANDOM.random(halves.packets) < 0.3
    weights = RANDOM.random(halves.packets)
    halves.new_means[:, :45, :50] = RANDOM.random((2, 45, 50, 3))
    halves.add(wanted, weights)
    weight = np.kron(wanted * weights, np.ones((PACKET_HEIGHT, 4)))[None, ..., None]
    assert np.abs(halves.means - (before * (1 - weight) + halves.new_means * weight)).max() < 1e-12
    found = halves.judges.copy(), halves.guides.copy()
    halves.compare()
    assert np.allclose(found, (halves.judges, halves.guides))


def test_the_picture_is_the_mean_of_both_halves() -> None:
    halves = filled(37, 18, 8)
    halves.means[:, 0, 0] = np.nan
    halves.means[:, 1, 1] = (1.7, 0.5, -3)
    pixels, linear = np.zeros((37, 18, 4), np.uint8), np.zeros((37, 18, 3))
    halves.finish(pixels, linear)
    assert np.array_equal(linear, halves.means.sum(axis=0)[:37, :18] / 2, equal_nan=True)
    assert pixels[0, 0].tolist() == [0, 0, 0, 255]
    assert pixels[1, 1].tolist() == [0, 128, 255, 255]
    exact = np.floor(linear[2:, :, ::-1] * 255 + 0.5)
    assert np.array_equal(pixels[2:, :, :3], exact)
    again = np.zeros_like(pixels)
    halves.finish(again, np.zeros((0, 0, 3)))
    assert np.array_equal(again, pixels)
