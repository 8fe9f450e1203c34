"""Conclusions from the measurements: orders of convergence, the Pareto front and the best settings, as plain data."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from importlib.metadata import version
from math import exp, isfinite, log, nan, sqrt
from operator import attrgetter
from typing import Annotated, NamedTuple

import numpy as np

import minirt
from minirt.kernel.machine_code.fingerprint import cpu_information
from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.metrics import fit
from minirt.report.pictures import Row
from minirt.report.precision import KindCertificates
from minirt.scene import Scene, dump

CLEAR = 2.0  # times the error of the reference: from there on an error is known well enough
LEVEL = 0.004  # RMSE, one of 255 levels
ERRORS = (0.03, 0.01, LEVEL, 0.002, 0.001)  # target errors, RMSE
WORST = 0.1  # RMSE of a recommended setting, at most, however short the target time
NEAR = 1.5  # ratio of times up to which they are about equal
TIMES = (16.0, 100.0, 1000.0)  # target times, milliseconds
TIME, ERROR = attrgetter("wall_low_ms", "wall_high_ms"), attrgetter("rmse_low", "rmse_high")  # intervals of a row


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
    by_samples: Annotated[float, "by samples", ".2f"] = nan  # 0.5 for random samples; NaN where they are unknown
    by_samples_low: Annotated[float, "from", ".2f"] = nan  # 95 % confidence interval, Student's t
    by_samples_high: Annotated[float, "to", ".2f"] = nan
    by_time: Annotated[float, "by time", ".2f"] = nan
    by_time_low: Annotated[float, "from", ".2f"] = nan
    by_time_high: Annotated[float, "to", ".2f"] = nan
    constant: float = nan  # RMSE at 1 sample, by the fit


class Recommendation(NamedTuple):
    """The best setting for a goal, which its error or its time reaches with a confidence of 95 %."""

    goal: Annotated[str, "goal"]  # such as "error at most 0.01"
    options: Annotated[str, "best setting"] = "none of these"  # of the command line
    wall_ms: Annotated[float, "ms", ".1f"] = nan
    rmse: Annotated[float, "RMSE", ".5f"] = nan
    equal: Annotated[str, "as good"] = ""  # settings whose times and errors cannot be told from these
    best: Row | None = None


@dataclass
class Findings:
    """All results of the measurements, which are added as soon as they are known."""

    subject: Subject
    reference_samples: int
    reference_error: float  # RMSE of the reference itself
    eight_bits: float = 1 / 255 / sqrt(12)  # RMSE that rounding to 255ths adds: no file of 8 bits can be closer
    pictures: list[Row] = field(default_factory=list)
    ablation: list[Part] = field(default_factory=list)  # what features, kinds of shapes and lists cost or save
    single: float = nan  # pixels that float32 changes, with one sample each
    certificates: list[KindCertificates] = field(default_factory=list)  # of the hits in the picture, kind by kind
    stiff: list[Stiff] = field(default_factory=list)
    absent: str = ""  # numbers of the kinds of shapes and of the features that the scene's kernel lacks
    notes: list[str] = field(default_factory=list)  # how the scene was packed, and which features were left out
    same: list[int] = field(default_factory=list)  # sample counts for which brute force gives the same bits
    not_measured: list[str] = field(default_factory=list)
    interrupted: str = ""  # what was being measured when the user interrupted the report, and what is missing

    @property
    def title(self) -> str:
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
        return Order(rows[0].knob, len(rows), *by_samples[:3], *by_time[:3], exp(by_samples[3]))

    @property
    def choices(self) -> list[Recommendation]:
        """The best setting for each target error and each target time, of those that the command line has.

        Of settings whose intervals overlap the simplest is the best.
        """
        rows = [row for row in self.pictures if row.options and row.valid and row.rmse_high <= WORST]
        found = []
        for most in ERRORS:
            fastest = unbeaten([row for row in rows if row.rmse_high <= most], TIME)
            found.append(recommendation(f"error at most {most:g}", unbeaten(fastest, ERROR)))
        for most in TIMES:
            closest = unbeaten([row for row in rows if row.wall_high_ms <= most], ERROR)
            found.append(recommendation(f"at most {most:g} ms", unbeaten(closest, TIME)))
        return found

    @property
    def recommended(self) -> list[Row]:
        """The rows that are the best for some goal."""
        return list(dict.fromkeys(choice.best for choice in self.choices if choice.best))

    @property
    def of_equal_time(self) -> list[Row]:
        """The row of each line that takes about as long as the best setting for an error of one level, the most exact
        one first; as long as the most exact setting, if none reaches that error."""
        rows = [row for row in distinct(self.pictures) if row.valid]
        best = self.choices[ERRORS.index(LEVEL)].best or min(rows, key=lambda row: row.rmse, default=None)
        ratios = {row: abs(log(row.wall_ms / best.wall_ms)) for row in rows if best}
        near = [row for row, ratio in ratios.items() if ratio < log(NEAR)]
        nearest = {row.knob: row for row in sorted(near, key=ratios.__getitem__, reverse=True)}
        return sorted(nearest.values(), key=lambda row: row.rmse)


def recommendation(goal: str, rows: list[Row]) -> Recommendation:
    """Recommend the first of some rows, the simplest one, for a goal that all of them reach equally well."""
    if not rows:
        return Recommendation(goal)
    best, *others = rows
    return Recommendation(goal, best.options, best.wall_ms, best.rmse, ", ".join(row.name for row in others), best)


def unbeaten(rows: list[Row], interval: Callable[[Row], tuple[float, float]]) -> list[Row]:
    """Return the rows whose interval lies above no other row's interval."""
    least = min((interval(row)[1] for row in rows), default=nan)
    return [row for row in rows if interval(row)[0] <= least]


def distinct(rows: Iterable[Row]) -> list[Row]:
    """Return the rows without those whose picture is that of a row before, so that the error is equal to all digits."""
    found: dict[float | str, Row] = {}
    for row in rows:
        found.setdefault(row.rmse if isfinite(row.rmse) else row.name, row)
    return list(found.values())


def subject(scene: Scene, name: str, width: int, height: int, threads: int, seed: int) -> Subject:
    """Describe a scene and this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    versions = {"minirt": minirt.__version__, "python": platform.python_version()}
    versions |= {package: version(package) for package in ("numpy", "numba", "llvmlite", "pillow")}
    processor = cpu_information("model name") or platform.processor()  # the former on Linux
    return Subject(name, digest, width, height, threads, seed, processor, versions)
