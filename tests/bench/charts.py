"""Charts of the benchmark (drawn by matplotlib)."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path
from statistics import median
from typing import Any

from matplotlib import pyplot, rcParams
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from tests.bench.measure import Cells, figure, names

COLOURS, MARKS = ("#d1495b", "#30638e", "#edae49", "#5b8e7d", "#9a6fb0"), "osD^v"
HEIGHTS = (7, -15, 17, -25)  # of labels in points, above and below their dots in turn, so that near ones do not overlap
ROOT_FROM = 100  # spheres at which the line of comparison begins
STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "minirt"}


def dots(cells: Cells, path: Path, label: str) -> None:
    """Draw a dot plot: a row for each system, a dot for each scene that it renders, on a logarithmic axis."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    canvas, panel = pyplot.subplots(figsize=(9, 1.3 + 0.8 * len(systems)))
    for scene, colour, mark in zip(scenes, cycle(COLOURS), cycle(MARKS)):
        rows = [row for row, system in enumerate(systems) if (system, scene) in cells]
        values = [median(cells[systems[row], scene]) for row in rows]
        panel.plot(values, rows, mark, color=colour, markersize=9, label=scene)
    for row, system in enumerate(systems):
        values = sorted(median(cells[system, scene]) for scene in scenes if (system, scene) in cells)
        for value, height in zip(values, cycle(HEIGHTS)):
            place: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "fontsize": 9}
            panel.annotate(figure(value), (value, row), (0, height), **place)
    panel.set_yticks(range(len(systems)), systems)
    panel.invert_yaxis()
    panel.margins(x=0.05, y=0.14)
    panel.set(xscale="log", xlabel=label)
    panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    panel.tick_params(length=0)
    panel.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, 1.1), ncols=len(scenes))
    save(canvas, path, panel.xaxis)


def growth(cells: Cells, path: Path) -> None:
    """Draw the time per frame against the number of spheres, with a line of growth by its square root."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    counts = [int(scene) for scene in scenes]
    canvas, panel = pyplot.subplots(figsize=(9, 4.5))
    for system, colour in zip(systems, cycle(COLOURS)):
        values = [median(cells[system, str(count)]) for count in counts]
        panel.plot(counts, values, marker="o", label=system, color=colour)
    beyond = [count for count in counts if count >= ROOT_FROM]
    base = median(cells[systems[0], str(beyond[0])])
    root = [base * (count / beyond[0]) ** 0.5 for count in beyond]
    panel.plot(beyond, root, "--", color="#999999", linewidth=1, label="growth with $\\sqrt{N}$")
    panel.set(xscale="log", yscale="log", xlabel="spheres in view, N", ylabel="milliseconds per frame")
    panel.legend(frameon=False)
    save(canvas, path, panel.xaxis, panel.yaxis)


def save(canvas: Any, path: Path, *axes: Any) -> None:
    """Write a chart, whose logarithmic axes have plain numbers."""
    for axis in axes:
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(StrMethodFormatter("{x:,g}"))
        axis.axes.grid(alpha=0.3)
    canvas.tight_layout()
    canvas.savefig(path, dpi=130)
    pyplot.close(canvas)
