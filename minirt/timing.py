"""Measures run times, and whether other programs disturbed them."""

from __future__ import annotations

from collections.abc import Callable, Collection
from time import perf_counter, process_time
from typing import NamedTuple

DISTURBED = 1.15  # ratio of wall time to processor time from which a run counts as disturbed


class Run(NamedTuple):
    """Wall time and processor time of a run in seconds; the latter is the sum over all threads of this program."""

    wall: float
    cpu: float


def runs(work: Callable[[], object], least: int, seconds: float) -> list[Run]:
    """Time at least `least` runs of some work, and more until they take `seconds` together."""
    times: list[Run] = []
    while len(times) < least or sum(run.wall for run in times) < seconds:
        wall, cpu = perf_counter(), process_time()
        work()
        times.append(Run(perf_counter() - wall, process_time() - cpu))
    return times


def in_turn(works: Collection[Callable[[], object]], times: int) -> list[tuple[Run, ...]]:
    """Time so many runs of each work. The works take turns, so that other load on the machine slows them all alike."""
    return [*zip(*([runs(work, 1, 0.0)[0] for work in works] for _ in range(times)), strict=True)]


def is_disturbed(run: Run, threads: int) -> bool:
    """Whether the threads of a run had to wait for a processor: its wall time exceeds their processor time."""
    return run.wall * threads > DISTURBED * run.cpu


def in_words(seconds: float) -> str:
    """Say a time in the unit that people would use."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
