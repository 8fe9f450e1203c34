"""Error metrics of pictures, and certificates of their hits, against values worked out by hand."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from math import inf, isnan

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.report import precision
from minirt.report.metrics import (
    HEAT,
    STUDENT,
    changed,
    error_image,
    fit,
    flip,
    of_median,
    of_rmse,
    psnr,
    quantiles,
    rmse,
    to_8_bits,
)
from minirt.report.precision import summarised
from minirt.scene import Scene
from minirt.shapes import KINDS, Plane, Sphere
from tests.kernel.pictures import AMBIENT, EYE, RED


def grey(*values: float) -> np.ndarray:
    """Make a row of grey pixels."""
    return np.repeat(np.array(values)[None, :, None], 3, axis=2)


def test_metrics_by_hand() -> None:
    """Levels are those of the kernel; a pixel changes as a whole."""
    assert rmse(grey(0, 0, 0, 0), grey(0.2, 0, 0, 0)) == pytest.approx(0.1)
    assert (psnr(0.1), psnr(0.0)) == (pytest.approx(20), inf)
    assert to_8_bits(grey(0, 0.4999 / 255, 0.5001 / 255, 1))[0, :, 0].tolist() == [0, 0, 1, 255]
    one, other = grey(0.1, 0.2, 0.3), grey(0.1, 0.2, 0.3001)
    other[0, 1, 2] += 0.01
    assert changed(one, other) == 1


def test_heat_is_logarithmic() -> None:
    picture = error_image(grey(0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1), grey(0, 0, 0, 0, 0, 0, 0))
    assert picture.array[0].tolist() == HEAT[[0, 0, 0, 1, 2, 3, 4]].tolist()


def test_the_distribution_of_errors_over_pixels() -> None:
    """A hundred pixels with errors of 0.01 to 1.00; one channel of three that differs counts by the root of a third."""
    assert quantiles(grey(*np.arange(1, 101) / 100), grey(*[0.0] * 100)) == pytest.approx([0.5, 0.95, 1.0])
    one = np.zeros((1, 4, 3))
    one[0, 3, 1] = 0.3
    assert quantiles(one, np.zeros_like(one)) == pytest.approx([0, 0.3 / 3**0.5, 0.3 / 3**0.5])


# Confidence intervals hold the truth as often as they say.


TRIALS = 300


def share_that_holds(truth: float, found: Sequence[tuple[float, ...]]) -> float:
    return sum(low <= truth <= high for low, high in found) / len(found)


def test_the_median_lies_in_its_interval() -> None:
    random = np.random.default_rng(1)
    found = [of_median(random.lognormal(0, 0.1, 15).tolist()) for _ in range(TRIALS)]
    assert 0.88 < share_that_holds(1.0, found) < 0.99
    assert share_that_holds(1.1, found) < 0.2  # a wrong value lies outside
    assert of_median([2.0, 1.0]) == (1.0, 2.0)


def test_the_slope_lies_in_its_interval() -> None:
    random, x = np.random.default_rng(2), np.log([1, 2, 4, 8, 16, 32, 64])
    lines = [fit(x, 0.3 - 0.75 * x + random.normal(0, 0.1, len(x))) for _ in range(TRIALS)]
    assert 0.91 < share_that_holds(-0.75, [line[1:3] for line in lines]) < 0.98
    assert np.mean([line[3] for line in lines]) == pytest.approx(0.3, abs=0.02)
    assert isnan(fit(np.array([1.0, 1.0, 2.0, np.nan]), np.zeros(4))[0])


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
    assert np.diff(found).mean() < 0.3 * truth


def test_the_error_of_the_reference_widens_the_interval_downwards() -> None:
    picture = np.random.default_rng(5).normal(0, 0.01, (64, 48, 3))
    low, high = of_rmse(picture, np.zeros_like(picture), 0.0)
    assert of_rmse(picture, np.zeros_like(picture), 0.006) == (pytest.approx((low**2 - 0.006**2) ** 0.5), high)
    assert of_rmse(picture, np.zeros_like(picture), 1.0) == (0.0, high)


# FLIP, of version 1.7 of its authors' program. Our own one, which it has replaced, gave the same figures.


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


@pytest.mark.parametrize(
    ("a", "b", "right"),
    [
        (waves(), np.roll(waves(), 1, axis=1), 0.099324),
        (waves(), np.clip(waves() + 0.01, 0, 1), 0.083893),
        (np.zeros((20, 20, 3)), np.ones((20, 20, 3)), 0.967386),
        (board(0.0), board(0.8), 0.406478),
        (waves(), waves(), 0.0),
    ],
    ids=["shifted", "lighter", "black and white", "blue and yellow", "equal"],
)
def test_flip_is_of_srgb_at_67_pixels_per_degree(a: Array, b: Array, right: float) -> None:
    pytest.importorskip("flip_evaluator")
    assert flip(a, b) == pytest.approx(right, rel=5e-5)


def test_without_the_program_for_flip_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    assert isnan(flip(waves(), waves()))


# Certificates of the hits of a picture, of scenes whose figures are known.


SCENE = Scene((AMBIENT, EYE, Sphere((0, 0, 20), 8, RED), Plane((0, -9, 0), (0, 1, 0), RED)))


@pytest.fixture(autouse=True)
def few_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(precision, "RAYS", 2000)


def test_each_kind_has_a_row_for_rays_from_the_eye_and_from_what_it_sees() -> None:
    rows = list(precision.hit_certificates(SCENE, 64, 40, 1))
    assert [(row.kind, row.rays) for row in rows] == [
        ("sphere", "from the eye"),
        ("plane", "from the eye"),
        ("sphere", "from what it sees"),
        ("plane", "from what it sees"),
    ]
    for row in rows:
        assert 0 <= row.backward_median <= row.backward_largest <= 4
        assert 1 <= row.condition_median <= row.condition_99 <= row.condition_largest
        assert row.normal_largest < 1e-13
        shares = row[5:11]
        assert sum(shares) == pytest.approx(1)
        assert shares[0] >= 0.5 or row.backward_median > 0.25


def test_a_summary_is_that_of_the_numbers() -> None:
    backward = np.array([0.0, 0.1, 0.3, 0.6, 1.5, 3.0, 5.0, 0.2, 0.2, 0.2])
    row = summarised(KINDS[0], "", backward, np.arange(1.0, 11.0), np.full(10, 1e-9))
    assert row[2:] == (10, 0.25, 5.0, 0.5, 0.1, 0.1, 0.1, 0.1, 0.1, 5.5, 10.0, 10.0, 1e-9)


def test_a_scene_of_which_nothing_is_seen_has_no_rows() -> None:
    behind = Scene((AMBIENT, EYE, Sphere((0, 0, -20), 8, RED)))
    assert list(precision.hit_certificates(behind, 64, 40, 1)) == []
