"""FLIP, against figures of its authors' own program (flip-evaluator 1.7, LDR, 67 pixels per degree)."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.report.measurements.flip import flip, perceived

Array = NDArray[np.float64]


def waves(height: int = 120, width: int = 160) -> Array:
    """Make a picture of soft and hard edges."""
    y, x = np.mgrid[:height, :width] / 40
    hard = (np.sin(3 * y) > 0) * 0.8 + 0.1
    return np.stack([np.sin(x * 2 + y) * 0.5 + 0.5, hard, np.cos(x * y) * 0.5 + 0.5], -1)


def board(contrast: float, height: int = 120, width: int = 160) -> Array:
    """Make a grey picture with bluer and yellower squares."""
    y, x = np.mgrid[:height, :width] // 4
    picture = np.full((height, width, 3), 0.5)
    picture[..., 2] += ((x + y) % 2 - 0.5) * contrast
    return picture


def mean(a: Array, b: Array) -> float:
    return float(flip(perceived(a), perceived(b)).mean())


@pytest.mark.parametrize(
    ("a", "b", "right"),
    [
        (waves(), np.roll(waves(), 1, axis=1), 0.099324),
        (waves(), np.clip(waves() + 0.01, 0, 1), 0.083893),
        (np.zeros((20, 20, 3)), np.ones((20, 20, 3)), 0.967386),
        (board(0.0), board(0.8), 0.406478),
    ],
    ids=["shifted", "lighter", "black and white", "blue and yellow"],
)
def test_the_figures_of_the_authors(a: Array, b: Array, right: float) -> None:
    assert mean(a, b) == pytest.approx(right, rel=5e-5)
    assert mean(b, a) == pytest.approx(mean(a, b), rel=1e-12)


def test_the_same_picture_has_no_error() -> None:
    assert not flip(perceived(waves()), perceived(waves())).any()


def test_an_error_is_where_the_pictures_differ() -> None:
    one, other = waves(), waves()
    other[60, 80] = 1 - other[60, 80]
    errors = flip(perceived(one), perceived(other))
    assert np.unravel_index(errors.argmax(), errors.shape) == (60, 80)
    assert errors[60, 80] > 0.3
    assert not errors[:30].any()
