"""Work-precision diagram as SVG: error against run time, a line for each render option."""

from __future__ import annotations

from collections.abc import Collection
from html import escape
from pathlib import Path

from minirt.report.measurements.picture_errors import OURS, Row
from minirt.report.output.diagram_labels import COLOURS, drawn_floor, key, names, point_labels
from minirt.report.output.marks import FORMS, mark, ring
from minirt.report.output.panel import Diagram, Panel, Size, intervals, panel_for
from minirt.report.output.scales import horizontal_axis, vertical_axis
from minirt.report.output.svg import element, group, path

STYLE = Path(__file__).with_name("diagram.css")


def draw(shown: Diagram, size: Size) -> str:
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


def drawn_line(panel: Panel, number: int, rows: list[Row], recommended: Collection[Row]) -> str:
    """Draw the points of a render option, joined by a line."""
    style = f"line colour-{number % COLOURS}" + " other" * (rows[0].program != OURS)
    points = (point(panel, row, FORMS[number % len(FORMS)], row in recommended) for row in rows)
    return group([path(map(panel.at, rows), class_="join"), *points], class_=style, data_name=rows[0].knob)


def point(panel: Panel, row: Row, form: str, is_recommended: bool) -> str:
    """Draw a point with its confidence intervals; the pointer shows its figures."""
    parts = [
        element("title", escape(described(row, is_recommended))),
        *(path(bar, class_="interval") for bar in intervals(panel, row)),
        mark(form, panel.at(row), is_hollow=not row.valid),
        ring(panel.at(row)) if is_recommended else "",
    ]
    return group(parts, class_="point")


def described(row: Row, is_recommended: bool) -> str:
    """Describe a point in words."""
    remark = [row.remark] * bool(row.remark) + ["recommended"] * is_recommended
    return "; ".join([f"{row.name}: RMSE {row.rmse:.2g}, {row.wall_ms:.3g} ms", *remark])
