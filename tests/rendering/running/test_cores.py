"""The number of usable processors: affinity of the process, limit of its container."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from minirt.rendering.running import cores
from minirt.rendering.running.cores import usable_cores


@pytest.fixture(autouse=True)
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A machine with eight processors, and the file that limits its container."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(8)), raising=False)
    monkeypatch.setattr(cores, "QUOTA", tmp_path / "cpu.max")
    return tmp_path / "cpu.max"


@pytest.mark.parametrize(
    ("quota", "expected"),
    [
        ("max 100000", 8),
        ("200000 100000", 2),
        ("350000 100000", 4),
        ("50000 100000", 1),
        ("1000 100000", 1),
        ("1600000 100000", 8),
        ("150000 50000\n", 3),
        ("", 8),
        ("what is this", 8),
    ],
)
def test_a_container_limits_the_number(machine: Path, quota: str, expected: int) -> None:
    machine.write_text(quota)
    assert usable_cores() == expected


def test_without_a_container_all_processors_count() -> None:
    assert usable_cores() == 8


def test_the_affinity_of_the_process_limits_the_number(monkeypatch: pytest.MonkeyPatch) -> None:
    own = {0: {3, 5}}  # 0 stands for the calling process
    monkeypatch.setattr(os, "sched_getaffinity", own.__getitem__)
    assert usable_cores() == 2


@pytest.mark.parametrize(("count", "expected"), [(6, 6), (None, 1)])
def test_without_affinities_all_processors_count(
    monkeypatch: pytest.MonkeyPatch, count: int | None, expected: int
) -> None:
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert usable_cores() == expected
