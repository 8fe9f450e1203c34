"""All that a report says."""

from __future__ import annotations

import hashlib
from typing import Any, NamedTuple

from minirt.report.measurements import formula_errors, picture_errors
from minirt.report.measurements.machine import processor, versions
from minirt.report.measurements.pareto import closest, fastest
from minirt.report.measurements.stiffness import Stiff
from minirt.scene import Scene, dump

ERRORS = (0.03, 0.01, 0.003, 0.001)  # RMSE that somebody may want
TIMES = (16.0, 100.0, 1000.0)  # milliseconds


class Subject(NamedTuple):
    """What was measured, and on what."""

    scene: str
    sha256: str  # of the scene as text
    width: int
    height: int
    threads: int
    seed: int
    processor: str
    versions: dict[str, str]


class Findings(NamedTuple):
    """What was found out about it."""

    subject: Subject
    reference_samples: int
    reference_error: float  # its own, root mean square
    pictures: list[picture_errors.Row]
    kernels: list[formula_errors.Row]
    stiff: list[Stiff]
    notes: list[str]  # what was decided about the scene, and what it did without
    same: list[int]  # samples for which the picture without lists is the same, bit for bit
    not_measured: list[str]


def subject(scene: Scene, name: str, width: int, height: int, threads: int, seed: int) -> Subject:
    """A scene, on this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    return Subject(name, digest, width, height, threads, seed, processor(), versions())


def choices(rows: list[picture_errors.Row], doubt: float) -> list[dict[str, Any]]:
    """The best setting for each wanted error and each wanted time, None where there is none; errors are known but for
    a `doubt`. A time that was disturbed is too long, so what is said of it holds."""
    wanted: list[dict[str, Any]] = [
        {"wanted": f"error at most {error:g}", "best": fastest(rows, error)} for error in ERRORS
    ]
    return wanted + [{"wanted": f"at most {time:g} ms", "best": closest(rows, time, doubt)} for time in TIMES]
