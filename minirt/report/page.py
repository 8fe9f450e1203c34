"""A document written twice: as Markdown, and as one HTML page that needs no other file and no network; its diagram."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Collection, Iterable, Sequence
from html import escape
from importlib.util import find_spec
from io import StringIO
from math import isfinite, isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from minirt.errors import RenderError
from minirt.report.findings import Findings, pareto_front, recommended, title
from minirt.report.pictures import OURS, Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes


FOLDER = Path(__file__).parent
# The browser itself refuses whatever is not in the page.
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
HEAD = f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="{POLICY}"><link rel="icon" href="data:,">"""
# Two pictures with a slider between them, which the script fills and shows.
COMPARISON = """<figure class="comparison" data-other="{}" hidden>
<div class="panes"><img alt="" class="left"><img alt="" class="right"><i class="edge"></i></div>
<div class="controls"><select class="left" aria-label="left picture"></select>
<input type="range" min="0" max="100" value="50" step="any" aria-label="border of the pictures">
<select class="right" aria-label="right picture"></select></div></figure>"""


class Column(NamedTuple):
    """A column of a table: its title, the field of the rows that it shows, and the format of the field."""

    title: str
    field: str
    format: str = ""


class Picture(NamedTuple):
    """A picture with a name."""

    name: str
    file: str
    data: bytes  # PNG


class Document:
    """Blocks in their order, each in both forms. Backticks in text surround code."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.markdown: list[str] = []
        self.html: list[str] = []
        self.heading(title, 1)

    def heading(self, text: str, level: int = 2) -> None:
        """Add the title of a section."""
        self.markdown.append(f"{'#' * level} {text}")
        self.html.append(f"<h{level}>{inline(text)}</h{level}>")

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self.markdown.append(text)
        self.html.append(f"<p>{inline(text)}</p>")

    def notice(self, text: str) -> None:
        """Add a paragraph that no reader should miss."""
        self.markdown.append(f"**{text}**")
        self.html.append(f'<p class="notice" role="alert">{inline(text)}</p>')

    def bullets(self, items: Iterable[str]) -> None:
        """Add a list of points."""
        items = list(items)
        self.markdown.append("\n".join(f"- {item}" for item in items))
        self.html.append(f"<ul>{''.join(f'<li>{inline(item)}</li>' for item in items)}</ul>")

    def table(self, rows: Sequence[Any], columns: Sequence[Column], emphasised: Collection[Any] = ()) -> None:
        """Add a table of records, with a dash for NaN; it scrolls sideways where it is wider than the screen."""
        titles = "".join(f'<th class="{kind(column)}">{inline(column.title)}</th>' for column in columns)
        lines = ["| " + " | ".join(column.title for column in columns) + " |"]
        lines.append("|" + "|".join("---:" if column.format else "---" for column in columns) + "|")
        html = []
        for row in rows:
            cells = [cell(getattr(row, column.field), column.format) for column in columns]
            first, *others = (each.replace("|", r"\|") for each in cells)
            lines.append("| " + " | ".join([f"**{first}**" if row in emphasised else first, *others]) + " |")
            data = (f'<td class="{kind(each)}">{inline(text)}</td>' for each, text in zip(columns, cells, strict=True))
            html.append(f'<tr class="{"emphasised" if row in emphasised else "plain"}">{"".join(data)}</tr>')
        self.markdown.append("\n".join(lines))
        body = f"<table><thead><tr>{titles}</tr></thead><tbody>{''.join(html)}</tbody></table>"
        self.html.append(f'<div class="scroll" tabindex="0">{body}</div>')

    def chart(self, name: str, file: str, about: str, wide: str, narrow: str) -> None:
        """Add a chart as SVG elements in two widths; Markdown shows a file beside it."""
        self.markdown += [f"![{name}]({file})", about]
        both = f'<div class="wide">{wide}</div><div class="narrow">{narrow}</div>'
        self.html.append(f'<figure class="diagrams">{both}<figcaption>{inline(about)}</figcaption></figure>')

    def pictures(self, pictures: Iterable[Picture], other: int) -> None:
        """Add pictures to compare: the first with that of index `other`, unless the reader chooses. The page alone
        shows them."""
        images = "".join(
            f'<figure><img alt="{escape(each.name)}" src="data:image/png;base64,{b64encode(each.data).decode()}" '
            f'decoding="async"><figcaption>{inline(each.name)}</figcaption></figure>'
            for each in pictures
        )
        self.html += [COMPARISON.format(other), f'<div class="pictures">{images}</div>']

    def as_markdown(self) -> str:
        """Return the document as Markdown, an empty line between two blocks."""
        return "\n\n".join(self.markdown) + "\n"

    def as_page(self) -> str:
        """Return the document as a page."""
        style, script = ((FOLDER / name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
        head = f"{HEAD}\n<title>{escape(self.title)}</title><style>{style}</style></head>"
        body = "\n".join(self.html)
        return f"{head}\n<body><main>{body}\n<script>{script}</script></main></body></html>\n"


def kind(column: Column) -> str:
    """Return the style of a column: numbers are aligned to the right."""
    return "number" if column.format else "word"


def inline(text: str) -> str:
    """Escape text; backticks surround code."""
    return re.sub(r"`(.+?)`", r"<code>\1</code>", escape(text))


def cell(value: Any, format: str) -> str:
    """Format one cell; a dash for NaN, yes or no for truth."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"


# The diagram of error against run time, by matplotlib: a line for each render option.

WIDE, NARROW = (9.0, 6.2), (3.9, 6.6)  # inches, of 100 pixels each
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


def require_matplotlib() -> None:
    """RenderError, which tells how to install it, if matplotlib is missing."""
    if not find_spec("matplotlib"):
        raise RenderError("--report draws its diagram with matplotlib: install it (pip install 'minirt[report]')")


def draw(found: Findings, size: tuple[float, float]) -> str:
    """Return the diagram as the text of an SVG file."""
    import matplotlib
    from matplotlib.figure import Figure

    lines: dict[str, list[Row]] = {}
    for row in found.pictures:
        if isfinite(row.rmse) and isfinite(row.wall_ms):
            lines.setdefault(row.knob, []).append(row)
    with matplotlib.rc_context(STYLE):
        figure = Figure(size, dpi=100, layout="constrained")
        axes = figure.add_subplot(xscale="log", yscale="log")
        axes.set(xlabel="error: RMSE, 1 from black to white", ylabel="milliseconds per picture")
        if front := pareto_front(found.pictures, found.reference_error):
            axes.plot(*places(front), color=BAND, linewidth=9, solid_capstyle="round", label="Pareto front", zorder=1)
        best = recommended(found)
        axes.plot(*places(best), "o", markersize=12, markerfacecolor="none", color=INK, label="recommended")
        for number, (name, rows) in enumerate(lines.items()):
            draw_line(axes, name, rows, COLOURS[number % len(COLOURS)], MARKS[number % len(MARKS)])
        draw_floors(axes, found, min((row.rmse for rows in lines.values() for row in rows), default=1.0))
        scale(axes)
        figure.legend(loc="outside lower left", ncols=2 if size == NARROW else 5, frameon=False, fontsize="small")
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Title": title(found)})
    return text.getvalue()


def on_page(svg: str) -> str:
    """Return the element of an SVG file, whose colours follow those of the page that it is put into."""
    for colour, variable in ON_PAGE.items():
        svg = svg.replace(colour, variable)
    return svg[svg.index("<svg") :].replace("<svg", '<svg class="diagram" role="img"', 1)


def places(rows: list[Row]) -> tuple[list[float], list[float]]:
    """Return the errors and the times of some rows."""
    return [row.rmse for row in rows], [row.wall_ms for row in rows]


def draw_line(axes: Axes, name: str, rows: list[Row], colour: str, mark: str) -> None:
    """Draw the points of a render option with their confidence intervals, and the number of samples at each."""
    style: dict[str, Any] = {"color": colour, "linewidth": 1.6, "linestyle": "-" if rows[0].program == OURS else ":"}
    x, y = places(rows)
    axes.plot(x, y, marker=mark, markersize=5.5, label=name, **style)
    hollow = [row for row in rows if not row.valid]
    axes.plot(*places(hollow), mark, markersize=5.5, markerfacecolor=PAPER, color=colour)
    bars: dict[str, Any] = {"colors": colour, "linewidth": 1, "alpha": 0.75}
    axes.hlines(y, [row.rmse_low for row in rows], [row.rmse_high for row in rows], **bars)
    axes.vlines(x, [row.wall_low_ms for row in rows], [row.wall_high_ms for row in rows], **bars)
    for row in rows:
        axes.annotate(row.label, (row.rmse, row.wall_ms), (5, 4), color=colour, **BESIDE)


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
