"""How long something takes, and whether other programs had a part in that."""

from __future__ import annotations

from collections.abc import Callable, Collection
from time import perf_counter, process_time
from typing import NamedTuple

DISTURBED = 1.15  # of the time that passed to the time of the processors


class Run(NamedTuple):
    """Seconds that passed, and those of the processors, of all threads of this program together."""

    wall: float
    cpu: float


def runs(work: Callable[[], object], least: int, seconds: float) -> list[Run]:
    """The times of at least so many runs, and of as many more as it takes to fill so many seconds."""
    times: list[Run] = []
    while len(times) < least or sum(run.wall for run in times) < seconds:
        wall, cpu = perf_counter(), process_time()
        work()
        times.append(Run(perf_counter() - wall, process_time() - cpu))
    return times


def in_turn(works: Collection[Callable[[], object]], times: int) -> list[tuple[Run, ...]]:
    """The times of so many runs of each work. They take turns: what else the machine does slows all of them alike."""
    return [*zip(*([runs(work, 1, 0.0)[0] for work in works] for _ in range(times)), strict=True)]


def is_disturbed(run: Run, threads: int) -> bool:
    """Whether the threads had to wait for a processor: more time passed than they worked."""
    return run.wall * threads > DISTURBED * run.cpu
