"""Measure accuracy and cost of the intersection formulas, for one shape type and one regime at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal, localcontext
from functools import partial
from math import ceil, inf, isfinite, nan, sqrt
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from minirt.helpers.system import Run, in_turn, is_disturbed
from minirt.kernel.compiler.jit_formula import probe
from minirt.kernel.scene_arrays import row_type
from minirt.rendering.packing.generic_kernels import rows_relative_to
from minirt.rendering.packing.shape_arrays import defining_points, packed_rows
from minirt.report.measurements import exact_hits, textbook
from minirt.report.measurements.random_rays import Array, Rays
from minirt.report.measurements.sizes import sizes
from minirt.shapes import Kind, Shape
from minirt.shapes.disc import Disc
from minirt.shapes.square import Square

U = 2.0**-53
SLACK = 64 * U  # of distance and size: so close to the boundary both hit and miss are right
ELSEWHERE = 1e-5  # of t, for two different hits; even along a round surface SLACK moves a hit by about its root, 1e-7
TIMED = 100_000  # rays per run
RUNS = 15


class Row(NamedTuple):
    """Accuracy and cost of one formula in one regime."""

    kind: str
    regime: str
    formula: str
    rays: int
    hits: int  # hits that count for the errors
    max_error: float  # relative error of t; NaN without hits
    rms_error: float
    false_misses: int
    false_hits: int
    ns_ray: float  # nanoseconds per ray on one thread
    cpu_ns_ray: float
    times_textbook: float  # processor time / that of the textbook formula; NaN if there is none
    valid: bool  # False: other programs disturbed the time


class Answers(NamedTuple):
    """Exact t of each ray, infinity for a miss: for the shape, and for one thicker and one thinner by SLACK."""

    t: list[Decimal]
    thicker: list[Decimal]
    thinner: list[Decimal]


def measure_formulas(kind: Kind, regime: str, rays: Rays) -> Iterator[Row]:
    """Measure all formulas on the rays of a regime; the number of rays per shape must be a multiple of 32."""
    right = exact_answers(rays)
    names, *parts = zip(*formulas(kind), strict=True)
    works = [prepare(formula, rays, kind, number) for formula, number in zip(*parts, strict=True)]
    count = len(works[0][1])
    often = ceil(TIMED / count)
    for shoot, _ in works:
        shoot(1)
    times = dict(zip(names, in_turn([partial(shoot, often) for shoot, _ in works], RUNS), strict=True))
    for name, (_, found) in zip(names, works, strict=True):
        best = min(times[name])
        yield Row(
            kind.element.title,
            regime,
            name,
            count,
            *compare(found.astype(np.float64), right),
            best.wall * 1e9 / (often * count),
            best.cpu * 1e9 / (often * count),
            time_ratio(times[name], times.get("textbook", ())),
            not is_disturbed(best, 1),
        )


def time_ratio(some: Sequence[Run], others: Sequence[Run]) -> float:
    """Return the median ratio of processor times of runs made in the same turn; NaN without others."""
    return median(one.cpu / other.cpu for one, other in zip(some, others, strict=True)) if others else nan


def formulas(kind: Kind) -> Iterator[tuple[str, Callable[..., Any], type[np.floating[Any]]]]:
    """Yield the formulas to compare: name, function and precision."""
    yield "miniRT", kind.intersect, np.float64
    if kind.element in textbook.FORMULAS:
        yield "textbook", textbook.FORMULAS[kind.element], np.float64
    yield "miniRT, float32", kind.intersect, np.float32


def prepare(
    formula: Callable[..., Any], rays: Rays, kind: Kind, number: type[np.floating[Any]]
) -> tuple[Callable[[int], None], np.ndarray]:
    """Return a function that computes all distances so many times, and the array that it writes them to.

    In float32 coordinates are relative to the first origin of each shape, as the renderer's are relative to the eye.
    """
    packed = np.ascontiguousarray(packed_rows([shape.pack() for shape in rays.shapes])).view(row_type(kind))[:, 0]
    origins = rays.origins
    if number is np.float32:
        eyes = rays.origins[:, 0]
        packed, origins = rows_relative_to(packed, eyes), rays.origins - eyes[:, None]
    found = np.empty(rays.origins.shape[0] * rays.origins.shape[1], number)
    o, d = (np.ascontiguousarray(each.reshape(-1, 3).T.astype(number)) for each in (origins, rays.directions))
    run = probe(formula)
    return lambda times: run(packed, rays.origins.shape[1], o, d, found, times), found


def exact_answers(rays: Rays) -> Answers:
    """Compute the exact answers of all rays."""
    found = Answers([], [], [])
    for shape, origins, directions in zip(*rays, strict=True):
        for origin, direction in zip(origins, directions, strict=True):
            t = exact_hits.distance(shape, origin, direction)
            slack = SLACK * (magnitude(shape, origin) + (float(t) if t.is_finite() else 0.0)) / slope(shape, direction)
            found.t.append(t)
            found.thicker.append(exact_hits.distance(shape, origin, direction, slack))
            found.thinner.append(exact_hits.distance(shape, origin, direction, -slack))
    return found


def magnitude(shape: Shape, origin: Array) -> float:
    """Return the magnitude of the numbers that a hit is computed from: distance to the shape plus its lengths."""
    return float(np.linalg.norm(origin - defining_points(shape)[0])) + float(sizes([shape]).sum())


def slope(shape: Shape, direction: Array) -> float:
    """Return the sine of the angle between a ray and a square or a disc; 1 for other shapes.

    The hit on a flat shape is known up to roundings divided by this; edges of other shapes are met from all sides.
    """
    return max(abs(float(np.dot(shape.normal, direction))), U) if isinstance(shape, (Square, Disc)) else 1.0


def compare(found: Array, right: Answers) -> tuple[int, float, float, int, int]:
    """Return hits, maximum and root mean square of the relative errors of t, false misses and false hits.

    Only rays count for which the thicker and the thinner shape agree on hit or miss. If they agree on a hit but in
    different places, since a ray meets an edge of one and passes that of the other, both places are right.
    """
    errors: list[float] = []
    misses = hits = 0
    with localcontext(exact_hits.DIGITS):
        for t, exactly, thicker, thinner in zip(found.tolist(), *right, strict=True):
            hit = isfinite(t)
            if thicker.is_finite() != thinner.is_finite():
                continue
            misses += not hit and thicker.is_finite()
            hits += hit and not thicker.is_finite()
            if hit and thicker.is_finite():
                near = (exactly, thicker, thinner) if abs(thicker / thinner - 1) > ELSEWHERE else (exactly,)
                errors.append(float(min(abs(Decimal(t) / each - 1) for each in near)))
    if not errors:
        return 0, nan, nan, misses, hits
    return len(errors), max(errors, default=inf), sqrt(sum(e * e for e in errors) / len(errors)), misses, hits
