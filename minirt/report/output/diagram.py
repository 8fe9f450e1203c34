"""The work-precision diagram: error against run time (matplotlib, of the extra `report`)."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from math import isfinite

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from minirt.report.measurements.pareto import front
from minirt.report.measurements.picture_errors import Row

STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False}
COLOURS = ("#d1495b", "#30638e", "#edae49", "#7a8b99", "#5b8c5a", "#8e5b8c")
MARKS = "osD^vP"


def diagram(rows: Iterable[Row], reference_error: float, title: str) -> bytes:
    """A PNG with a line for each knob, a point for each number of samples. Hollow: not valid. What is best for some
    error or some time lies on the grey line."""
    rows = list(rows)
    knobs = list(dict.fromkeys(row.knob for row in rows))
    with rc_context(STYLE):
        canvas = Figure(figsize=(9, 5.2), layout="constrained")
        panel = canvas.add_subplot(xscale="log", yscale="log", title=title)
        best = front(rows, reference_error)
        panel.plot([row.rmse for row in best], [row.wall_ms for row in best], color="#cccccc", linewidth=7, zorder=0)
        for knob, colour, mark in zip(knobs, COLOURS, MARKS, strict=False):
            line(panel, [row for row in rows if row.knob == knob], colour, mark)
        if reference_error > 0:
            panel.axvline(reference_error, color="#999999", linestyle="--", linewidth=1, label="error of the reference")
        panel.set(xlabel="error: RMSE of colours, 1 from black to white", ylabel="milliseconds a picture")
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
            axis.set_minor_locator(NullLocator())
        panel.grid(alpha=0.3)
        panel.legend(frameon=False)
        data = BytesIO()
        canvas.savefig(data, format="png", dpi=130)
    return data.getvalue()


def line(panel: Axes, rows: list[Row], colour: str, mark: str) -> None:
    """The points of a knob, joined, each with its number of samples."""
    errors, times = [row.rmse for row in rows], [row.wall_ms for row in rows]
    panel.plot(errors, times, color=colour, marker=mark, label=rows[0].knob)
    for row in rows:
        if not row.valid:
            panel.plot(row.rmse, row.wall_ms, mark, color=colour, markerfacecolor="white")
        if isfinite(row.rmse):
            panel.annotate(
                str(row.samples), (row.rmse, row.wall_ms), (5, 5), textcoords="offset points", color=colour, fontsize=9
            )
