"""Confidence intervals hold the truth as often as they say."""

from __future__ import annotations

from math import isnan

import numpy as np
import pytest

from minirt.report.measurements import intervals
from minirt.report.measurements.intervals import STUDENT, fit, of_median, of_rmse

TRIALS = 300


def share_that_holds(truth: float, found: list[intervals.Interval]) -> float:
    return sum(each.low <= truth <= each.high for each in found) / len(found)


def test_the_median_lies_in_its_interval() -> None:
    random = np.random.default_rng(1)
    found = [of_median(random.lognormal(0, 0.1, 15).tolist()) for _ in range(TRIALS)]
    assert 0.88 < share_that_holds(1.0, found) < 0.99
    assert share_that_holds(1.1, found) < 0.2  # a wrong value lies outside
    assert isnan(of_median([1.0, 2.0]).low)


def test_the_slope_lies_in_its_interval() -> None:
    random, x = np.random.default_rng(2), np.log([1, 2, 4, 8, 16, 32, 64])
    lines = [fit(x, 0.3 - 0.75 * x + random.normal(0, 0.1, len(x))) for _ in range(TRIALS)]
    assert 0.91 < share_that_holds(-0.75, [line.interval for line in lines]) < 0.98
    assert np.mean([line.intercept for line in lines]) == pytest.approx(0.3, abs=0.02)
    assert isnan(fit(x[:2], x[:2]).interval.low)
    assert fit(x[:2], x[:2]).slope == pytest.approx(1.0)


@pytest.mark.parametrize("free", [1, 5])
def test_the_quantiles_of_student(free: int) -> None:
    """97.5 % of Student's numbers are below the quantile."""
    numbers = np.random.default_rng(3).standard_t(free, 200_000)
    assert (numbers < STUDENT[free - 1]).mean() == pytest.approx(0.975, abs=0.0015)


def test_the_rmse_of_other_pictures_of_the_same_nature_lies_in_its_interval() -> None:
    """Errors that are equal in spots of 4 x 4 pixels: an interval from single pixels would be too narrow."""
    random, black = np.random.default_rng(4), np.zeros((256, 256, 3))

    def picture() -> np.ndarray:
        spots = random.normal(0, 0.01, (64, 64, 3)) * random.binomial(1, 0.1, (64, 64, 1))
        return spots.repeat(4, axis=0).repeat(4, axis=1)

    truth = 0.01 * 0.1**0.5
    found = [of_rmse(picture(), black, 0.0) for _ in range(100)]
    assert 0.88 < share_that_holds(truth, found) <= 1.0
    assert np.mean([each.high - each.low for each in found]) < 0.3 * truth


def test_the_error_of_the_reference_widens_the_interval_downwards() -> None:
    picture = np.random.default_rng(5).normal(0, 0.01, (64, 48, 3))
    plain, doubtful = (of_rmse(picture, np.zeros_like(picture), doubt) for doubt in (0.0, 0.006))
    assert doubtful.high == plain.high
    assert doubtful.low == pytest.approx((plain.low**2 - 0.006**2) ** 0.5)
    assert of_rmse(picture, np.zeros_like(picture), 1.0).low == 0.0


def test_blocks_of_a_picture_whose_size_is_no_multiple() -> None:
    squares = np.random.default_rng(6).random((37, 50))
    sums, pixels = intervals.block_sums(squares)
    assert sums.sum() == pytest.approx(squares.sum())
    assert pixels.sum() == squares.size
    assert sums[0] == pytest.approx(squares[:16, :16].sum())
    assert (sums[-1], pixels[-1]) == (pytest.approx(squares[32:, 48:].sum()), 10)
