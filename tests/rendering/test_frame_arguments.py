"""Positions of the samples in a pixel."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.rendering.frame_arguments import sample_positions


@pytest.mark.parametrize("samples", [1, 2, 3, 16, 64])
def test_samples_lie_evenly_in_the_pixel(samples: int) -> None:
    positions = sample_positions(samples)
    assert positions.shape == (samples, 2)
    assert ((positions >= 0) & (positions < 1)).all()
    assert np.abs(positions.mean(axis=0) - 0.5).max() <= (0 if samples == 1 else 0.5 / samples)
    assert len(np.unique(positions[:, 0])) == len(np.unique(positions[:, 1])) == samples
    quarters = np.histogram2d(positions[:, 0], positions[:, 1], bins=2, range=[[0, 1], [0, 1]])[0]
    assert np.ptp(quarters) <= max(1, samples / 8)


def test_one_sample_is_in_the_centre() -> None:
    assert sample_positions(1).tolist() == [[0.5, 0.5]]
