"""How precise and how fast the formulas of shapes are, one kind and one regime at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal, localcontext
from functools import partial
from math import ceil, inf, isfinite, nan, sqrt
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.compiler.jit_formula import probe
from minirt.kernel.rows import row_type
from minirt.rendering.packing.primitives import defining_points, packed_rows
from minirt.rendering.packing.single_precision import rows_relative_to
from minirt.report.measurements import exact_hits, textbook
from minirt.report.measurements.random_rays import Array, Rays
from minirt.report.measurements.sizes import sizes
from minirt.shapes import Kind, Shape
from minirt.shapes.disc import Disc
from minirt.shapes.square import Square
from minirt.timing import Run, in_turn, is_disturbed

U = 2.0**-53
SLACK = 64 * U  # of distance and size: a verdict so close to the boundary may be either
ELSEWHERE = 1e-5  # of t; even along a round surface the slack changes no more than about its root, 1e-7
TIMED = 100_000  # rays of a run
RUNS = 15


class Row(NamedTuple):
    """A formula in a regime."""

    kind: str
    regime: str
    formula: str
    rays: int
    hits: int  # that count for the errors
    max_error: float  # of t, relative; NaN where nothing is hit
    rms_error: float
    false_misses: int
    false_hits: int
    ns_ray: float  # of one thread
    cpu_ns_ray: float
    times_textbook: float  # the processor time in that of the textbook's formula; NaN where that is none
    valid: bool  # False: other programs disturbed the measurement of time


class Answers(NamedTuple):
    """t for each ray: of the shape, and of one thicker and one thinner by the slack. Infinity where it misses."""

    t: list[Decimal]
    thicker: list[Decimal]
    thinner: list[Decimal]


def measured(kind: Kind, regime: str, rays: Rays) -> Iterator[Row]:
    """The rows of all formulas for the rays of a regime; the number of rays for a shape is a multiple of 32."""
    right = answers(rays)
    names, *parts = zip(*formulas(kind), strict=True)
    works = [prepared(formula, rays, kind, number) for formula, number in zip(*parts, strict=True)]
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
            *verdicts(found.astype(np.float64), right),
            best.wall * 1e9 / (often * count),
            best.cpu * 1e9 / (often * count),
            times_as_long(times[name], times.get("textbook", ())),
            not is_disturbed(best, 1),
        )


def times_as_long(some: Sequence[Run], others: Sequence[Run]) -> float:
    """The median of the processor time of one run in that of another of the same turn; NaN for none."""
    return median(one.cpu / other.cpu for one, other in zip(some, others, strict=True)) if others else nan


def formulas(kind: Kind) -> Iterator[tuple[str, Callable[..., Any], type[np.floating[Any]]]]:
    """What is compared: name, formula, and the precision in which it is computed."""
    yield "miniRT", kind.intersect, np.float64
    if kind.element in textbook.FORMULAS:
        yield "textbook", textbook.FORMULAS[kind.element], np.float64
    yield "miniRT, float32", kind.intersect, np.float32


def prepared(
    formula: Callable[..., Any], rays: Rays, kind: Kind, number: type[np.floating[Any]]
) -> tuple[Callable[[int], None], np.ndarray]:
    """What computes all distances so many times, and where it puts them. float32 is relative to the first origin of
    each shape, as the renderer has it relative to the eye."""
    packed = np.ascontiguousarray(packed_rows([shape.pack() for shape in rays.shapes])).view(row_type(kind))[:, 0]
    origins = rays.origins
    if number is np.float32:
        eyes = rays.origins[:, 0]
        packed, origins = rows_relative_to(packed, eyes), rays.origins - eyes[:, None]
    found = np.empty(rays.origins.shape[0] * rays.origins.shape[1], number)
    o, d = (np.ascontiguousarray(each.reshape(-1, 3).T.astype(number)) for each in (origins, rays.directions))
    run = probe(formula)
    return lambda times: run(packed, rays.origins.shape[1], o, d, found, times), found


def answers(rays: Rays) -> Answers:
    """The right ones."""
    found = Answers([], [], [])
    for shape, origins, directions in zip(*rays, strict=True):
        for origin, direction in zip(origins, directions, strict=True):
            t = exact_hits.distance(shape, origin, direction)
            slack = SLACK * (reach(shape, origin) + (float(t) if t.is_finite() else 0.0)) / slope(shape, direction)
            found.t.append(t)
            found.thicker.append(exact_hits.distance(shape, origin, direction, slack))
            found.thinner.append(exact_hits.distance(shape, origin, direction, -slack))
    return found


def reach(shape: Shape, origin: Array) -> float:
    """How large the numbers are that a hit is computed from: the way to the shape and its lengths."""
    return float(np.linalg.norm(origin - defining_points(shape)[0])) + float(sizes([shape]).sum())


def slope(shape: Shape, direction: Array) -> float:
    """The sine of the angle of a ray to a square or a disc: where it meets that is known to roundings by this. Of
    others the edges are met from all sides: 1."""
    return max(abs(float(np.dot(shape.normal, direction))), U) if isinstance(shape, (Square, Disc)) else 1.0


def verdicts(found: Array, right: Answers) -> tuple[int, float, float, int, int]:
    """Hits, largest and root mean square of the relative errors of t, false misses and false hits.

    Counted are rays about which the thicker and the thinner shape agree. Where one has them meet an edge and the other
    has them pass it, and meet the shape elsewhere behind, either may be met.
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
