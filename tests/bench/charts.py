"""Charts of the benchmark (drawn by matplotlib)."""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from matplotlib import pyplot, rcParams
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from tests.bench.measure import Cells, figure

COLOURS = {"miniRT double": "#d1495b", "miniRT single": "#edae49", "C++ yardstick": "#7a8b99"}
OTHERS = "#30638e"
SCENES, MARKS = ("#d1495b", "#30638e", "#edae49", "#5b8e7d"), "osD^"  # of the dots of each scene
NEAR = 1.35  # ratio of values whose labels would overlap
CLOSE, FAR = (7, -15), (17, -25)  # heights of labels in points, above and below their dots
ROOT_FROM = 100  # spheres at which the line of comparison begins
STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "minirt"}


def dots(cells: Cells, path: Path, label: str) -> None:
    """Draw a dot plot: a row for each system, a dot for each scene that it renders, on a logarithmic axis."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    canvas, panel = pyplot.subplots(figsize=(9, 1.3 + 0.55 * len(systems)))
    for scene, colour, mark in zip(scenes, SCENES, MARKS, strict=False):
        measured = [
            (row, median(cells[system, scene])) for row, system in enumerate(systems) if (system, scene) in cells
        ]
        rows, values = zip(*measured, strict=True)
        panel.plot(values, rows, mark, color=colour, markersize=9, label=scene)
    for row, system in enumerate(systems):
        values = sorted(median(cells[system, scene]) for scene in scenes if (system, scene) in cells)
        for value, offset in zip(values, offsets(values), strict=True):
            panel.annotate(
                figure(value), (value, row), (0, offset), textcoords="offset points", ha="center", fontsize=9
            )
    panel.set_yticks(range(len(systems)), systems)
    panel.invert_yaxis()
    panel.margins(x=0.05, y=0.14)
    panel.set(xscale="log", xlabel=label)
    panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(StrMethodFormatter("{x:,g}"))
    panel.grid(alpha=0.3)
    panel.tick_params(length=0)
    panel.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, 1.14), ncols=len(scenes))
    save(canvas, path)


def offsets(values: list[float]) -> list[int]:
    """Return the heights of labels of increasing values: above and below in turn, further off where two are near."""
    heights: list[int] = []
    for number, value in enumerate(values):
        near = number >= 2 and value < NEAR * values[number - 2] and heights[number - 2] in CLOSE
        heights.append((FAR if near else CLOSE)[number % 2])
    return heights


def growth(cells: Cells, path: Path) -> None:
    """Draw the time per frame against the number of spheres, with a line of growth by its square root."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    counts = [int(scene) for scene in scenes]
    canvas, panel = pyplot.subplots(figsize=(9, 4.5))
    for system in systems:
        values = [median(cells[system, str(count)]) for count in counts]
        panel.plot(counts, values, marker="o", label=system, color=COLOURS.get(system, OTHERS))
    beyond = [count for count in counts if count >= ROOT_FROM]
    base = median(cells[systems[0], str(beyond[0])])
    root = [base * (count / beyond[0]) ** 0.5 for count in beyond]
    panel.plot(beyond, root, "--", color="#999999", linewidth=1, label="growth with $\\sqrt{N}$")
    panel.set(xscale="log", yscale="log", xlabel="spheres in view, N", ylabel="milliseconds per frame")
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        axis.set_minor_locator(NullLocator())
    panel.grid(alpha=0.3)
    panel.legend(frameon=False)
    save(canvas, path)


def names(cells: Cells) -> tuple[list[str], list[str]]:
    """Return the systems and the scenes, in the order in which they were measured."""
    return list(dict.fromkeys(system for system, _ in cells)), list(dict.fromkeys(scene for _, scene in cells))


def save(canvas: Any, path: Path) -> None:
    canvas.tight_layout()
    canvas.savefig(path, dpi=130)
    pyplot.close(canvas)
