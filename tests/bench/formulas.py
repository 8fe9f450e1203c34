"""Benchmark of the exact intersection formulas against textbook formulas."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from minirt.report.measurements import formula_errors, textbook
from minirt.report.measurements.formula_errors import Row
from minirt.report.measurements.regimes import REGIMES
from minirt.shapes import KINDS
from tests.bench.table import MARK, aligned, times

REGIME = next(each for each in REGIMES if each.name == "benign")  # rays that are easy for both formulas
SHAPES, RAYS, SEED = 6, 32, 1  # shapes of each type, rays per shape
UNIT = "ns a ray"
MEANING = (
    f"{UNIT}: nanoseconds on one thread, the best of {formula_errors.RUNS} runs; rays start {REGIME.about} from\n"
    "the shape; the ratio is of processor times, the median of alternating runs."
)


def measured() -> Iterator[Row]:
    """Measure both formulas of each shape type that has a textbook formula."""
    for kind in KINDS:
        if kind.element in textbook.FORMULAS:
            print(f"formula of the {kind.element.title}", file=sys.stderr, flush=True)
            rays = REGIME.pose(kind, np.random.default_rng(SEED), SHAPES, RAYS)
            yield from (
                row
                for row in formula_errors.measure_formulas(kind, REGIME.name, rays)
                if row.formula in ("miniRT", "textbook")
            )


def table(rows: Sequence[Row]) -> str:
    """Return a table: nanoseconds per ray of the exact and the textbook formula of each shape type, and the ratio."""
    found = {(row.kind, row.formula): row for row in rows}
    lines = [[UNIT, "textbook", "miniRT"]]
    for kind in dict.fromkeys(row.kind for row in rows):
        own, other = found[kind, "miniRT"], found[kind, "textbook"]
        lines.append([kind, cell(other, 1.0), cell(own, own.times_textbook)])
    return aligned(lines)


def cell(row: Row, ratio: float) -> str:
    """Format a time, marked if other programs disturbed it, and its ratio to the textbook formula's."""
    return f"{row.ns_ray:.2f}{' ' if row.valid else MARK} {times(ratio):>5}"


def records(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the table for a JSON file."""
    return [
        {
            "kind": row.kind,
            "formula": row.formula,
            "ns a ray": round(row.ns_ray, 3),
            "times textbook": round(row.times_textbook, 3),
            "disturbed": not row.valid,
        }
        for row in rows
    ]
