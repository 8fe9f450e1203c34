"""Orders of convergence are found where they are known."""

from __future__ import annotations

from math import isnan, nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from minirt.report.findings import Findings, Order, pareto_front
from minirt.report.pictures import DISTURBED_BY_OTHERS, Row
from tests.report.made_up import FINDINGS

FLOOR = 1e-4  # error of the reference


def orders(rows: list[Row]) -> list[Order]:
    return Findings(FINDINGS.subject, 1024, FLOOR, pictures=rows).orders


def row(knob: str, samples: float, order: float = 0.75, noise: float = 1.0, **changes: object) -> Row:
    """A row whose time is proportional to its samples, measured against a reference that has an error of its own."""
    error = 0.02 * samples**-order * noise
    made = Row(knob, str(samples), samples=samples, rmse=float(np.hypot(error, FLOOR)), wall_ms=3 * samples, valid=True)
    return made._replace(**changes)


def test_the_order_and_the_constant_are_found() -> None:
    (found,) = orders([row("uniform", samples) for samples in (1, 4, 16, 64)])
    assert (found.knob, found.points) == ("uniform", 4)
    for order, low, high in (found[2:5], found[5:8]):
        assert low <= order <= high
        assert (order, high - low) == (pytest.approx(0.75), pytest.approx(0.0, abs=1e-6))
    assert found.constant == pytest.approx(0.02)


def test_scatter_widens_the_interval_around_the_order() -> None:
    noise = (1.1, 0.9, 1.05, 0.95)
    (found,) = orders([row("u", 4**k, noise=factor) for k, factor in enumerate(noise)])
    assert 0.05 < found.by_samples_high - found.by_samples_low < 0.5
    assert found.by_samples_low < 0.75 < found.by_samples_high


def test_points_that_the_reference_cannot_tell_are_left_out() -> None:
    rows = [row("u", samples) for samples in (1, 4, 16, 64)]
    same = row("u", 4096, rmse=1.5 * FLOOR)
    assert orders([*rows, same]) == orders(rows)
    assert orders(rows[:2]) == orders([*rows[:2], Row("u", "failed")]) == []


def test_disturbed_times_and_unknown_samples_are_left_out_of_the_fit() -> None:
    rows = [row("u", samples) for samples in (1, 4, 16, 64)]
    slow = rows[2]._replace(wall_ms=1e6, valid=False)
    (found,) = orders([*rows[:2], slow, rows[3]])
    assert found.by_time == pytest.approx(0.75)
    (found,) = orders([each._replace(samples=nan) for each in rows])
    assert isnan(found.by_samples)
    assert found.by_time == pytest.approx(0.75)


# No setting beats one of the Pareto front in both time and error.


def point(rmse: float, wall_ms: float) -> Row:
    return Row("u", "", rmse=rmse, wall_ms=wall_ms, valid=True)


ROUGH, FINE, SLOW, FAILED = point(0.1, 1), point(0.01, 10), point(0.05, 20), Row("u", "")
POINTS = [SLOW, FINE, FAILED, ROUGH]
FEW = some.integers(1, 6).map(float)


def best(rows: list[Row], doubt: float = 0.0) -> dict[str, Row | None]:
    found = Findings(FINDINGS.subject, 1024, doubt, pictures=rows)
    return {choice["wanted"]: choice["best"] for choice in found.choices}


def test_the_best_settings_by_hand() -> None:
    assert pareto_front(POINTS, 0.0) == [ROUGH, FINE]
    found = best([*POINTS, point(0.02, 90)])
    assert (found["error at most 0.03"], found["error at most 0.003"]) == (FINE, None)
    assert (found["at most 16 ms"], best([ROUGH, SLOW])["at most 16 ms"]) == (FINE, ROUGH)
    assert set(best([FAILED]).values()) == {None}


def test_an_error_smaller_by_less_than_the_doubt_counts_as_equal() -> None:
    close = point(0.0099, 30)
    assert pareto_front([*POINTS, close], 0.0) == [ROUGH, FINE, close]
    assert pareto_front([*POINTS, close], 0.001) == [ROUGH, FINE]
    assert best([*POINTS, close], 0.001)["at most 100 ms"] == FINE


def test_disturbed_rows_and_other_programs_are_never_the_best() -> None:
    disturbed, other = FINE._replace(valid=False, remark=DISTURBED_BY_OTHERS), FINE._replace(program="POV-Ray")
    assert pareto_front([ROUGH, disturbed, other], 0.0) == [ROUGH]
    found = Findings(FINDINGS.subject, 1024, 0.0, pictures=[ROUGH, disturbed, other])
    assert {choice["disturbed"] for choice in found.choices} == {1}


@given(some.lists(some.builds(point, FEW, FEW), max_size=12))
def test_nothing_beats_the_front(points: list[Row]) -> None:
    front = pareto_front(points, 0.0)
    for each in points:
        assert any(other.rmse <= each.rmse and other.wall_ms <= each.wall_ms for other in front)
    for each in front:
        assert not any(other != each and other.rmse <= each.rmse and other.wall_ms <= each.wall_ms for other in points)
