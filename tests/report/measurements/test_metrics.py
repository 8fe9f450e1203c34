"""Error metrics of pictures, against values worked out by hand."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from minirt.report.measurements.metrics import changed, clamped, psnr, rmse, to_8_bits
from minirt.report.output.error_image import HEAT, error_image


def grey(*values: float) -> np.ndarray:
    """Make a row of grey pixels."""
    return np.repeat(np.array(values)[None, :, None], 3, axis=2)


def test_root_mean_square() -> None:
    assert rmse(grey(0, 0, 0, 0), grey(0.2, 0, 0, 0)) == pytest.approx(0.1)
    assert psnr(0.1) == pytest.approx(20)
    assert psnr(0.0) == inf


def test_what_a_screen_shows() -> None:
    assert clamped(grey(0, 0.5, 7))[0, :, 0].tolist() == [0, 0.5, 1]


def test_levels_are_those_of_the_kernel() -> None:
    assert to_8_bits(grey(0, 0.4999 / 255, 0.5001 / 255, 1))[0, :, 0].tolist() == [0, 0, 1, 255]


def test_a_pixel_changes_as_a_whole() -> None:
    one, other = grey(0.1, 0.2, 0.3), grey(0.1, 0.2, 0.3001)
    other[0, 1, 2] += 0.01
    assert changed(one, other) == 1


def test_heat_is_logarithmic() -> None:
    picture = error_image(grey(0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1), grey(0, 0, 0, 0, 0, 0, 0))
    assert picture.array[0].tolist() == HEAT[[0, 0, 0, 1, 2, 3, 4]].tolist()
