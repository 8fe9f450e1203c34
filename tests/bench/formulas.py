"""Times of the exact formulas of shapes beside those of textbooks."""

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

REGIME = next(each for each in REGIMES if each.name == "benign")  # rays that neither formula finds hard
SHAPES, RAYS, SEED = 6, 32, 1  # of each kind; of each shape
UNIT = "ns a ray"
MEANING = (
    f"{UNIT}: nanoseconds of one thread, the best of {formula_errors.RUNS} runs, of rays that start {REGIME.about} from the\n"
    "shape; the ratio is of processor times, the median of runs in turn."
)


def measured() -> Iterator[Row]:
    """The rows of the exact formula and of the textbook's, of each kind that textbooks have one for."""
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
    """A line for each kind: nanoseconds a ray of the exact formula and of the textbook's, and the ratio."""
    found = {(row.kind, row.formula): row for row in rows}
    lines = [[UNIT, "textbook", "miniRT"]]
    for kind in dict.fromkeys(row.kind for row in rows):
        own, other = found[kind, "miniRT"], found[kind, "textbook"]
        lines.append([kind, cell(other, 1.0), cell(own, own.times_textbook)])
    return aligned(lines)


def cell(row: Row, ratio: float) -> str:
    """A time, marked where other programs disturbed it, and its ratio to the textbook's."""
    return f"{row.ns_ray:.2f}{' ' if row.valid else MARK} {times(ratio):>5}"


def records(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The same for a JSON file."""
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
