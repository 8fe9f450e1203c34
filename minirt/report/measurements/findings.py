"""The findings of a report, as plain data."""

from __future__ import annotations

import hashlib
from typing import Any, NamedTuple

from minirt.report.measurements import formula_errors, picture_errors
from minirt.report.measurements.machine import processor, versions
from minirt.report.measurements.pareto import closest, fastest
from minirt.report.measurements.stiffness import Stiff
from minirt.scene import Scene, dump

ERRORS = (0.03, 0.01, 0.003, 0.001)  # target errors, RMSE
TIMES = (16.0, 100.0, 1000.0)  # target times, milliseconds


class Subject(NamedTuple):
    """The scene that was measured, the size of its pictures, and the machine."""

    scene: str
    sha256: str  # of the scene as text
    width: int
    height: int
    threads: int
    seed: int
    processor: str
    versions: dict[str, str]


class Findings(NamedTuple):
    """All results of the measurements."""

    subject: Subject
    reference_samples: int
    reference_error: float  # RMSE of the reference itself
    pictures: list[picture_errors.Row]
    kernels: list[formula_errors.Row]
    stiff: list[Stiff]
    notes: list[str]  # how the scene was packed, and which features were left out
    same: list[int]  # sample counts for which the picture without culling is the same, bit for bit
    not_measured: list[str]


def subject(scene: Scene, name: str, width: int, height: int, threads: int, seed: int) -> Subject:
    """Describe a scene and this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    return Subject(name, digest, width, height, threads, seed, processor(), versions())


def choices(rows: list[picture_errors.Row], doubt: float) -> list[dict[str, Any]]:
    """Find the best setting for each target error and each target time; None if no setting reaches it.

    Errors are known up to `doubt`. Disturbed times are too long, never too short, so they recommend nothing wrongly.
    """
    wanted: list[dict[str, Any]] = [
        {"wanted": f"error at most {error:g}", "best": fastest(rows, error)} for error in ERRORS
    ]
    return wanted + [{"wanted": f"at most {time:g} ms", "best": closest(rows, time, doubt)} for time in TIMES]
