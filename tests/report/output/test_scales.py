"""Logarithmic scales and their labels."""

from __future__ import annotations

from math import nan

import pytest

from minirt.report.output.scales import LABEL_HEIGHT, LABEL_WIDTH, Scale, scale_around


def test_equal_ratios_are_equal_distances() -> None:
    scale = Scale(0.01, 100.0, 50.0, 450.0)
    assert [scale(value) for value in (0.01, 0.1, 1.0, 10.0, 100.0)] == pytest.approx([50, 150, 250, 350, 450])
    assert (scale(1e-9), scale(1e9)) == (50.0, 450.0)


def test_a_scale_may_run_upwards() -> None:
    scale = Scale(1.0, 100.0, 400.0, 0.0)
    assert scale(10.0) == pytest.approx(200.0)


def test_ticks_are_the_digits_of_each_decade() -> None:
    assert [tick for _, tick in Scale(0.95, 25.0, 0, 1).ticks()] == [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 20]


@pytest.mark.parametrize(
    ("high", "pixels", "expected"),
    [
        (1000.0, 1000.0, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]),
        (1000.0, 200.0, [1, 10, 100, 1000]),
        (9.0, 30.0, [1, 2, 5]),  # one decade alone would say nothing
    ],
)
def test_decades_are_labelled_and_more_where_there_is_room(high: float, pixels: float, expected: list[float]) -> None:
    assert Scale(1.0, high, 0.0, pixels).labelled(LABEL_WIDTH) == expected


@pytest.mark.parametrize("values", [[1.0], [0.02, 0.021], [1e-5, 3.0], [], [nan, 0.0, 4.0]])
def test_every_scale_holds_its_values_and_has_two_labels(values: list[float]) -> None:
    scale = scale_around(values, 0.0, 300.0)
    assert all(scale.holds(value) for value in values if value > 0)
    assert len(scale.labelled(LABEL_HEIGHT)) >= 2
