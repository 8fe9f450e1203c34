"""The findings of a report, as plain data."""

from __future__ import annotations

import hashlib
from math import sqrt
from typing import Any, NamedTuple

from minirt.report.measurements import ablation, convergence, formula_errors, picture_errors
from minirt.report.measurements.hit_certificates import KindCertificates
from minirt.report.measurements.machine import processor, versions
from minirt.report.measurements.pareto import closest, fastest
from minirt.report.measurements.run_times import DISTURBED_BY_OTHERS
from minirt.report.measurements.single_errors import SingleError
from minirt.report.measurements.stiffness import Stiff
from minirt.scene import Scene, dump

ERRORS = (0.03, 0.01, 0.003, 0.001)  # target errors, RMSE
TIMES = (16.0, 100.0, 1000.0)  # target times, milliseconds
EIGHT_BITS = 1 / 255 / sqrt(12)  # standard deviation of a number that is rounded to a 255th


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
    eight_bits: float  # RMSE that rounding to 8 bits per channel adds: no picture in such a file can be closer
    pictures: list[picture_errors.Row]
    orders: list[convergence.Order]  # of each line of the diagram
    ablation: list[ablation.Part]  # what features, kinds of shapes and lists cost or save
    single: list[SingleError]  # errors of float32, feature by feature
    kernels: list[formula_errors.Row]
    certificates: list[KindCertificates]  # of the hits in the picture, kind by kind
    stiff: list[Stiff]
    notes: list[str]  # how the scene was packed, and which features were left out
    same: list[int]  # sample counts for which the picture without culling is the same, bit for bit
    not_measured: list[str]
    interrupted: str = ""  # what was being measured when the user interrupted the report, and what is missing


def subject(scene: Scene, name: str, width: int, height: int, threads: int, seed: int) -> Subject:
    """Describe a scene and this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    return Subject(name, digest, width, height, threads, seed, processor(), versions())


def choices(rows: list[picture_errors.Row], doubt: float) -> list[dict[str, Any]]:
    """Find the best setting for each target error and each target time; None if no setting reaches it.

    Errors are known up to `doubt`. Rows that failed or were disturbed are never the best, nor are other programs.
    "disturbed" counts the rows that were left out since their times were disturbed.
    """
    ours = [row for row in rows if row.program == picture_errors.OURS]
    calm = [row for row in ours if row.valid]
    best = {f"error at most {error:g}": fastest(calm, error) for error in ERRORS}
    best |= {f"at most {time:g} ms": closest(calm, time, doubt) for time in TIMES}
    disturbed = sum(row.remark == DISTURBED_BY_OTHERS for row in ours)
    return [{"wanted": wanted, "best": row, "disturbed": disturbed} for wanted, row in best.items()]
