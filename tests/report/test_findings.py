"""Orders of convergence are found where they are known."""

from __future__ import annotations

import re
from dataclasses import replace
from math import isnan, nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from minirt.report import document
from minirt.report.ablation import Part
from minirt.report.findings import ERROR, ERRORS, TIME, TIMES, WORST, Findings, Order, Recommendation
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


# A setting is recommended where no other one is certainly better; of those that cannot be told apart the simplest is.


def point(rmse: float, wall_ms: float, label: str = "", doubt: float = 0.1) -> Row:
    """A row with intervals of a tenth around its error and its time."""
    low, high = 1 - doubt, 1 + doubt
    errors = {"rmse": rmse, "rmse_low": low * rmse, "rmse_high": high * rmse}
    times = {"wall_ms": wall_ms, "wall_low_ms": low * wall_ms, "wall_high_ms": high * wall_ms}
    return Row("u", label, options=f"--samples {label}", valid=True, **errors, **times)


ROUGH, FINE, SLOW, FAILED = *map(point, (0.02, 0.008, 0.0081), (1, 10, 20), "rfs"), Row("u", "", options="-")
AMOUNTS = some.floats(1e-4, 1e3)


def choices(rows: list[Row]) -> dict[str, Recommendation]:
    return {choice.goal: choice for choice in Findings(FINDINGS.subject, 1024, 0.0, pictures=rows).choices}


def test_settings_that_cannot_be_told_apart_are_as_good_and_the_simplest_is_recommended() -> None:
    """A faster or closer setting wins once its interval is clear of the other's, and by no smaller difference."""
    for other, is_better in (
        (point(0.0079, 9.9, "o"), False),
        (point(0.0080, 8.3, "o"), False),
        (point(0.0080, 8.1, "o"), True),
        (point(0.0064, 10.1, "o"), True),
    ):
        for goal in ("error at most 0.01", "at most 16 ms"):
            choice = choices([FINE, SLOW, other])[goal]
            assert (choice.best, choice.equal) == ((other, "") if is_better else (FINE, other.name))


def test_disturbed_rows_and_those_that_no_option_draws_are_never_the_best() -> None:
    disturbed, other = FINE._replace(valid=False, remark=DISTURBED_BY_OTHERS), FINE._replace(options="")
    assert {choice.best for choice in choices([ROUGH, disturbed, other]).values()} == {ROUGH, None}


@given(some.lists(some.builds(point, AMOUNTS, AMOUNTS, doubt=some.floats(0.01, 0.5)), max_size=12))
def test_nothing_is_certainly_better_than_what_is_recommended(rows: list[Row]) -> None:
    goals = [(f"error at most {most:g}", most, ERROR, TIME) for most in ERRORS]
    goals += [(f"at most {most:g} ms", most, TIME, ERROR) for most in TIMES]
    found = choices([*rows, FAILED])
    for goal, most, limited, wanted in goals:
        best, good = found[goal].best, [row for row in rows if row.rmse_high <= WORST]
        reached = [row for row in good if limited(row)[1] <= most]
        assert (best is None) == (not reached)
        assert not best or (best in reached and all(wanted(row)[1] >= wanted(best)[0] for row in reached))


# The answers.


def automatic(asked: float, rmse: float, wall_ms: float) -> Row:
    return point(rmse, wall_ms, f"{asked:g}", 0.05)._replace(knob="auto", asked=asked)


def answer(*rows: Row) -> str:
    """Answer whether automatic sampling pays where uniform sampling takes 1 ms for an error of 0.04, and at an order
    of 1 less than that in proportion."""
    uniform = [point(0.04 / n, n, str(n))._replace(knob="uniform") for n in (1, 2, 4, 8, 16)]
    return document.automatic(Findings(FINDINGS.subject, 1024, 1e-5, pictures=[*uniform, *rows]))


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([(0.01, 0.01, 2.0)], r"Yes: it takes 0\.5 times as long .* \(2 ms instead of 4 ms for RMSE 0\.01\)"),
        ([(0.01, 0.01, 6.0)], r"No: it takes 1\.5 times"),
        (
            [(0.01, 0.01, 6.0), (0.005, 0.004, 5.0)],
            r"Yes for an error of 0\.005, no for 0\.01: it takes 0\.5 to 1\.5 times",
        ),
        ([(0.01, 0.01, 4.2)], r"It makes no difference that can be measured: it takes 1\.1 times"),
        ([(0.05, 0.08, 2.0)], r"No: it takes 2 times"),  # one sample takes 1 ms
        ([(0.001, 0.0001, 2.0)], r"unknown"),  # uniform sampling was not measured so far
        ([], r"unknown"),
    ],
)
def test_whether_automatic_sampling_pays(rows: list[tuple[float, float, float]], expected: str) -> None:
    assert re.match(expected, answer(*(automatic(*row) for row in rows)))


def test_the_best_setting_and_what_the_next_costs() -> None:
    def told(*rows: Row) -> str:
        return document.best_setting(Findings(FINDINGS.subject, 1024, 0.0, pictures=list(rows)))

    one, two, three = point(0.0035, 10, "1"), point(0.0015, 1234.5, "2"), point(0.0008, 55, "3")
    best = "`--samples 1` (10 ms a picture, RMSE 0.0035) has an error of at most 0.004, one of 255 levels"
    next_one = "`--samples 2` (1234 ms a picture, RMSE 0.0015)"
    assert told(one, two) == f"{best}; at most 0.002 costs 123 times the time, with {next_one}"
    assert told(one) == f"{best}; none is sure to have at most 0.002"
    assert told(one, one._replace(knob="v")).startswith(f"{best}, and so has v 1;")
    assert told(three).endswith("has an error of at most 0.004, one of 255 levels, and even of at most 0.001")
    assert told(FINE) == (
        "none is sure to have an error of at most 0.004, one of 255 levels; "
        "`--samples f` (10 ms a picture, RMSE 0.008) comes closest"
    )
    assert told(FAILED) == document.UNKNOWN


def test_exactness_and_what_is_left_out() -> None:
    hits = "the worst of 8 hits is 3 roundings off its surface (sphere, rays from the eye)"
    single = "`--precision single` changes 12 of 640 pixels"
    assert document.exactness(FINDINGS) == f"{hits}; sphere 1 is stiff (small); {single}"
    more = replace(FINDINGS, stiff=FINDINGS.stiff * 3)
    assert document.exactness(more) == f"{hits}; sphere 1 is stiff (small), and 2 more below; {single}"
    bare = replace(FINDINGS, certificates=[], stiff=[], single=nan)
    assert document.exactness(bare) == "nothing in this scene is stiff"
    lacks = "the kernel of this scene lacks 3 kinds of shapes and 5 features"
    assert document.left_out(FINDINGS) == lacks
    more = [
        Part("kind", name, "added", percent=cost, percent_low=cost - 2) for name, cost in (("tori", 9), ("cones", 1))
    ]
    dearest = f"{lacks}, of which tori would cost most, 9.0 % of a frame"
    assert document.left_out(replace(FINDINGS, ablation=more)) == dearest
    for time, saved in ((10.0, "; culling saves 75 % of a frame (2.5 ms instead of 10 ms, the same bits)"), (2.6, "")):
        brute = point(0.04, time, "1")._replace(knob="brute force", samples=1)
        assert document.left_out(replace(FINDINGS, pictures=[*FINDINGS.pictures, brute])) == lacks + saved


def test_rows_of_equal_time_are_the_nearest_of_each_line() -> None:
    rows = [point(0.0035, 10, "1"), point(0.002, 14, "2"), point(0.003, 12, "3")._replace(knob="v")]
    rows += [point(0.001, 16, "4")._replace(knob="w"), rows[0]._replace(knob="the same")]
    assert Findings(FINDINGS.subject, 1024, 0.0, pictures=rows).of_equal_time == [rows[2], rows[0]]
    assert Findings(FINDINGS.subject, 1024, 0.0).of_equal_time == []
