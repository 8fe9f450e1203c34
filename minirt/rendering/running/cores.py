"""The number of processors that this process may use, for as many threads."""

from __future__ import annotations

import os
from pathlib import Path

QUOTA = Path(
    "/sys/fs/cgroup/cpu.max"
)  # of a container: microseconds of processor time per period, and the period in microseconds


def usable_cores() -> int:
    """Count the processors that the affinity of the process and the limit of its container allow; at least 1."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        quota, period = QUOTA.read_text().split()
        return max(1, min(cores, round(int(quota) / int(period))))
    except (OSError, ValueError):  # no container, or one without limit ("max 100000")
        return cores
