"""Work-precision diagram: error against run time (drawn by matplotlib, which the extra `report` installs)."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from math import isfinite

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from minirt.report.measurements.pareto import pareto_front
from minirt.report.measurements.picture_errors import Row

STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False}
COLOURS = ("#d1495b", "#30638e", "#edae49", "#7a8b99", "#5b8c5a", "#8e5b8c")
MARKS = "osD^vP"


def diagram(rows: Iterable[Row], reference_error: float, title: str) -> bytes:
    """Draw a PNG: a line for each knob, a point for each number of samples, hollow if its time was disturbed.

    The grey line is the Pareto front. `reference_error` is the RMSE of the reference itself.
    """
    rows = list(rows)
    knobs = list(dict.fromkeys(row.knob for row in rows))
    with rc_context(STYLE):
        canvas = Figure(figsize=(9, 5.2), layout="constrained")
        panel = canvas.add_subplot(xscale="log", yscale="log", title=title)
        best = pareto_front([row for row in rows if row.valid], reference_error)
        panel.plot([row.rmse for row in best], [row.wall_ms for row in best], color="#cccccc", linewidth=7, zorder=0)
        for knob, colour, mark in zip(knobs, COLOURS, MARKS, strict=False):
            draw_setting(panel, [row for row in rows if row.knob == knob], colour, mark)
        low, high = panel.get_xlim()
        if low < reference_error < high:
            panel.axvline(reference_error, color="#999999", linestyle="--", linewidth=1, label="error of the reference")
        elif reference_error > 0:
            panel.plot([], [], " ", label=f"error of the reference: {reference_error:.1g}")
        panel.set(xlabel="error: RMSE of colours, 1 from black to white", ylabel="milliseconds per picture")
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
            axis.set_minor_locator(NullLocator())
        panel.grid(alpha=0.3)
        panel.legend(frameon=False)
        data = BytesIO()
        canvas.savefig(data, format="png", dpi=130)
    return data.getvalue()


def draw_setting(panel: Axes, rows: list[Row], colour: str, mark: str) -> None:
    """Draw the points of one knob, joined by a line and labelled with their numbers of samples."""
    errors, times = [row.rmse for row in rows], [row.wall_ms for row in rows]
    panel.plot(errors, times, color=colour, marker=mark, label=rows[0].knob)
    for row in rows:
        if not row.valid:
            panel.plot(row.rmse, row.wall_ms, mark, color=colour, markerfacecolor="white")
        if isfinite(row.rmse):
            panel.annotate(
                row.label, (row.rmse, row.wall_ms), (5, 5), textcoords="offset points", color=colour, fontsize=9
            )
