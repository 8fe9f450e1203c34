"""Conclusions from the measurements: orders of convergence, the Pareto front and the best settings, as plain data."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib.metadata import version
from math import exp, isfinite, nan, sqrt
from typing import Annotated, Any, NamedTuple

import numpy as np

import minirt
from minirt.kernel.machine_code.fingerprint import cpu_information
from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.metrics import fit
from minirt.report.pictures import DISTURBED_BY_OTHERS, OURS, Row
from minirt.report.precision import KindCertificates, SingleError
from minirt.scene import Scene, dump

PACKAGES = ("numpy", "numba", "llvmlite", "pillow")
CLEAR = 2.0  # times the error of the reference: from there on an error is known well enough
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


class Order(NamedTuple):
    """Fit of RMSE = constant * samples^-by_samples, and of RMSE = constant * time^-by_time, to the points of a line."""

    knob: Annotated[str, "setting"]
    points: Annotated[int, "points", "d"]  # that were fitted; others are as small as the error of the reference
    by_samples: Annotated[float, "order by samples", ".2f"] = nan  # 0.5 for random samples; NaN where they are unknown
    by_samples_low: Annotated[float, "from", ".2f"] = nan  # 95 % confidence interval, Student's t
    by_samples_high: Annotated[float, "to", ".2f"] = nan
    by_time: Annotated[float, "order by time", ".2f"] = nan
    by_time_low: Annotated[float, "from", ".2f"] = nan
    by_time_high: Annotated[float, "to", ".2f"] = nan
    constant: Annotated[float, "RMSE at 1 sample", ".3g"] = nan  # by the fit


@dataclass
class Findings:
    """All results of the measurements, which are added as soon as they are known."""

    subject: Subject
    reference_samples: int
    reference_error: float  # RMSE of the reference itself
    eight_bits: float = EIGHT_BITS  # RMSE that rounding to 8 bits per channel adds: no such file can be closer
    pictures: list[Row] = field(default_factory=list)
    ablation: list[Part] = field(default_factory=list)  # what features, kinds of shapes and lists cost or save
    single: list[SingleError] = field(default_factory=list)  # errors of float32, feature by feature
    certificates: list[KindCertificates] = field(default_factory=list)  # of the hits in the picture, kind by kind
    stiff: list[Stiff] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)  # how the scene was packed, and which features were left out
    same: list[int] = field(default_factory=list)  # sample counts for which brute force gives the same bits
    not_measured: list[str] = field(default_factory=list)
    interrupted: str = ""  # what was being measured when the user interrupted the report, and what is missing

    @property
    def title(self) -> str:
        """The title of the report."""
        return f"{self.subject.scene}: error against run time"

    @property
    def orders(self) -> list[Order]:
        """The order of convergence of each line with at least three points whose error the reference can tell.

        The error of the reference itself, which adds to each squared error, is taken off first.
        """
        groups: dict[str, list[Row]] = {}
        for row in self.pictures:
            if row.rmse > CLEAR * self.reference_error:
                groups.setdefault(row.knob, []).append(row)
        found = map(self.order, groups.values())
        return [order for order in found if isfinite(order.by_samples) or isfinite(order.by_time)]

    def order(self, rows: list[Row]) -> Order:
        """Fit the order of convergence of a line, which falls with the logarithms of samples and of time."""
        errors = np.log([sqrt(row.rmse**2 - self.reference_error**2) for row in rows])
        timed = [row.valid for row in rows]
        by_samples = fit(-np.log([row.samples for row in rows]), errors)
        by_time = fit(-np.log([row.wall_ms for row in rows])[timed], errors[timed])
        return Order(rows[0].knob, len(rows), *by_samples[:3], *by_time[:3], exp(by_samples.intercept))

    @property
    def choices(self) -> list[dict[str, Any]]:
        """The best setting for each target error and each target time; None if no setting reaches it.

        Errors are known up to that of the reference. "disturbed" counts the rows that were left out since their times
        were disturbed.
        """
        by_error, by_time = pareto_front(self.pictures, 0.0), pareto_front(self.pictures, self.reference_error)
        best = {f"error at most {most:g}": next((row for row in by_error if row.rmse <= most), None) for most in ERRORS}
        for time in TIMES:
            best[f"at most {time:g} ms"] = next((row for row in reversed(by_time) if row.wall_ms <= time), None)
        disturbed = sum(row.remark == DISTURBED_BY_OTHERS for row in self.pictures if row.program == OURS)
        return [{"wanted": wanted, "best": row, "disturbed": disturbed} for wanted, row in best.items()]

    @property
    def recommended(self) -> list[Row]:
        """The rows that are the best for some wanted error or time."""
        return list(dict.fromkeys(choice["best"] for choice in self.choices if choice["best"]))


def subject(scene: Scene, name: str, width: int, height: int, threads: int, seed: int) -> Subject:
    """Describe a scene and this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    versions = {"minirt": minirt.__version__, "python": platform.python_version()}
    versions |= {package: version(package) for package in PACKAGES}  # that compute or draw
    return Subject(name, digest, width, height, threads, seed, processor(), versions)


def processor() -> str:
    """Return the name of the processor: from /proc/cpuinfo on Linux, from `platform` elsewhere."""
    return cpu_information("model name") or platform.processor()


def pareto_front(rows: Iterable[Row], doubt: float) -> list[Row]:
    """Return the Pareto front, the fastest first: each slower setting has an error smaller by more than `doubt`.

    Rows that failed or were disturbed are not on it, nor are other programs.
    """
    measured = (row for row in rows if row.program == OURS and row.valid and isfinite(row.rmse + row.wall_ms))
    best: list[Row] = []
    for row in sorted(measured, key=lambda row: (row.wall_ms, row.rmse)):
        if not best or row.rmse < best[-1].rmse - doubt:
            best.append(row)
    return best
