"""Rounds, medians and tables, from known figures."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from minirt.rendering.threads import usable_cores
from tests.bench import measure
from tests.bench.measure import Cell, Clock, Round, available, clock, elsewhere, take_turns
from tests.bench.system import MissingError, Setting, System
from tests.bench.table import figure, records, table, times


class Counting(System):
    """A fake system: its n-th frame takes n milliseconds times the letters of its name."""

    how = "invented"

    def __init__(self, setting: Setting, name: str, calls: list[str]) -> None:
        super().__init__(setting)
        self.name, self.calls, self.took = name, calls, 0

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        self.calls.append(f"{self.name} {path.stem}")
        self.took += 1
        return [100.0, float(self.took * len(self.name)), 0.0]


def test_systems_take_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.bench.measure.clock", lambda: Clock(0, 0, 0))
    monkeypatch.setattr("tests.bench.measure.elsewhere", lambda start, end: 0.0)
    calls: list[str] = []
    setting = Setting(16, 16, 1, Path())
    systems: list[System] = [Counting(setting, name, calls) for name in ("a", "bb")]
    cells = take_turns(systems, [Path("x.rt"), Path("y.rt")], rounds=3, seconds=0)
    assert calls == ["a x", "bb x", "a y", "bb y"] * 3
    assert [each.ms for each in cells["bb", "x"].rounds] == [2, 6, 10]
    assert cells["bb", "x"].ms == 6


def test_a_system_is_not_measured_on_what_it_does_not_render(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.bench.measure.elsewhere", lambda start, end: 0.0)
    monkeypatch.setattr(Counting, "renders", lambda self, path: (self.name, path.stem) != ("bb", "mesh"))
    setting = Setting(16, 16, usable_cores(), Path())
    systems: list[System] = [Counting(setting, name, []) for name in ("a", "bb")]
    cells = take_turns(systems, [Path("one.rt"), Path("mesh.rt")], rounds=1, seconds=0)
    assert list(cells) == [("a", "one"), ("bb", "one"), ("a", "mesh")]
    assert table(cells, ["a", "bb"], ["one", "mesh"]).splitlines() == [
        "ms a frame          one         mesh",
        "a           1.00   x1.0  2.00   x1.0",
        "bb          2.00   x2.0            -",
    ]


def test_cells_that_were_always_disturbed_are_measured_again(monkeypatch: pytest.MonkeyPatch) -> None:
    loads = iter([9.0, 9.0, 0.0, 9.0, 0.0])  # of bb and a in two rounds, then of a alone
    monkeypatch.setattr("tests.bench.measure.elsewhere", lambda start, end: next(loads))
    calls: list[str] = []
    setting = Setting(16, 16, usable_cores(), Path())
    systems: list[System] = [Counting(setting, name, calls) for name in ("bb", "a")]
    cells = take_turns(systems, [Path("x.rt")], rounds=2, seconds=0)
    assert calls == ["bb x", "a x", "bb x", "a x", "a x"]
    assert [cells[name, "x"].ms for name in ("bb", "a")] == [4, 3]


def test_rounds_that_others_disturbed_do_not_count() -> None:
    everything = usable_cores()
    cell = Cell(everything, [Round(5, 0.0), Round(90, 1.5), Round(7, 0.05)])
    assert (cell.ms, cell.disturbed) == (6, False)
    assert Cell(everything, [Round(90, 1.5), Round(80, 1.5)]).disturbed
    assert Cell(everything, [Round(90, 1.5), Round(80, 1.5)]).ms == 85
    assert not Cell(everything - 2, [Round(90, 1.5)]).disturbed  # there was a processor to spare


def test_what_others_use_is_what_we_do_not() -> None:
    assert elsewhere(Clock(0, 100, 10), Clock(2, 107, 13)) == 2
    assert elsewhere(Clock(0, 100, 10), Clock(2, 102, 13)) == 0


STAT = "cpu  {} 20 30 4000 500 6 7 8 9 10\ncpu0 1 2 3 4 5 6 7 8 9 10\nctxt 12345\n"


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Fake the clocks of a system and its file of ticks, a hundredth of a second each."""
    monkeypatch.setattr(measure, "PROCESSOR_TIME", tmp_path / "stat")
    monkeypatch.setattr(measure, "perf_counter", lambda: 77.0)
    monkeypatch.setattr(os, "times", lambda: (1.0, 2.0, 0.25, 0.5, 9.0))
    monkeypatch.setattr(os, "sysconf", {"SC_CLK_TCK": 100}.__getitem__)
    return tmp_path / "stat"


def test_the_clock_is_that_of_the_system(machine: Path) -> None:
    """All busy ticks count: user, nice, system, interrupts, steal; not idle ones, nor guests, which user and nice
    include. This program's time includes its children's."""
    machine.write_text(STAT.format(100))
    assert clock() == Clock(77.0, (100 + 20 + 30 + 6 + 7 + 8) / 100, 3.75)
    before = clock()
    machine.write_text(STAT.format(350))
    assert clock().all - before.all == 2.5


def test_where_nobody_counts_ticks_other_programs_are_idle(machine: Path) -> None:
    assert clock() == Clock(77.0, 3.75, 3.75)
    machine.write_text("nonsense")
    assert clock() == Clock(77.0, 3.75, 3.75)


def test_the_systems_own_clocks_can_be_read() -> None:
    start, end = clock(), clock()
    assert end.wall >= start.wall
    assert end.all >= start.all >= 0
    assert end.own >= start.own > 0


def test_what_is_missing_is_told() -> None:
    def missing() -> System:
        raise MissingError("nothing there")

    system = Counting(Setting(16, 16, 1, Path()), "a", [])
    assert available([lambda: system, missing]) == ([system], ["nothing there"])


@pytest.mark.parametrize(
    ("ms", "text"),
    [(0.9123, "0.91"), (9.996, "10.0"), (9.123, "9.12"), (91.23, "91.2"), (912.3, "912"), (9123.4, "9123")],
)
def test_figures_have_three_digits(ms: float, text: str) -> None:
    assert figure(ms) == text


@pytest.mark.parametrize(
    ("ratio", "text"), [(0.123, "x0.12"), (1, "x1.0"), (1.26, "x1.3"), (9.98, "x10"), (0.999, "x1.0"), (12.6, "x13")]
)
def test_ratios_have_two_digits(ratio: float, text: str) -> None:
    assert times(ratio) == text


def test_the_table() -> None:
    busy = usable_cores()
    cells = {
        ("us", "one"): Cell(busy, [Round(2, 0)]),
        ("us", "two"): Cell(busy, [Round(4, 0)]),
        ("them", "one"): Cell(busy, [Round(1, 9)]),
        ("them", "two"): Cell(busy, [Round(100, 0)]),
    }
    assert table(cells, ["us", "them"], ["one", "two"]).splitlines() == [
        "ms a frame          one          two",
        "us          2.00   x1.0  4.00   x1.0",
        "them        1.00* x0.50   100    x25",
    ]
    assert records(cells)[2] == {
        "system": "them", "scene": "one", "ms": 1, "disturbed": True, "rounds": [1], "elsewhere": [9], "threads": busy,
    }  # fmt: skip
