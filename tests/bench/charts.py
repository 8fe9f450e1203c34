"""Pictures of what was measured (matplotlib)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib import pyplot, rcParams
from matplotlib.ticker import NullLocator, StrMethodFormatter

from tests.bench.measure import Cells
from tests.bench.table import figure

COLOURS = {"miniRT double": "#d1495b", "miniRT single": "#edae49", "C++ yardstick": "#7a8b99"}
OTHERS = "#30638e"
ROOT_FROM = 100  # spheres, where the line of comparison begins
STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "minirt"}


def bars(cells: Cells, path: Path) -> None:
    """A panel for each scene with a bar for each system; the axis is logarithmic."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    canvas, panels = pyplot.subplots(1, len(scenes), sharey=True, figsize=(9, 0.9 + 0.38 * len(systems)), squeeze=False)
    longest = max(cell.ms for cell in cells.values())
    for panel, scene in zip(panels[0], scenes, strict=True):
        values = [cells[system, scene].ms for system in systems]
        panel.barh(systems, values, color=[COLOURS.get(system, OTHERS) for system in systems], height=0.7)
        for row, value in enumerate(values):
            panel.text(value * 1.12, row, figure(value), va="center")
        panel.set(xscale="log", xlim=(0.3, longest * 4), title=scene)
        panel.xaxis.set_major_locator(NullLocator())
        panel.xaxis.set_minor_locator(NullLocator())
        panel.spines["bottom"].set_visible(False)
        panel.tick_params(length=0)
    panels[0][0].invert_yaxis()
    canvas.supxlabel("milliseconds a frame of 1280 x 720, logarithmic", fontsize=10)
    save(canvas, path)


def growth(cells: Cells, path: Path) -> None:
    """The time of a frame over the number of spheres, and what a growth with its root would be."""
    rcParams.update(STYLE)
    systems, scenes = names(cells)
    counts = [int(scene) for scene in scenes]
    canvas, panel = pyplot.subplots(figsize=(9, 4.5))
    for system in systems:
        values = [cells[system, str(count)].ms for count in counts]
        panel.plot(counts, values, marker="o", label=system, color=COLOURS.get(system, OTHERS))
    beyond = [count for count in counts if count >= ROOT_FROM]
    base = cells[systems[0], str(beyond[0])].ms
    root = [base * (count / beyond[0]) ** 0.5 for count in beyond]
    panel.plot(beyond, root, "--", color="#999999", linewidth=1, label="growth with $\\sqrt{N}$")
    panel.set(xscale="log", yscale="log", xlabel="spheres in view, N", ylabel="milliseconds a frame")
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        axis.set_minor_locator(NullLocator())
    panel.grid(alpha=0.3)
    panel.legend(frameon=False)
    save(canvas, path)


def names(cells: Cells) -> tuple[list[str], list[str]]:
    """The systems and the scenes, in the order in which they were measured."""
    return list(dict.fromkeys(system for system, _ in cells)), list(dict.fromkeys(scene for _, scene in cells))


def save(canvas: Any, path: Path) -> None:
    canvas.tight_layout()
    canvas.savefig(path, dpi=130)
    pyplot.close(canvas)
