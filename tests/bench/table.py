"""Results of the benchmark as text and as JSON."""

from __future__ import annotations

from typing import Any

from tests.bench.measure import Cells

MARK = "*"  # marks a figure that other programs disturbed
LACKING = "-"  # for a scene that a system does not render


def figure(ms: float) -> str:
    """Format milliseconds in three significant digits, without an exponent."""
    digits = 2 if ms < 9.995 else 1 if ms < 99.95 else 0
    return f"{ms:.{digits}f}"


def times(ratio: float) -> str:
    """Format a ratio in two significant digits, without an exponent."""
    digits = 2 if ratio < 0.995 else 1 if ratio < 9.95 else 0
    return f"x{ratio:.{digits}f}"


def table(cells: Cells, systems: list[str], scenes: list[str], title: str = "ms a frame") -> str:
    """Return a table with a row per system and a column per scene; ratios are to the first row, which has all."""
    rows = [[title, *scenes]]
    rows += [[system, *(text(cells, system, scene, systems[0]) for scene in scenes)] for system in systems]
    return aligned(rows)


def text(cells: Cells, system: str, scene: str, first: str) -> str:
    """Format a figure, marked if other programs disturbed it, and its ratio to the first system's."""
    if (system, scene) not in cells:
        return LACKING
    cell = cells[system, scene]
    ratio = times(cell.ms / cells[first, scene].ms)
    return f"{figure(cell.ms)}{MARK if cell.disturbed else ' '} {ratio:>5}"


def aligned(rows: list[list[str]]) -> str:
    """Align rows of cells: the first column to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = (
        "  ".join(text.ljust(width) if i == 0 else text.rjust(width) for i, (text, width) in enumerate(cells))
        for cells in (zip(row, widths, strict=True) for row in rows)
    )
    return "\n".join(line.rstrip() for line in lines)


def records(cells: Cells) -> list[dict[str, Any]]:
    """Return the results for a JSON file."""
    return [
        {
            "system": system,
            "scene": scene,
            "ms": round(cell.ms, 3),
            "disturbed": cell.disturbed,
            "rounds": [round(each.ms, 3) for each in cell.rounds],
            "elsewhere": [round(each.elsewhere, 2) for each in cell.rounds],
            "threads": cell.threads,
        }
        for (system, scene), cell in cells.items()
    ]
