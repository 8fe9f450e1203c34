"""Time a piece of work until enough of its runs were not disturbed by other programs."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from minirt.helpers.system import Run, is_disturbed, runs

RUNS = 7  # of a round
FEW = 3  # of a round, of work so slow that `RUNS` of them would take longer than a picture may
ENOUGH = 5  # undisturbed runs, for a median with a confidence interval
TOO_SLOW = "takes too long for more than the first run"
DISTURBED_BY_OTHERS = "other programs needed the processors"


class Budget(NamedTuple):
    """Time that measuring a setting may take."""

    seconds: float  # least total of the runs of a setting
    longest: float  # seconds for a picture; a slower setting is left out
    tries: int  # rounds of runs at most, until enough of them are undisturbed


class Times(NamedTuple):
    """Runs to take the time from, and a remark if that time is not reliable."""

    runs: list[Run]
    remark: str = ""


def measure_times(work: Callable[[], object], first: Run, threads: int, budget: Budget) -> Times:
    """Return the undisturbed runs of some work after the warm-up run `first`; all runs if too few are undisturbed."""
    if first.wall > budget.longest:
        return Times([first], TOO_SLOW)
    least = RUNS if RUNS * first.wall <= budget.longest else FEW
    found: list[Run] = []
    for _ in range(budget.tries):
        found += runs(work, least, budget.seconds)
        undisturbed = [run for run in found if not is_disturbed(run, threads)]
        if len(undisturbed) >= min(ENOUGH, least):
            return Times(undisturbed)
        if sum(run.wall for run in found) > budget.longest:
            break
    return Times(found, DISTURBED_BY_OTHERS)
