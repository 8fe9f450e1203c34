"""Conclusions from the measurements: orders of convergence, the Pareto front and the best settings, as plain data."""

from __future__ import annotations

import csv
import hashlib
import json
import platform
from collections.abc import Iterable, Iterator, Sequence
from importlib.metadata import PackageNotFoundError, version
from io import StringIO
from math import exp, isfinite, nan, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import minirt
from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.metrics import Line, fit
from minirt.report.pictures import DISTURBED_BY_OTHERS, OURS, Row
from minirt.report.precision import KindCertificates, SingleError
from minirt.scene import Scene, dump

PACKAGES = ("numpy", "numba", "llvmlite", "pillow")
LEAST = 3  # points of a line
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

    knob: str
    points: int  # that were fitted; others are as small as the error of the reference
    by_samples: float = nan  # 0.5 for random samples; NaN where a line has no numbers of samples
    by_samples_low: float = nan  # 95 % confidence interval, Student's t
    by_samples_high: float = nan
    by_time: float = nan
    by_time_low: float = nan
    by_time_high: float = nan
    constant: float = nan  # RMSE at one sample by the fit


class Findings(NamedTuple):
    """All results of the measurements."""

    subject: Subject
    reference_samples: int
    reference_error: float  # RMSE of the reference itself
    eight_bits: float  # RMSE that rounding to 8 bits per channel adds: no picture in such a file can be closer
    pictures: list[Row]
    orders: list[Order]  # of each line of the diagram
    ablation: list[Part]  # what features, kinds of shapes and lists cost or save
    single: list[SingleError]  # errors of float32, feature by feature
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


def processor() -> str:
    """Return the name of the processor: from /proc/cpuinfo on Linux, from `platform` elsewhere."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(": ")[1] for line in lines if line.startswith("model name")), platform.processor())


def versions() -> dict[str, str]:
    """Return the versions of miniRT, of Python and of the packages that compute or draw."""
    found = {"minirt": minirt.__version__, "python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found


def orders(rows: Iterable[Row], reference_error: float) -> Iterator[Order]:
    """Fit the order of convergence of each line with at least three points whose error the reference can tell.

    The error of the reference itself, which adds to each squared error, is taken off first.
    """
    groups: dict[str, list[Row]] = {}
    for row in rows:
        if row.rmse > CLEAR * reference_error:
            groups.setdefault(row.knob, []).append(row)
    for knob, points in groups.items():
        errors = np.log([sqrt(row.rmse**2 - reference_error**2) for row in points])
        samples, times = np.log([row.samples for row in points]), np.log([row.wall_ms for row in points])
        timed = [row.valid for row in points]
        by_samples, by_time = line(samples, errors), line(times[timed], errors[timed])
        if by_samples or by_time:
            constant = exp(by_samples.intercept) if by_samples else nan
            yield Order(knob, len(points), *falling(by_samples), *falling(by_time), constant)


def line(x: np.ndarray, y: np.ndarray) -> Line | None:
    """Fit a line to points of which at least three have finite and different x; None if there are fewer."""
    known = np.isfinite(x)
    return fit(x[known], y[known]) if len(np.unique(x[known])) >= LEAST else None


def falling(found: Line | None) -> tuple[float, float, float]:
    """Return the order of a line, which is its slope downwards, and the interval of the order."""
    return (-found.slope, -found.interval.high, -found.interval.low) if found else (nan, nan, nan)


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


def choices(rows: list[Row], doubt: float) -> list[dict[str, Any]]:
    """Find the best setting for each target error and each target time; None if no setting reaches it.

    Errors are known up to `doubt`. "disturbed" counts the rows that were left out since their times were disturbed.
    """
    by_error, by_time = pareto_front(rows, 0.0), pareto_front(rows, doubt)
    best = {f"error at most {error:g}": next((row for row in by_error if row.rmse <= error), None) for error in ERRORS}
    for time in TIMES:
        best[f"at most {time:g} ms"] = next((row for row in reversed(by_time) if row.wall_ms <= time), None)
    disturbed = sum(row.remark == DISTURBED_BY_OTHERS for row in rows if row.program == OURS)
    return [{"wanted": wanted, "best": row, "disturbed": disturbed} for wanted, row in best.items()]


def title(found: Findings) -> str:
    """Return the title of the report."""
    return f"{found.subject.scene}: error against run time"


def recommended(found: Findings) -> list[Row]:
    """Return the rows that are the best for some wanted error or time."""
    best = (choice["best"] for choice in choices(found.pictures, found.reference_error))
    return list(dict.fromkeys(row for row in best if row is not None))


def as_csv(rows: Sequence[Any]) -> str:
    """Return NamedTuples of one type as CSV: a line of field names, then a line for each."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows[0]._fields if rows else ())
    writer.writerows(rows)
    return text.getvalue()


def as_json(found: Findings) -> str:
    """Return the findings and the choices as JSON, with null for NaN and infinity."""
    everything = found._asdict() | {"choices": choices(found.pictures, found.reference_error)}
    return json.dumps(json_value(everything), indent=1, allow_nan=False) + "\n"


def json_value(value: Any) -> Any:
    """Convert a value to types that JSON has: NamedTuples become objects."""
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return json_value(value._asdict())
    if isinstance(value, dict):
        return {key: json_value(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_value(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value
