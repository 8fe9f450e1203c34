"""Conclusions from the measurements: orders of convergence, the Pareto front and the best settings, as plain data."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib.metadata import version
from math import exp, isfinite, log, nan, sqrt
from typing import Annotated, NamedTuple

import numpy as np

import minirt
from minirt.errors import counted
from minirt.kernel.machine_code.fingerprint import cpu_information
from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.bench import Run
from minirt.report.metrics import fit
from minirt.report.pictures import ReferencePicture, Row, mostly_disturbed
from minirt.report.precision import KindCertificates
from minirt.report.settings import KNOBS
from minirt.scene import Scene, dump

CLEAR = 2.0  # times the error of the reference: from there on an error is known well enough
LEVEL = 0.004  # RMSE, one of 255 levels
ERRORS = (0.03, 0.01, LEVEL, 0.002, 0.001)  # target errors, RMSE
NEAR = 1.5  # ratio of times up to which they are about equal
SLACK = 2.0  # ratio of times up to which noise may have made the difference, beside busy programs
MARGIN = 1.25  # ratio of times up to which another setting is as good
HARDLY = 1.1  # ratio of usual times up to which a simpler setting is preferred
USUAL = {knob.name: knob.per_sample for knob in KNOBS}


class Subject(NamedTuple):
    """The scene that was measured, the size of its pictures, and the machine."""

    scene: str
    sha256: str  # of the scene as text
    width: int
    height: int
    pixels: int  # in which errors are measured: those of the picture, or of crops that represent it
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
    """The best setting for a goal, which its error reaches with a confidence of 95 %."""

    goal: Annotated[str, "error at most"]  # such as "0.01"
    options: Annotated[str, "best setting"] = "none of these"  # of the command line
    ms: Annotated[float, "ms", ".1f"] = nan
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
    times: dict[str, list[Run]] = field(default_factory=dict)  # runs of the settings, by their names
    by_processor: bool = False  # whether times are processor times of a thread, as other programs disturbed the others
    ablation: list[Part] = field(default_factory=list)  # what features, kinds of shapes and lists cost or save
    single: float = nan  # pixels that float32 changes, with one sample each
    certificates: list[KindCertificates] = field(default_factory=list)  # of the hits in the picture, kind by kind
    stiff: list[Stiff] = field(default_factory=list)
    absent: str = ""  # numbers of the kinds of shapes and of the features that the scene's kernel lacks
    notes: list[str] = field(default_factory=list)  # how the scene was packed, and which features were left out
    not_measured: list[str] = field(default_factory=list)
    interrupted: str = ""  # what was being measured when the user interrupted the report, and what is missing
    other: Findings | None = None  # the report to compare with

    @property
    def title(self) -> str:
        return f"{self.subject.scene}: error against run time"

    @property
    def size(self) -> str:
        return f"{self.subject.width}x{self.subject.height}"

    @property
    def clock(self) -> str:
        """Words that follow a time in a sentence, and say how it was measured."""
        of_threads = f"of processor time of each of {counted(self.subject.threads, 'thread')}"
        return f"{of_threads}, as other programs disturbed the wall times" if self.by_processor else "a picture"

    def settle_times(self) -> None:
        """Give each row its time: wall time, or processor time of a thread where other programs disturbed a row of this
        report or of the one to compare with."""
        both = [self, self.other] if self.other else [self]
        rows = [(each, row, each.times[row.name]) for each in both for row in each.pictures if row.name in each.times]
        is_disturbed = any(mostly_disturbed(runs, each.subject.threads) for each, _, runs in rows)
        for each, row, runs in rows:
            each.by_processor = is_disturbed
            timed = row.with_times(runs, each.subject.threads, is_disturbed)
            each.pictures[each.pictures.index(row)] = timed

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
        by_samples = fit(-np.log([row.samples for row in rows]), errors)
        by_time = fit(-np.log([row.ms for row in rows]), errors)
        return Order(rows[0].knob, len(rows), *by_samples[:3], *by_time[:3], exp(by_samples[3]))

    @property
    def choices(self) -> list[Recommendation]:
        """The best setting for each target error, of those that the command line has.

        Candidates reach the error in at most `SLACK` times the least time. The best is the first of them, and so the
        simplest, that usually takes at most `HARDLY` times as long as any other. What is usual follows from numbers of
        samples, which are the same in every run: so noise in the times does not change it, and two reports of a scene
        say the same.
        """
        found = []
        for most in ERRORS:
            rows = [row for row in self.pictures if row.options and row.rmse_high <= most and isfinite(row.ms)]
            least = min((row.ms for row in rows), default=nan)
            near = [(row, USUAL.get(row.knob, 1.0) * row.samples) for row in rows if row.ms <= SLACK * least]
            least_work = min((work for _, work in near), default=nan)
            best = next((row for row, work in near if work <= HARDLY * least_work), None)
            others = [row.name for row in rows if best and row != best and row.ms <= MARGIN * best.ms]
            equal = "".join(others[:1]) + (f", {len(others) - 1} more" if len(others) > 1 else "")
            told = (best.options, best.ms, best.rmse, equal, best) if best else ()
            found.append(Recommendation(f"{most:g}", *told))
        return found

    @property
    def recommended(self) -> list[Row]:
        """The rows that are the best for some goal."""
        return list(dict.fromkeys(choice.best for choice in self.choices if choice.best))

    @property
    def closest(self) -> Row | None:
        """The row with the least error of those that the command line has; None where nothing was measured."""
        rows = (row for row in self.pictures if row.options and isfinite(row.ms))
        return min(rows, key=lambda row: row.rmse, default=None)

    @property
    def of_equal_time(self) -> list[Row]:
        """The row of each line that takes about as long as the best setting for an error of one level, the most exact
        one first; as long as the most exact setting, if none reaches that error."""
        best = self.choices[ERRORS.index(LEVEL)].best or self.closest
        rows = [row for row in distinct(self.pictures) if best and isfinite(row.ms)]
        ratios = {row: abs(log(row.ms / best.ms)) for row in rows if best}
        near = [row for row, ratio in ratios.items() if ratio < log(NEAR)]
        nearest = {row.knob: row for row in sorted(near, key=ratios.__getitem__, reverse=True)}
        return sorted(nearest.values(), key=lambda row: row.rmse)


def distinct(rows: Iterable[Row]) -> list[Row]:
    """Return the rows without those whose picture is that of a row before, so that the error is equal to all digits."""
    found: dict[float | str, Row] = {}
    for row in rows:
        found.setdefault(row.rmse if isfinite(row.rmse) else row.name, row)
    return list(found.values())


def subject(scene: Scene, name: str, right: ReferencePicture, threads: int, seed: int) -> Subject:
    """Describe a scene, its pictures and this machine."""
    digest = hashlib.sha256(dump(scene).encode()).hexdigest()
    versions = {"minirt": minirt.__version__, "python": platform.python_version()}
    versions |= {package: version(package) for package in ("numpy", "numba", "llvmlite", "pillow")}
    processor = cpu_information("model name") or platform.processor()  # the former on Linux
    crops, pixels = right.crops, right.picture.shape[0] * right.picture.shape[1]
    return Subject(name, digest, crops.width, crops.height, pixels, threads, seed, processor, versions)
