"""Diagram of error against run time, by matplotlib: a line for each render option."""

from __future__ import annotations

from io import StringIO
from itertools import cycle
from math import isfinite
from typing import TYPE_CHECKING, Any

from minirt.errors import RenderError
from minirt.report.findings import Findings
from minirt.report.pictures import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDE, NARROW = (7.6, 6.2), (3.9, 6.6)  # inches, of 100 pixels each
COLOURS = ["#c2264a", "#3f7fb5", "#4f9440", "#b3700d", "#8563b8", "#128a92", "#b34da1", "#76818d", "#9a6238", "#6375d6"]
MARKS = "osD^pv"
INK, MUTED, PAPER, BAND = "#222831", "#5d6672", "#ffffff", "#e4e6ea"
ON_PAGE = {INK: "var(--ink)", MUTED: "var(--muted)", PAPER: "var(--paper)", BAND: "var(--band)"}  # light or dark
STYLE = {
    "svg.hashsalt": "minirt",  # which makes the same identifiers in each run
    "svg.fonttype": "none",
    "font.size": 9.5,
    "font.sans-serif": ["system-ui", "Segoe UI", "Roboto", "DejaVu Sans"],
    **dict.fromkeys(("text.color", "axes.labelcolor"), INK),
    **dict.fromkeys(("xtick.color", "ytick.color", "axes.edgecolor", "grid.color"), MUTED),
    **dict.fromkeys(("figure.facecolor", "axes.facecolor"), PAPER),
}
NEAR = 3.0  # the axis reaches a floor unless it lies below all errors by more than this factor
BESIDE: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small"}  # of labels
LEAST_RANGE, MANY = 6.0, 200.0  # least ratio of the ends of an axis; beyond `MANY` only powers of ten have labels


def require_packages() -> None:
    """Import what draws and writes, which takes most of a second, so that the end of an interrupted report need not
    wait for it. RenderError, which tells how to install it, if something is missing."""
    try:
        import jinja2  # noqa: F401
        import matplotlib.backends.backend_svg
        import matplotlib.ticker  # noqa: F401
    except ImportError:
        message = "--report draws with matplotlib and writes with jinja2: install them (pip install 'minirt[report]')"
        raise RenderError(message) from None


def draw(found: Findings, size: tuple[float, float]) -> str:
    """Return the diagram, of this size in inches, as the text of an SVG file; lines of the report to compare with are
    dashed."""
    import matplotlib
    from matplotlib.figure import Figure

    lines, before = lines_of(found), lines_of(found.other)
    styles = dict(zip(lines | before, zip(cycle(COLOURS), cycle(MARKS)), strict=False))
    with matplotlib.rc_context(STYLE):
        figure = Figure(size, dpi=100, layout="constrained")
        axes = figure.add_subplot(xscale="log", yscale="log")
        clock = "milliseconds of processor time of a thread" if found.by_processor else "milliseconds"
        axes.set(xlabel="error: RMSE, 1 from black to white", ylabel=f"{clock} per picture")
        if found.recommended:
            best = places(sorted(found.recommended, key=lambda row: row.rmse))
            ring: dict[str, Any] = {"markersize": 12, "markerfacecolor": "none", "markeredgecolor": INK}
            axes.plot(*best, "o-", color=BAND, linewidth=9, **ring, label="recommended", zorder=1)
        for name, rows in before.items():
            colour, mark = styles[name]
            label = "before" if name == next(iter(before)) else None
            dashed: dict[str, Any] = {"linestyle": "--", "markersize": 4, "markerfacecolor": PAPER}
            axes.plot(*places(rows), mark, color=colour, label=label, **dashed)
        for name, rows in lines.items():
            draw_line(axes, name, rows, *styles[name])
        draw_floors(axes, found, min((row.rmse for rows in lines.values() for row in rows), default=1.0))
        scale(axes)
        if lines:
            figure.legend(loc="outside lower left", ncols=2 if size == NARROW else 5, frameon=False, fontsize="small")
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Title": found.title})
    return text.getvalue()


def lines_of(found: Findings | None) -> dict[str, list[Row]]:
    """Return the points of each line of a report, none without a report."""
    lines: dict[str, list[Row]] = {}
    for row in found.pictures if found else ():
        if isfinite(row.rmse) and isfinite(row.ms):
            lines.setdefault(row.knob, []).append(row)
    return lines


def on_page(svg: str) -> str:
    """Return the element of an SVG file, whose colours follow those of the page that it is put into."""
    for colour, variable in ON_PAGE.items():
        svg = svg.replace(colour, variable)
    return svg[svg.index("<svg") :].replace("<svg", '<svg class="diagram" role="img"', 1)


def places(rows: list[Row]) -> tuple[list[float], list[float]]:
    """Return the errors and the times of some rows."""
    return [row.rmse for row in rows], [row.ms for row in rows]


def draw_line(axes: Axes, name: str, rows: list[Row], colour: str, mark: str) -> None:
    """Draw the points of a render option with their confidence intervals, and the number of samples at each."""
    x, y = places(rows)
    axes.plot(x, y, marker=mark, markersize=5.5, label=name, color=colour, linewidth=1.6)
    bars: dict[str, Any] = {"colors": colour, "linewidth": 1, "alpha": 0.75}
    axes.hlines(y, [row.rmse_low for row in rows], [row.rmse_high for row in rows], **bars)
    axes.vlines(x, [row.ms_low for row in rows], [row.ms_high for row in rows], **bars)
    for row in rows:
        axes.annotate(row.label, (row.rmse, row.ms), (5, 4), color=colour, **BESIDE)


def draw_floors(axes: Axes, found: Findings, least: float) -> None:
    """Draw the errors below which the diagram says nothing as dashed lines, those that are near to `least`."""
    floors = {"rounding to 8 bits": found.eight_bits, "error of the reference": found.reference_error}
    for name, error in floors.items():
        if error * NEAR >= least:
            axes.axvline(error, color=MUTED, linestyle="--", linewidth=1, zorder=0)
            place: dict[str, Any] = {"xycoords": axes.get_xaxis_transform(), "rotation": 90, "ha": "right", "va": "top"}
            axes.annotate(f"{name}: {error:.2g}", (error, 0.98), (-2, 0), color=MUTED, **place, **BESIDE)


def scale(axes: Axes) -> None:
    """Widen both axes to at least `LEAST_RANGE`, and label 1, 2 and 5 times each power of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.margins(0.08)
    axes.autoscale_view()
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        widening = max(1.0, LEAST_RANGE * low / high) ** 0.5
        axis.set_view_interval(low / widening, high * widening, ignore=True)
        axis.set_major_locator(LogLocator(subs=(1.0,) if high / low > MANY else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.3)
