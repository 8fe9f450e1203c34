"""Every step of a report is expected, with a duration, so that the remaining time is right."""

from __future__ import annotations

from math import inf, isfinite
from pathlib import Path

import numpy as np
import pytest

from minirt.report.generate import report
from minirt.report.measurements import durations, plan, povray
from minirt.report.measurements.plan import FULL, QUICK
from minirt.report.measurements.run_times import Budget
from minirt.report.measurements.settings import AUTO, KNOBS, Setting
from minirt.report.measurements.variants import Variant
from minirt.report.progress import Progress
from tests.kernel.pictures import ALL
from tests.simulated_clock import simulate_clock

UNIFORM = KNOBS[0]


def test_the_steps_are_those_that_come(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    simulate_clock(monkeypatch)
    short = QUICK._replace(shapes=1, samples=64, most=4, least_error=0.01, budget=Budget(0.0, inf, tries=1))
    monkeypatch.setattr("minirt.report.generate.QUICK", short)
    came: list[str] = []
    step, seen = Progress.step, []

    def noted(self: Progress, what: str) -> None:
        step(self, what)
        came.append(what)
        seen.append(self)

    monkeypatch.setattr(Progress, "step", noted)
    report(ALL, "all.rt", tmp_path, (32, 20), 1, quick=True)
    shown = seen[-1]
    assert came[0] == "compiling"
    assert set(came[1:]) == set(shown.seconds)
    assert all(isfinite(seconds) and seconds > 0 for seconds in shown.seconds.values())
    assert shown.done + shown.current == pytest.approx(shown.expected)


def test_more_work_is_expected_to_take_longer() -> None:
    settings = [Setting(UNIFORM, 4), Setting(UNIFORM, 16), Setting(AUTO, 0.01), Setting(AUTO, 0.001)]
    few, many, coarse, fine = (seconds for _, seconds in durations.setting_steps(settings, FULL, 0.1, 10_000))
    assert few < many
    assert coarse < fine
    lists, kernel = (Variant("", "a", "b", ALL, packing) for packing in ((lambda *_: None,), ()))
    (_, short), (_, long) = durations.variant_steps([lists, kernel], 0.1)
    assert long == short + durations.COMPILING


def test_a_picture_that_takes_too_long_is_drawn_once() -> None:
    slow = Setting(UNIFORM, 64)
    ((_, seconds),) = durations.setting_steps([slow], FULL, 1.0, 0)
    assert seconds == 64.0 > FULL.budget.longest


def test_other_programs_are_expected_where_they_are_measured() -> None:
    names = [name for name, _ in durations.povray_steps(FULL, 100)]
    assert names == [f"{each.knob} {each.label}" for each in povray.SETTINGS]
    assert not list(durations.povray_steps(QUICK, 100))


def test_the_reference_takes_all_its_passes() -> None:
    steps = durations.reference_steps(plan.FULL, 0.5)
    assert np.sum([seconds for _, seconds in steps]) == pytest.approx(0.5 * plan.FULL.samples)
