"""Orders of convergence are found where they are known."""

from __future__ import annotations

import re
from dataclasses import replace
from math import isnan, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from minirt.report import answers as told
from minirt.report.ablation import Part
from minirt.report.against import changes
from minirt.report.answers import answers
from minirt.report.bench import Run
from minirt.report.findings import ERRORS, SLACK, Findings, Order, Recommendation
from minirt.report.pictures import Row
from tests.report.made_up import FINDINGS

FLOOR = 1e-4  # error of the reference


def orders(rows: list[Row]) -> list[Order]:
    return Findings(FINDINGS.subject, 1024, FLOOR, pictures=rows).orders


def row(knob: str, samples: float, order: float = 0.75, noise: float = 1.0, **changes: object) -> Row:
    """A row whose time is proportional to its samples, measured against a reference that has an error of its own."""
    error = 0.02 * samples**-order * noise
    made = Row(knob, str(samples), samples=samples, rmse=float(np.hypot(error, FLOOR)), ms=3 * samples)
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


def test_unknown_samples_and_times_are_left_out_of_the_fit() -> None:
    rows = [row("u", samples) for samples in (1, 4, 16, 64)]
    (found,) = orders([*rows[:2], rows[2]._replace(ms=nan), rows[3]])
    assert found.by_time == pytest.approx(0.75)
    (found,) = orders([each._replace(samples=nan) for each in rows])
    assert isnan(found.by_samples)
    assert found.by_time == pytest.approx(0.75)


# Times are wall times, or processor times of a thread where other programs disturbed one of them.


def runs(wall: float, cpu: float, share_waited: float = 0.0) -> list[Run]:
    return [Run(wall * k, cpu * k, share_waited * cpu * k) for k in (0.9, 1.0, 1.1)]


def settled(**times: list[Run]) -> Findings:
    found = replace(FINDINGS, times={f"{name} 1": each for name, each in times.items()})
    found.pictures = [row(name, 1) for name in (*times, "failed")]
    found.settle_times()
    return found


def test_times_are_wall_times_where_nothing_disturbed_them() -> None:
    found = settled(u=runs(0.010, 0.016), v=runs(0.020, 0.024))
    assert not found.by_processor
    assert [each.ms for each in found.pictures] == pytest.approx([10, 20, 3])
    assert (found.pictures[0].wall_ms, found.pictures[0].cpu_ms, found.pictures[0].runs) == pytest.approx((10, 8, 3))


def test_one_disturbed_row_makes_all_times_those_of_processors() -> None:
    """With two threads. The row that was not disturbed alone must not win by that: it is the slowest."""
    found = settled(u=runs(0.030, 0.016, 0.5), v=runs(0.050, 0.024, 0.5), w=runs(0.040, 0.080))
    assert found.by_processor
    assert [each.ms for each in found.pictures] == pytest.approx([8, 12, 40, 3])
    low, high = found.pictures[0].ms_low, found.pictures[0].ms_high
    assert (low, high) == (pytest.approx(7.2), pytest.approx(8.8))
    assert found.clock == "of processor time of each of 2 threads, as other programs disturbed the wall times"


def test_a_disturbed_report_makes_the_times_of_the_other_one_those_of_processors_too() -> None:
    other = settled(u=runs(0.010, 0.016))
    found = replace(settled(u=runs(0.030, 0.016, 0.5)), other=other)
    found.settle_times()
    assert other.by_processor
    assert list(changes(found, other)) == []


# The simplest setting is recommended of those that take about the least time.


def point(rmse: float, ms: float, label: str = "", doubt: float = 0.1) -> Row:
    """A row with intervals of a tenth around its error and its time."""
    low, high = 1 - doubt, 1 + doubt
    errors = {"rmse": rmse, "rmse_low": low * rmse, "rmse_high": high * rmse}
    times = {"ms": ms, "ms_low": low * ms, "ms_high": high * ms}
    return Row("u", label, options=f"--samples {label}", samples=8, **errors, **times)


ROUGH, FINE, SLOW, FAILED = *map(point, (0.02, 0.008, 0.0081), (1, 10, 20), "rfs"), Row("u", "", options="-")
AMOUNTS = some.floats(1e-4, 1e3)


def choices(rows: list[Row]) -> dict[str, Recommendation]:
    return {choice.goal: choice for choice in Findings(FINDINGS.subject, 1024, 0.0, pictures=rows).choices}


# Times in ms of a uniform setting and of another one, in runs beside twenty busy programs on two processors.
MEASURED = [
    ("auto", 6.406, [(412, 361), (356, 265), (429, 277)]),  # scenes/gallery-stage.rt
    ("1 bounce", 1.0, [(125, 80), (126, 97), (167, 87)]),  # scenes/gallery-rings.rt
]


def test_of_times_that_are_about_equal_the_usual_work_decides() -> None:
    """Noise of a quarter in all times changes nothing."""
    uniform = FINE._replace(knob="uniform", samples=8)
    single = FINE._replace(knob="single", samples=8)  # usually takes 0.55 of the time
    auto = FINE._replace(knob="auto", samples=3.9)  # usually takes 0.98 of it, which is no reason
    for rows, best in (([uniform, single], single), ([uniform, auto], uniform), ([uniform, SLOW], uniform)):
        for factors in ((1, 1), (0.8, 1), (1, 0.8)):
            noisy = [row._replace(ms=row.ms * factor) for row, factor in zip(rows, factors, strict=True)]
            assert choices(noisy)["0.01"].options == best.options
            assert choices(noisy)["0.01"].best.name == best.name
    slow = single._replace(ms=20.1)  # more than twice the least time, whatever is usual
    assert choices([uniform, slow])["0.01"].best == uniform
    assert choices([uniform, single._replace(label="x")])["0.01"].equal == "uniform f"
    assert choices([uniform, SLOW])["0.01"].equal == ""


@pytest.mark.parametrize(("knob", "samples", "times"), MEASURED)
def test_times_beside_busy_programs_change_no_recommendation(
    knob: str, samples: float, times: list[tuple[float, float]]
) -> None:
    few = FINE._replace(knob="uniform", samples=16.0 if samples > 1 else 1.0)
    other = FINE._replace(knob=knob, samples=samples)
    found = [choices([few._replace(ms=one), other._replace(ms=two)])["0.01"].best for one, two in times]
    assert len({row.knob for row in found if row}) == 1


def test_no_options_and_no_time_are_never_the_best() -> None:
    unknown, other = FINE._replace(ms=nan), FINE._replace(options="")
    assert {choice.best for choice in choices([ROUGH, unknown, other]).values()} == {ROUGH, None}


@given(some.lists(some.builds(point, AMOUNTS, AMOUNTS, doubt=some.floats(0.01, 0.5)), max_size=12))
def test_nothing_is_much_faster_than_what_is_recommended(rows: list[Row]) -> None:
    found = choices([*(row._replace(samples=index) for index, row in enumerate(rows, 1)), FAILED])
    for most in ERRORS:
        best, reached = found[f"{most:g}"].best, [row for row in rows if row.rmse_high <= most]
        assert (best is None) == (not reached)
        assert not best or (best.rmse_high <= most and all(best.ms <= SLACK * row.ms for row in reached))


# The answers.


def automatic(asked: float, rmse: float, ms: float) -> Row:
    return point(rmse, ms, f"{asked:g}", 0.05)._replace(knob="auto", asked=asked)


def answer(*rows: Row) -> str:
    """Answer whether automatic sampling pays where uniform sampling takes 1 ms for an error of 0.04, and at an order
    of 1 less than that in proportion."""
    uniform = [point(0.04 / n, n, str(n))._replace(knob="uniform") for n in (1, 2, 4, 8, 16)]
    return told.automatic(Findings(FINDINGS.subject, 1024, 1e-5, pictures=[*uniform, *rows]))


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        (
            [(0.01, 0.01, 2.0)],
            r"Yes for an error of 0\.01: it takes 0\.5 times as long .* \(2 ms instead of 4 ms for RMSE 0\.01\)",
        ),
        ([(0.01, 0.01, 6.0)], r"No for an error of 0\.01: it takes 1\.5 times"),
        (
            [(0.01, 0.01, 6.0), (0.005, 0.004, 5.0)],
            r"Yes for an error of 0\.005, no for an error of 0\.01: it takes 0\.5 to 1\.5 times",
        ),
        ([(0.01, 0.01, 4.2)], r"It makes no difference that can be measured: it takes 1\.1 times"),
        ([(0.05, 0.08, 2.0)], r"No for an error of 0\.05: it takes 2 times"),  # one sample takes 1 ms
        ([(0.001, 0.0001, 2.0)], r"Yes: it has smaller errors than any uniform number"),
        ([], r"It was not measured"),
    ],
)
def test_whether_automatic_sampling_pays(rows: list[tuple[float, float, float]], expected: str) -> None:
    assert re.match(expected, answer(*(automatic(*row) for row in rows)))


def test_automatic_sampling_does_not_pay_where_there_is_no_error() -> None:
    rows = [point(0.0, 1, "1")._replace(knob="uniform"), automatic(0.01, 0.0, 2.0)]
    assert told.automatic(Findings(FINDINGS.subject, 1024, 1e-5, pictures=rows)).startswith("No: one sample per pixel")


def told_by(question: str, found: Findings) -> str:
    return dict(answers(found))[question]


BUSY = {"u 1": [Run(0.02, 0.02, 0.02)]}  # of which the system says that it waited


def test_the_best_setting_and_what_the_next_costs() -> None:
    """The first sentence has what to type, its size, its error and its time; and says which clock that is."""

    def best(*rows: Row, **changes: Any) -> str:
        found = Findings(FINDINGS.subject, 1024, 0.0, pictures=list(rows), **changes)
        found.settle_times()
        return told_by("Best setting:", found)

    one, two, three = point(0.0035, 10, "1"), point(0.0015, 1234.5, "2"), point(0.0008, 55, "3")
    typed = "`miniRT 'scenes/<ball>.rt' -o picture.png --size 32x20 --samples"
    first = f"{typed} 1` (10 ms a picture, RMSE 0.0035) has an error of at most 0.004, one of 255 levels"
    next_one = "`--samples 2` (RMSE 0.0015)"
    assert best(one, two) == f"{first}; at most 0.002 costs 123 times the time, with {next_one}."
    assert best(one) == f"{first}; none is sure to have at most 0.002."
    assert best(three).endswith("has an error of at most 0.004, one of 255 levels, and even of at most 0.001.")
    closest = (
        f"none is sure to have an error of at most 0.004, one of 255 levels; {typed} f` (10 ms a picture, RMSE 0.008)"
    )
    assert best(FINE) == f"{closest} comes closest."
    assert best(FAILED) == "nothing was measured."
    busy = "(10 ms of processor time of each of 2 threads, as other programs disturbed the wall times, RMSE 0.0035)"
    assert f"{typed} 1` {busy} has" in best(one, times=BUSY)


def test_exactness_and_what_is_left_out() -> None:
    hits = "the worst of 8 hits is 3 roundings off its surface (sphere, rays from the eye)"
    single = "`--precision single` changes 12 of 640 pixels"
    assert told_by("Exactness:", FINDINGS) == f"{hits}; sphere 1 is stiff (small); {single}."
    more = replace(FINDINGS, stiff=FINDINGS.stiff * 3)
    assert told_by("Exactness:", more) == f"{hits}; sphere 1 is stiff (small), and 2 more below; {single}."
    bare = replace(FINDINGS, certificates=[], stiff=[], single=nan)
    assert (
        told_by("Exactness:", bare)
        == "nothing in this scene is too small, too far away or too close to something to be drawn exactly."
    )
    lacks = "the kernel of this scene lacks 3 kinds of shapes and 5 features"
    assert told_by("Left out:", FINDINGS) == f"{lacks}."
    more = [
        Part("kind", name, "added", percent=cost, percent_low=cost - 2) for name, cost in (("tori", 9), ("cones", 1))
    ]
    dearest = f"{lacks}, of which tori would cost most, 9.0 % of a frame."
    assert told_by("Left out:", replace(FINDINGS, ablation=more)) == dearest
    saved = "; culling saves 75 % of a frame (2.5 ms instead of 10 ms, the same bits)"
    for low, told_so in ((280.0, saved), (-1.0, "")):
        brute = Part("list", "culling", "without", 10.0, 300.0, low)
        parts = [*FINDINGS.ablation, brute]
        assert told_by("Left out:", replace(FINDINGS, ablation=parts)) == f"{lacks}{told_so}."


def test_rows_of_equal_time_are_the_nearest_of_each_line() -> None:
    rows = [point(0.0035, 10, "1"), point(0.002, 14, "2"), point(0.003, 12, "3")._replace(knob="v")]
    rows += [point(0.001, 16, "4")._replace(knob="w"), rows[0]._replace(knob="the same")]
    assert Findings(FINDINGS.subject, 1024, 0.0, pictures=rows).of_equal_time == [rows[2], rows[0]]
    assert Findings(FINDINGS.subject, 1024, 0.0).of_equal_time == []
