"""Section of the report about the formulas of shapes."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan

from minirt.report.measurements.formula_errors import Row
from minirt.report.measurements.regimes import REGIMES
from minirt.report.output.blocks import Block, Bullets, Heading, Table, Text


def formula_section(rows: list[Row]) -> Iterator[Block]:
    """Yield the table of formulas: a line for each shape type and regime, a column for each formula."""
    names = list(dict.fromkeys(row.formula for row in rows))
    groups: dict[tuple[str, str], dict[str, Row]] = {}
    for row in rows:
        groups.setdefault((row.kind, row.regime), {})[row.formula] = row
    yield Heading("Formulas")
    yield Text(
        "Each cell gives the relative error of the hit distance against 60-digit arithmetic, as maximum (and root mean "
        "square); false misses/false hits; and nanoseconds per ray on one thread, with * if other programs disturbed "
        "the measurement. A hit or miss counts as false if a shape thicker and a shape thinner by 64 unit roundoffs "
        "both give the opposite; for a square and a disc the 64 roundoffs are divided by the slope of the ray. "
        "The cost is the processor time of the first formula divided by that of the textbook formula, the median of "
        "alternating runs. A packet in which a ray starts just above or below a sphere, relative to its size, is "
        "computed with twice the digits and takes several times as long; other packets are not affected."
    )
    cells = []
    for (kind, regime), found in groups.items():
        figures = (figures_text(found[name]) if name in found else "-" for name in names)
        cells.append([kind, regime, *figures, cost_text(found[names[0]])])
    yield Table(["shape", "rays", *names, "cost"], [False] * (len(names) + 2) + [True], cells)
    yield Bullets([f"{each.name}: {each.about}" for each in REGIMES])


def figures_text(row: Row) -> str:
    """Format the errors and the time of a formula in a regime."""
    errors = f"{row.max_error:.0e} ({row.rms_error:.0e})" if row.hits else "no hit"
    return f"{errors}, {row.false_misses}/{row.false_hits}, {row.ns_ray:.2f} ns{'' if row.valid else ' *'}"


def cost_text(row: Row) -> str:
    """Format the cost of a formula relative to the textbook's."""
    return "-" if isnan(row.times_textbook) else f"{row.times_textbook:.2f}"
