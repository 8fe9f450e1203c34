"""No setting beats one of the Pareto front in both time and error."""

from __future__ import annotations

from math import nan
from typing import NamedTuple

from hypothesis import given
from hypothesis import strategies as some

from minirt.report.measurements.pareto import closest, fastest, pareto_front


class Point(NamedTuple):
    rmse: float
    wall_ms: float


ROUGH, FINE, SLOW, FAILED = Point(0.1, 1), Point(0.01, 10), Point(0.05, 20), Point(nan, nan)
POINTS = [SLOW, FINE, FAILED, ROUGH]
FEW = some.integers(1, 6).map(float)


def test_by_hand() -> None:
    assert pareto_front(POINTS, 0.0) == [ROUGH, FINE]
    assert fastest(POINTS, 0.06) == FINE
    assert fastest(POINTS, 0.1) == ROUGH
    assert fastest(POINTS, 0.001) is None
    assert closest(POINTS, 9.9, 0.0) == ROUGH
    assert closest(POINTS, 1000, 0.0) == FINE
    assert closest(POINTS, 0.5, 0.0) is None
    assert pareto_front([FAILED], 0.0) == []


def test_an_error_smaller_by_less_than_the_doubt_counts_as_equal() -> None:
    close = Point(0.0099, 30)
    assert pareto_front([*POINTS, close], 0.0) == [ROUGH, FINE, close]
    assert pareto_front([*POINTS, close], 0.001) == [ROUGH, FINE]
    assert closest([*POINTS, close], 1000, 0.001) == FINE


@given(some.lists(some.builds(Point, FEW, FEW), max_size=12), FEW)
def test_nothing_beats_the_front(points: list[Point], wanted: float) -> None:
    best = pareto_front(points, 0.0)
    for point in points:
        assert any(other.rmse <= point.rmse and other.wall_ms <= point.wall_ms for other in best)
    for point in best:
        assert not any(
            other != point and other.rmse <= point.rmse and other.wall_ms <= point.wall_ms for other in points
        )
    good = [point.wall_ms for point in points if point.rmse <= wanted]
    chosen = fastest(points, wanted)
    assert (chosen.wall_ms if chosen else None) == min(good, default=None)
    quick = [point.rmse for point in points if point.wall_ms <= wanted]
    near = closest(points, wanted, 0.0)
    assert (near.rmse if near else None) == min(quick, default=None)
