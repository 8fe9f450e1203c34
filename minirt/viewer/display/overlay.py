"""Text over the picture: heads-up display, messages, help."""

from __future__ import annotations

import re
import textwrap
from enum import IntEnum
from math import ceil

from minirt.element import fields_of
from minirt.mlx.text import draw_text, measure
from minirt.scene.line_rewriting import field_text
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import Frame, State
from minirt.viewer.input.bindings import FINE_NOTE, KeyGroup, key_groups

TEXT_COLOUR, MESSAGE_COLOUR, BACKGROUND = 0xFFFFFF, 0xFFD75F, 0xA0000000  # BACKGROUND with its opacity
MARGIN, PADDING = 10, 4  # pixels
TEXT_SIZE, MIN_TEXT_SIZE = 16, 8  # pixels: on a screen of scale 1, and the least that can be read
COLUMNS, ROWS = 40, 18  # letters for which a window must have room; if it has not, they become smaller

LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")


class HudLevel(IntEnum):
    """Amount of information in the heads-up display."""

    NOTHING = 0
    LINE = 1
    ALL = 2


def text_size(width: int, height: int, scale: float) -> int:
    """Return the text size in pixels for a window; `scale` is the screen's, 2 for twice as many dots per inch."""
    return max(MIN_TEXT_SIZE, min(round(TEXT_SIZE * scale), 2 * width // COLUMNS, height // ROWS))


def draw_hud(pixels: Pixels, state: State, shown: Outcome | None, level: HudLevel, rate: float, size: int) -> int:
    """Draw the selected element as its line in the file, the active keys, and how the picture was rendered.

    `rate`: primary rays per second, 0 if unknown. Returns the height in pixels of the text at the bottom.
    """
    width = pixels.shape[1]
    if level == HudLevel.NOTHING:
        return 0
    active = state.active
    move = f"    move: {state.frame.value}" if level == HudLevel.ALL or state.frame is not Frame.VIEW else ""
    keys = f"{state.element.title}: {active.name if active else 'no value'}{move}    H: help"
    if level == HudLevel.LINE:
        rendered = f"    {status(shown)}" if shown else ""
        line = fit_width(f"{element_line(state)}    {keys}{rendered}", width, size)
        draw_lines(pixels, MARGIN, line, TEXT_COLOUR, size)
        return 0
    position = f"{state.selected + 1} of {len(state.scene.elements)}    {len(state.undo_stack)} to undo"
    top = wrap(f"{element_line(state)}\n{keys}    {position}", width, size)
    draw_lines(pixels, MARGIN, top, TEXT_COLOUR, size)
    bottom = wrap("\n".join((*shown.about, status(shown, rate))), width, size) if shown else ""
    max_lines = pixels.shape[0] // 2 // measure(" ", size)[1]  # in half of the window
    bottom = "\n".join(bottom.split("\n")[-max(max_lines, 1) :])
    if bottom:
        draw_lines(pixels, -MARGIN, bottom, TEXT_COLOUR, size)
    return measure(bottom, size)[1] + 2 * PADDING if bottom else 0


def element_line(state: State) -> str:
    """Return the selected element as its line in the file: numbers to six digits, the active value in brackets."""
    element, active = state.element, state.active
    words = [element.code]
    for field in fields_of(type(element)):
        if active and field == active.field:
            words.append(bracketed(field_text(field, element), active.part))
        elif not field.keyed or getattr(element, field.name) != field.default:
            words.append(field_text(field, element))
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", " ".join(words))


def bracketed(text: str, part: int | None) -> str:
    """Put brackets around a field, or around one of its components."""
    if part is None:
        return f"[{text}]"
    parts = text.split(",")
    if part >= len(parts):  # the component is at its default and so not written
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


def draw_message(pixels: Pixels, text: str, bottom: int, size: int) -> None:
    """Draw a message above the text of `bottom` pixels height at the bottom."""
    if text:
        draw_lines(pixels, -MARGIN - bottom, wrap(text, pixels.shape[1], size), MESSAGE_COLOUR, size)


def wrap(text: str, width: int, size: int) -> str:
    """Wrap text so that it leaves a margin in a picture of that width; lines keep at least about ten letters."""
    letters, wrapped = len(text), text
    while letters > 10 and measure(wrapped, size)[0] > width - 2 * MARGIN:
        letters = letters * 9 // 10
        wrapped = "\n".join(textwrap.fill(part, letters) for part in text.split("\n"))
    return wrapped


def fit_width(text: str, width: int, size: int) -> str:
    """Drop groups of words from the end until the text fits on a line; wrap the first group if it does not fit."""
    while measure(text, size)[0] > width - 2 * MARGIN and "    " in text:
        text = text.rpartition("    ")[0]
    return wrap(text, width, size)


def draw_lines(pixels: Pixels, y: int, text: str, colour: int, size: int) -> None:
    """Draw text at the left border; `y` is its top, or if negative the distance of its end from the bottom."""
    top = y if y >= 0 else pixels.shape[0] + y - measure(text, size)[1]
    draw_text(pixels, MARGIN, top, text, colour, size=size, background=BACKGROUND, padding=PADDING)


def draw_help(pixels: Pixels, layout: str, max_size: int) -> None:
    """Draw the table of key bindings over the darkened picture, in two columns, in the largest text that fits."""
    pixels >>= 2  # 20 times as fast as the three colours alone
    pixels[..., 3] = 255
    listed = [*key_groups(layout), ("", [FINE_NOTE])]
    columns = [listed[:2], listed[2:]]
    height, width = pixels.shape[:2]
    texts_of_columns = [column_texts(column) for column in columns]
    size = max_size
    while True:
        widths = [[measure(text, size)[0] + size for text in texts] for texts in texts_of_columns]
        heights = [measure(texts[0], size)[1] for texts in texts_of_columns]
        excess = max((sum(map(sum, widths)) + 2 * MARGIN) / width, (max(heights) + 2 * MARGIN) / height)
        if excess <= 1 or size < MIN_TEXT_SIZE:
            break
        size = max(MIN_TEXT_SIZE - 1, min(size - 1, ceil(size / excess)))  # widths are nearly proportional to the size
    x = MARGIN
    for texts, text_widths in zip(texts_of_columns, widths, strict=True):
        for text, text_width, colour in zip(texts, text_widths, (MESSAGE_COLOUR, TEXT_COLOUR), strict=True):
            draw_text(pixels, x, MARGIN, text, colour, size=size)
            x += text_width


def column_texts(column: list[KeyGroup]) -> tuple[str, str]:
    """Return the keys and the help of some groups, as two texts with equally many lines."""
    keys, helps = [], []
    for title, rows in column:
        keys += [title, *(f"  {key}" for key, _ in rows), ""]
        helps += ["", *(help for _, help in rows), ""]
    return "\n".join(keys), "\n".join(helps)
