"""Text over the picture: heads-up display with hints on keys, messages, and the panel of a typed value or a list."""

from __future__ import annotations

import re
import textwrap
from enum import IntEnum
from functools import partial
from typing import NamedTuple

from minirt.element import fields_of
from minirt.mlx.text import draw_text, measure
from minirt.scene.writer import field_text
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import Frame, State
from minirt.viewer.editing.values import Value
from minirt.viewer.language import GAP, translated

TEXT_COLOUR, MESSAGE_COLOUR, BACKGROUND = 0xFFFFFF, 0xFFD75F, 0xA0000000  # BACKGROUND with its opacity
MARGIN, PADDING = 10, 4  # pixels
TEXT_SIZE, MIN_TEXT_SIZE = 16, 8  # pixels: on a screen of scale 1, and the least that can be read
USUAL_WINDOW = 1920, 1080  # pixels: in larger windows text is larger, too
COLUMNS, ROWS = 40, 18  # letters for which a window must have room; if it has not, they become smaller
LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")
ROW_COLOUR = 0xC0C0C0  # of the rows that are not chosen
PANEL_BACKGROUND = 0xC0000000  # with its opacity
TOP, BOTTOM = 2, 2  # lines above and below the panel, which belong to the information and to messages
TAB = "< F1"  # on the tab that opens the panel
MARK = "> "  # before the chosen row


class HudLevel(IntEnum):
    """Amount of information in the heads-up display."""

    NOTHING = 0
    LINE = 1
    ALL = 2


def overlay_scale(width: int, height: int, scale: float, wanted: float) -> float:
    """Return the scale of text and icons in a window; `scale` is the screen's, `wanted` a factor of the user's."""
    return max(scale, min(width / USUAL_WINDOW[0], height / USUAL_WINDOW[1])) * wanted


def text_size(width: int, height: int, scale: float) -> int:
    """Return the text size in pixels for a window; `scale` is that of `overlay_scale`."""
    return max(MIN_TEXT_SIZE, min(round(TEXT_SIZE * scale), 2 * width // COLUMNS, height // ROWS))


def draw_hud(pixels: Pixels, state: State, shown: Outcome | None, level: HudLevel, rate: float, size: int) -> int:
    """Draw the selected element as its line in the file, the active keys, and how the picture was rendered.

    `rate`: primary rays per second, 0 if unknown. Returns the height in pixels of the text at the bottom.
    """
    width = pixels.shape[1]
    keys = hints(state, every=level == HudLevel.ALL)
    if level == HudLevel.LINE:
        rendered = f"{GAP}{status(shown)}" if shown else ""
        line = fit_width(f"{element_line(state)}{GAP}{translated(keys + rendered)}", width, size)
        draw_lines(pixels, MARGIN, line, TEXT_COLOUR, size)
        return 0
    position = f"element {state.selected + 1} of {len(state.scene.elements)}    {len(state.undo_stack)} to undo"
    max_lines = max(2, (pixels.shape[0] // 3 - 4 * PADDING) // measure(" ", size)[1])  # in a third of the window
    lines = wrap(f"{element_line(state)}\n{translated(f'{keys}{GAP}{position}')}", width, size).split("\n")
    top = lines[: max_lines - 1]
    draw_lines(pixels, MARGIN, "\n".join(top), TEXT_COLOUR, size)
    bottom = wrap(translated("\n".join((*shown.about, status(shown, rate)))), width, size) if shown else ""
    bottom = last_lines(bottom, max_lines - len(top))
    if bottom:
        draw_lines(pixels, -MARGIN, bottom, TEXT_COLOUR, size)
    return measure(bottom, size)[1] + 2 * PADDING if bottom else 0


def last_lines(text: str, count: int) -> str:
    """Return the last lines of a text; with two or more, the first of them says that others are missing."""
    lines = text.split("\n")
    missing = len(lines) - count
    if missing > 0 and count > 1:
        return "\n".join([f"... {missing + 1} more lines: miniRT -v", *lines[missing + 1 :]])
    return "\n".join(lines[-count:])


def element_line(state: State) -> str:
    """Return the selected element as its line in the file: numbers to six digits, the active value in brackets."""
    element, active = state.element, state.active
    words = [element.code]
    for field in fields_of(type(element)):
        if field == active.field:
            words.append(bracketed(field_text(field, element), active.part))
        elif not field.keyed or getattr(element, field.name) != field.default:
            words.append(field_text(field, element))
    return short_numbers(" ".join(words))


def bracketed(text: str, part: int | None) -> str:
    """Put brackets around a field, or around one of its components."""
    parts = text.split(",")
    if part is None or part >= len(parts):  # a component at its default is not written
        return f"[{text}]"
    return ",".join([*parts[:part], f"[{parts[part]}]", *parts[part + 1 :]])


def status(shown: Outcome, rate: float = 0.0) -> str:
    """Return resolution, render time, samples done and wanted, error and ray rate of a picture."""
    job = shown.job
    coarse = " preview" if shown.preview else f" at 1/{job.divisor}" if job.divisor > 1 else ""
    time = f"    {shown.seconds * 1000:.1f} ms" if shown.seconds else ""
    samples = f"{job.samples} of {job.goal} samples" if job.goal > 1 else "1 sample"
    rays = f"    {rate / 1e6:.3g} million rays a second" if rate else ""
    error = f"    error {shown.error_estimate:.1g}" if shown.error_estimate else ""
    return f"{job.width}x{job.height}{coarse}{time}    {samples}{error}{rays}"


def wrap(text: str, width: int, size: int) -> str:
    """Wrap text so that it leaves a margin in a picture of that width; lines keep at least about ten letters."""
    letters, wrapped = len(text), text
    while letters > 10 and measure(wrapped, size)[0] > width - 2 * MARGIN:
        letters = letters * 9 // 10
        wrapped = "\n".join(textwrap.fill(part, letters) for part in text.split("\n"))
    return wrapped


def fit_width(text: str, width: int, size: int) -> str:
    """Drop groups of words from the end until the text fits on a line; wrap the first group if it does not fit."""
    while measure(text, size)[0] > width - 2 * MARGIN and GAP in text:
        text = text.rpartition(GAP)[0]
    return wrap(text, width, size)


def draw_lines(pixels: Pixels, y: int, text: str, colour: int, size: int) -> None:
    """Draw text at the left border; `y` is its top, or if negative the distance of its end from the bottom."""
    top = y if y >= 0 else pixels.shape[0] + y - measure(text, size)[1]
    draw_text(pixels, MARGIN, top, text, colour, size=size, background=BACKGROUND, padding=PADDING)


def hints(state: State, every: bool) -> str:
    """Present meanings of keys, the most useful first: `+ - diameter 3.8`. `every`: also what is as usual."""
    active, title = state.active, state.element.title
    groups = [f"{title}: + - {active.name} {value_text(state, active)}"]
    if state.others:
        groups.insert(0, f"{len(state.chosen)} elements selected")
    if state.element is state.scene.camera:
        groups.append("wheel: nearer")
    if every or state.frame is not Frame.VIEW:
        groups.append(f"X: move {'in the ' if state.frame is Frame.VIEW else 'along the '}{state.frame.value}")
    return GAP.join([*groups, "H: help"])


def value_text(state: State, active: Value) -> str:
    """The active value as the file spells it, numbers to six digits."""
    text = field_text(active.field, state.element).partition(":")[2] or field_text(active.field, state.element)
    parts = text.split(",")
    if active.part is not None and active.part < len(parts):
        text = parts[active.part]
    return short_numbers(text)


def short_numbers(text: str) -> str:
    """Shorten numbers in a text to six digits."""
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", text)


draw_on_dark = partial(draw_text, background=PANEL_BACKGROUND, padding=PADDING)


def draw_tab(pixels: Pixels, size: int) -> None:
    """Draw the tab at the right edge that opens the panel."""
    width, height = measure(TAB, size)
    left, top = pixels.shape[1] - width - PADDING, (pixels.shape[0] - height) // 2
    draw_on_dark(pixels, left, top, TAB, MESSAGE_COLOUR, size=size)


class Panel(NamedTuple):
    """A title with rows below, of which one is chosen."""

    title: str
    rows: tuple[str, ...] = ()
    chosen: int = 0


def draw_panel(pixels: Pixels, panel: Panel, size: int) -> None:
    """Draw a panel in text of a size, above the messages; of a long list the rows around the chosen one."""
    line = measure(" ", size)[1]
    top = MARGIN + TOP * line
    draw_on_dark(pixels, MARGIN, top, translated(panel.title), MESSAGE_COLOUR, size=size)
    count = max(1, (pixels.shape[0] - MARGIN - 2 * PADDING - top) // line - 1 - BOTTOM)
    first = min(max(panel.chosen - count // 2, 0), max(len(panel.rows) - count, 0))
    rows = [translated(row) for row in panel.rows[first : first + count]]
    if rows:
        top, left = top + line + 2 * PADDING, MARGIN + measure(MARK, size)[0]
        draw_on_dark(pixels, left, top, "\n".join(rows), ROW_COLOUR, size=size)
        chosen = panel.chosen - first
        draw_text(pixels, MARGIN, top + chosen * line, MARK, MESSAGE_COLOUR, size=size)
        draw_text(pixels, left, top + chosen * line, rows[chosen], MESSAGE_COLOUR, size=size)
