"""Labels of a work-precision diagram: names of lines, numbers of samples, floors and the key."""

from __future__ import annotations

from collections.abc import Iterator

from minirt.report.measurements.picture_errors import Row
from minirt.report.output.labels import Placed
from minirt.report.output.marks import cross, mark, ring
from minirt.report.output.panel import Floor, Panel
from minirt.report.output.svg import group, path, text

COLOURS = 10  # of the style sheet
FONT, SMALL = 13.0, 11.0  # pixels, as in the style sheet
NEAR, FAR = (6.0, 10.0), (8.0, 16.0, 26.0, 40.0, 60.0, 85.0, 120.0)  # distances of labels from points


def drawn_floor(panel: Panel, floor: Floor) -> str:
    """Draw a floor of the error as a dashed line with its name; a note at the left edge if it is far below."""
    x, is_far = panel.errors(floor.error), not panel.errors.holds(floor.error)
    words = f"{'← ' * is_far}{floor.name}: {floor.error:.2g}"
    parts = [] if is_far else [path([(x, panel.times.start), (x, panel.times.end)])]
    if placed := panel.labels.place_upright(words, SMALL, x):
        turned = f"translate({placed.box.right - 3:.1f} {placed.box.bottom:.1f}) rotate(-90)"
        parts.append(text(words, (0.0, 0.0), transform=turned))
    return group(parts, class_="floor")


def names(panel: Panel, lines: dict[str, list[Row]]) -> Iterator[str]:
    """Write the name of each line beside one of its points, joined to it where it is not near."""
    for number, (name, rows) in enumerate(lines.items()):
        ends = sorted(map(panel.at, rows), key=lambda at: at[1])  # the slowest point is the farthest from other lines
        placed = panel.labels.place(name, FONT, [ends[0], *reversed(ends[1:])], FAR)
        if placed:
            yield label(placed, name, f"name colour-{number % COLOURS}")


def point_labels(panel: Panel, lines: dict[str, list[Row]]) -> Iterator[str]:
    """Write the number of samples at each point, or what else was set, where there is room."""
    for number, rows in enumerate(lines.values()):
        for row in rows:
            placed = panel.labels.place(row.label, SMALL, [panel.at(row)], NEAR)
            if placed:
                yield label(placed, row.label, f"value colour-{number % COLOURS}")


def label(placed: Placed, words: str, style: str) -> str:
    """Write a label in its box, joined to its point if that is far away."""
    left, top, right, bottom = placed.box
    written = text(words, ((left + right) / 2, bottom - 0.3 * (bottom - top)), text_anchor="middle")
    x, y = placed.anchor
    nearest = min(max(x, left), right), min(max(y, top), bottom)
    leader = [path([placed.anchor, nearest], class_="leader")] if placed.is_far else []
    return group([*leader, written], class_=style)


def key() -> str:
    """Explain the marks, in a line above the axes."""
    y = 16.0
    parts = [
        mark("circle", (15.0, y)) + ring((15.0, y)) + text("recommended", (28.0, y + 4)),
        mark("circle", (122.0, y), is_hollow=True) + text("disturbed", (131.0, y + 4)),
        cross((208.0, y)) + text("95 %", (221.0, y + 4)),
        path([(266.0, y), (278.0, y)], class_="front") + text("Pareto front", (288.0, y + 4)),
    ]
    return group(parts, class_="key")
