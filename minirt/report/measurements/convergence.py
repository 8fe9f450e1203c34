"""Order of convergence of each line of the diagram, with its confidence interval."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import exp, nan, sqrt
from typing import NamedTuple

import numpy as np

from minirt.report.measurements.intervals import Line, fit
from minirt.report.measurements.picture_errors import Row

LEAST = 3  # points of a line
CLEAR = 2.0  # times the error of the reference: from there on an error is known well enough


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
            yield Order(knob, len(points), *falling(by_samples), *falling(by_time), constant_of(by_samples))


def line(x: np.ndarray, y: np.ndarray) -> Line | None:
    """Fit a line to points of which at least three have finite and different x; None if there are fewer."""
    known = np.isfinite(x)
    return fit(x[known], y[known]) if len(np.unique(x[known])) >= LEAST else None


def falling(found: Line | None) -> tuple[float, float, float]:
    """Return the order of a line, which is its slope downwards, and the interval of the order."""
    return (-found.slope, -found.interval.high, -found.interval.low) if found else (nan, nan, nan)


def constant_of(found: Line | None) -> float:
    """Return the error at one sample."""
    return exp(found.intercept) if found else nan
