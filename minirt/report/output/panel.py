"""Contents of a work-precision diagram, and their places."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from math import isfinite
from typing import NamedTuple

from minirt.report.measurements.pareto import pareto_front
from minirt.report.measurements.picture_errors import OURS, Row
from minirt.report.output.labels import Box, Placer
from minirt.report.output.marks import RADIUS
from minirt.report.output.scales import Scale, scale_around
from minirt.report.output.svg import Point

NEAR = 3.0  # the axis reaches a floor unless it lies below all errors by more than this factor


class Size(NamedTuple):
    """Size of a diagram in pixels."""

    width: int
    height: int


class Floor(NamedTuple):
    """An error below which the diagram says nothing."""

    name: str
    error: float


class Diagram(NamedTuple):
    """Contents of a diagram."""

    title: str
    lines: dict[str, list[Row]]  # render option -> rows that did not fail
    floors: list[Floor]
    front: list[Row]  # Pareto front
    recommended: Collection[Row]


class Panel(NamedTuple):
    """The area between the axes: its scales, and the places that are taken."""

    errors: Scale
    times: Scale
    labels: Placer

    def at(self, row: Row) -> Point:
        """Return the pixel of a row."""
        return self.errors(row.rmse), self.times(row.wall_ms)


WIDE, NARROW = Size(900, 560), Size(380, 560)


def diagram_of(
    title: str, rows: Iterable[Row], reference_error: float, eight_bits: float, recommended: Collection[Row]
) -> Diagram:
    """Collect what the diagram of some rows shows."""
    lines: dict[str, list[Row]] = {}
    for row in rows:
        if isfinite(row.rmse) and isfinite(row.wall_ms):
            lines.setdefault(row.knob, []).append(row)
    ours = [row for line in lines.values() for row in line if row.valid and row.program == OURS]
    floors = [Floor("rounding to 8 bits", eight_bits), Floor("error of the reference", reference_error)]
    return Diagram(title, lines, floors, pareto_front(ours, reference_error), recommended)


def panel_for(shown: Diagram, size: Size) -> Panel:
    """Choose the scales, and take the places of all points and lines."""
    rows = [row for line in shown.lines.values() for row in line]
    least = min((row.rmse for row in rows), default=1.0)
    errors = [each for row in rows for each in (row.rmse, row.rmse_low, row.rmse_high)]
    times = [each for row in rows for each in (row.wall_ms, row.wall_low_ms, row.wall_high_ms)]
    near = [floor.error for floor in shown.floors if floor.error * NEAR >= least]
    frame = Box(50.0, 58.0, size.width - 14.0, size.height - 50.0)
    panel = Panel(
        scale_around([*near, *errors], frame.left, frame.right),
        scale_around(times, frame.bottom, frame.top),
        Placer(frame),
    )
    for line in shown.lines.values():
        panel.labels.cross([panel.at(row) for row in line])
        for row in line:
            panel.labels.take(panel.at(row), RADIUS * (2 if row in shown.recommended else 1) + 1)
            for bar in intervals(panel, row):
                panel.labels.cross(bar)
    return panel


def intervals(panel: Panel, row: Row) -> Iterator[list[Point]]:
    """Yield the ends of the bars for the confidence intervals of the error and of the time."""
    x, y = panel.at(row)
    if isfinite(row.rmse_low + row.rmse_high):
        yield [(panel.errors(row.rmse_low), y), (panel.errors(row.rmse_high), y)]
    if isfinite(row.wall_low_ms + row.wall_high_ms):
        yield [(x, panel.times(row.wall_low_ms)), (x, panel.times(row.wall_high_ms))]
