"""Work-precision diagram as SVG: error against run time, a line for each render option."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from html import escape
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from minirt.report.measurements.pareto import pareto_front
from minirt.report.measurements.picture_errors import OURS, Row
from minirt.report.output.labels import Box, Placed, Placer
from minirt.report.output.marks import FORMS, RADIUS, error_bar, mark, ring
from minirt.report.output.scales import Scale, horizontal_axis, scale_around, vertical_axis
from minirt.report.output.svg import Point, element, group, path, text

STYLE = Path(__file__).with_name("diagram.css")
COLOURS = 10  # of the style sheet
FONT, SMALL = 13.0, 11.0  # pixels, as in the style sheet
NEAR = 3.0  # the axis reaches a floor unless it lies below all errors by more than this factor


class Size(NamedTuple):
    """Size of a diagram in pixels."""

    width: int
    height: int


class Floor(NamedTuple):
    """An error below which the diagram says nothing."""

    name: str
    error: float


class Panel(NamedTuple):
    """The area between the axes: its scales, and the places that are taken."""

    errors: Scale
    times: Scale
    labels: Placer

    def at(self, row: Row) -> Point:
        """Return the pixel of a row."""
        return self.errors(row.rmse), self.times(row.wall_ms)


class Diagram(NamedTuple):
    """What a diagram shows."""

    title: str
    lines: dict[str, list[Row]]  # render option -> rows that did not fail
    floors: list[Floor]
    front: list[Row]  # Pareto front
    recommended: Collection[Row]


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


def draw(shown: Diagram, size: Size = WIDE) -> str:
    """Return the diagram as an SVG element without a style sheet."""
    panel = panel_for(shown, size)
    content = [
        element("title", escape(shown.title)),
        element("rect", width=size.width, height=size.height, class_="paper"),
        horizontal_axis(panel.errors, panel.times.end, panel.times.start, "error: RMSE, 1 from black to white"),
        vertical_axis(panel.times, panel.errors.start, panel.errors.end, "milliseconds per picture"),
        path(map(panel.at, shown.front), class_="front") if shown.front else "",
        *(drawn_floor(panel, floor) for floor in shown.floors if floor.error > 0),
        *(drawn_line(panel, number, line, shown.recommended) for number, line in enumerate(shown.lines.values())),
        *names(panel, shown.lines),
        *point_labels(panel, shown.lines),
        key(),
    ]
    box = f"0 0 {size.width} {size.height}"
    return element("svg", *content, xmlns="http://www.w3.org/2000/svg", viewBox=box, class_="diagram", role="img")


def standalone(drawn: str) -> str:
    """Return a diagram as a file of its own, with its style sheet."""
    start, end = drawn.split(">", 1)
    return f"{start}>{element('style', STYLE.read_text(encoding='utf-8'))}{end}\n"


def panel_for(shown: Diagram, size: Size) -> Panel:
    """Choose the scales, and take the places of all points and lines."""
    rows = [row for line in shown.lines.values() for row in line]
    least = min((row.rmse for row in rows), default=1.0)
    near = [floor.error for floor in shown.floors if floor.error * NEAR >= least]
    frame = Box(50.0, 58.0, size.width - 14.0, size.height - 50.0)
    panel = Panel(
        scale_around([*near, *(row.rmse for row in rows)], frame.left, frame.right),
        scale_around([row.wall_ms for row in rows], frame.bottom, frame.top),
        Placer(frame),
    )
    for line in shown.lines.values():
        panel.labels.cross([panel.at(row) for row in line])
        for row in line:
            panel.labels.take(panel.at(row), RADIUS * (2 if row in shown.recommended else 1) + 1)
    return panel


def drawn_floor(panel: Panel, floor: Floor) -> str:
    """Draw a floor of the error as a dashed line with its name; a note at the left edge if it is far below."""
    is_far = not panel.errors.holds(floor.error)
    words = f"{'← ' * is_far}{floor.name}: {floor.error:.2g}"
    x = panel.errors(floor.error)
    placed = panel.labels.place_upright(words, SMALL, x)
    line = path([(x, panel.times.start), (x, panel.times.end)]) if not is_far else ""
    if not placed:
        return group([line], class_="floor")
    at = placed.box.right - 3, placed.box.bottom
    label = text(words, (0, 0), transform=f"translate({at[0]:.1f} {at[1]:.1f}) rotate(-90)")
    return group([line, label], class_="floor")


def drawn_line(panel: Panel, number: int, rows: list[Row], recommended: Collection[Row]) -> str:
    """Draw the points of a render option, joined by a line."""
    style = f"line colour-{number % COLOURS}" + " other" * (rows[0].program != OURS)
    points = (point(panel, row, FORMS[number % len(FORMS)], row in recommended) for row in rows)
    return group([path(map(panel.at, rows), class_="join"), *points], class_=style, data_name=rows[0].knob)


def point(panel: Panel, row: Row, form: str, is_recommended: bool) -> str:
    """Draw a point with its confidence intervals; the pointer shows its figures."""
    x, y = panel.at(row)
    parts = [
        element("title", escape(described(row, is_recommended))),
        error_bar((panel.errors(row.rmse_low), y), (panel.errors(row.rmse_high), y)) if isfinite(row.rmse_low) else "",
        error_bar((x, panel.times(row.wall_low_ms)), (x, panel.times(row.wall_high_ms)))
        if isfinite(row.wall_low_ms)
        else "",
        mark(form, (x, y), is_hollow=not row.valid),
        ring((x, y)) if is_recommended else "",
    ]
    return group(parts, class_="point")


def described(row: Row, is_recommended: bool) -> str:
    """Describe a point in words."""
    remark = [row.remark] * bool(row.remark) + ["recommended"] * is_recommended
    return "; ".join([f"{row.name}: RMSE {row.rmse:.2g}, {row.wall_ms:.3g} ms", *remark])


def names(panel: Panel, lines: dict[str, list[Row]]) -> Iterator[str]:
    """Write the name of each line beside one of its points, joined to it where it is not near."""
    for number, (name, rows) in enumerate(lines.items()):
        ends = sorted(map(panel.at, rows), key=lambda at: at[1])  # the slowest point is the farthest from other lines
        placed = panel.labels.place(name, FONT, [ends[0], *reversed(ends[1:])], (8.0, 16.0, 26.0, 40.0, 60.0, 85.0))
        if placed:
            yield label(placed, name, f"name colour-{number % COLOURS}")


def point_labels(panel: Panel, lines: dict[str, list[Row]]) -> Iterator[str]:
    """Write the number of samples at each point, or what else was set, where there is room."""
    for number, rows in enumerate(lines.values()):
        for row in rows:
            placed = panel.labels.place(row.label, SMALL, [panel.at(row)], (6.0, 10.0))
            if placed:
                yield label(placed, row.label, f"value colour-{number % COLOURS}")


def label(placed: Placed, words: str, style: str) -> str:
    """Write a label in its box, joined to its point if that is far away."""
    box = placed.box
    middle = (box.left + box.right) / 2, (box.top + box.bottom) / 2
    words_drawn = text(words, (middle[0], box.bottom - 0.3 * (box.bottom - box.top)), text_anchor="middle")
    leader = path([placed.anchor, middle], class_="leader") if placed.is_far else ""
    return group([leader, words_drawn], class_=style)


def key() -> str:
    """Explain the marks, in a line above the axes."""
    y = 16.0
    return group(
        [
            mark("circle", (15.0, y)) + ring((15.0, y)) + text("recommended", (29.0, y + 4)),
            mark("circle", (117.0, y), is_hollow=True) + text("disturbed", (127.0, y + 4)),
            error_bar((194.0, y), (210.0, y))
            + error_bar((202.0, y - 7), (202.0, y + 7))
            + text("95 %", (215.0, y + 4)),
            path([(262.0, y), (274.0, y)], class_="front") + text("Pareto front", (285.0, y + 4)),
        ],
        class_="key",
    )
