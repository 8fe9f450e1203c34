"""Sobol' points: evenly distributed, continuable, and without bias when shifted."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.rendering.sampling.sobol import digital_shifts, shifted, sobol


@pytest.mark.parametrize("doublings", range(11))
@pytest.mark.parametrize("block", [0, 1, 2, 5])
def test_every_block_has_one_point_in_each_box_of_its_size(doublings: int, block: int) -> None:
    count = 2**doublings
    points = sobol(block * count, (block + 1) * count)
    assert points.shape == (count, 2)
    positions = shifted(points, digital_shifts(3))
    assert ((positions >= 0) & (positions < 1)).all()
    for shift in range(3):
        for across in range(doublings + 1):
            boxes = np.floor(positions[:, shift] * (2**across, 2 ** (doublings - across))).astype(int)
            assert len(np.unique(boxes, axis=0)) == count


def test_the_first_points_are_those_of_the_sequence() -> None:
    assert (sobol(0, 4) / 2**32).tolist() == [[0, 0], [0.5, 0.5], [0.25, 0.75], [0.75, 0.25]]


def test_the_sequence_can_be_continued() -> None:
    assert np.array_equal(np.concatenate([sobol(0, 3), sobol(3, 64), sobol(64, 100)]), sobol(0, 100))


def test_shifts_are_uniform_independent_and_always_the_same() -> None:
    shifts = digital_shifts(2, 8, 256) / 2**32
    assert np.array_equal(digital_shifts(2, 8, 256), digital_shifts(2, 8, 256))
    numbers = shifts.transpose(0, 3, 1, 2).reshape(4, -1)
    assert np.abs(numbers.mean(axis=1) - 0.5).max() < 0.03
    assert np.abs(np.corrcoef(numbers) - np.eye(4)).max() < 0.08


def test_means_over_shifted_points_have_no_bias_and_converge_as_for_an_edge() -> None:
    """The share of a pixel on one side of an edge is estimated by shifted points."""
    spread = []
    for doublings in (2, 8):
        positions = shifted(sobol(0, 2**doublings), digital_shifts(4000))
        found = (positions @ (0.8, 0.6) < 0.55).mean(axis=0)
        exact = 0.55**2 / (2 * 0.8 * 0.6)
        assert abs(found.mean() - exact) < 4 * found.std() / np.sqrt(4000)
        spread.append(found.std())
    assert 1.2 < np.log2((spread[0] / spread[1]) ** 2) / 6 < 1.8  # ERROR_EXPONENT
