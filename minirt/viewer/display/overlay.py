"""What is written over the picture: information, messages, help."""

from __future__ import annotations

import re
import textwrap
from enum import IntEnum

from minirt.element import fields_of
from minirt.mlx.text import draw_text, measure
from minirt.scene.line_rewriting import field_text
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import Frame, State
from minirt.viewer.input.bindings import FINE, Group, groups

INK, ACCENT, PAPER = 0xFFFFFF, 0xFFD75F, 0xA0000000  # PAPER with its opacity
MARGIN, PADDING = 10, 4  # pixels
LETTERS, SMALLEST = 16, 8  # pixels: the size of letters on a screen of scale 1, and the least that can be read
ACROSS, DOWN = 40, 18  # letters of what a window has to have room for, or they become smaller
COMPILING = "Compiling kernels (first run only)"

LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")


class Level(IntEnum):
    """How much is written."""

    NOTHING = 0
    LINE = 1
    ALL = 2


def letters(width: int, height: int, scale: float) -> int:
    """The size of letters in a window of so many pixels; `scale` is that of the screen, 2 for twice as many dots."""
    return max(SMALLEST, min(round(LETTERS * scale), 2 * width // ACROSS, height // DOWN))


def draw_hud(pixels: Pixels, state: State, shown: Outcome | None, level: Level, rate: float, size: int) -> int:
    """The selected element as its line in the file, what keys do to it, and how the picture was made.

    `rate`: rays a second from the eye, 0 where that is not known. Returns how many pixels are taken at the bottom.
    """
    width = pixels.shape[1]
    if level == Level.NOTHING:
        return 0
    active = state.active
    move = f"    move: {state.frame.value}" if level == Level.ALL or state.frame is not Frame.VIEW else ""
    keys = f"{state.element.title}: {active.name if active else 'no value'}{move}    H: help"
    if level == Level.LINE:
        made = f"    {status(shown)}" if shown else ""
        write(pixels, MARGIN, cut(f"{line(state)}    {keys}{made}", width, size), INK, size)
        return 0
    place = f"{state.selected + 1} of {len(state.scene.elements)}    {len(state.past)} to undo"
    write(pixels, MARGIN, wrapped(f"{line(state)}\n{keys}    {place}", width, size), INK, size)
    made = wrapped("\n".join((*shown.about, status(shown, rate))), width, size) if shown else ""
    room = pixels.shape[0] // 2 // measure(" ", size)[1]  # lines of half of the window
    made = "\n".join(made.split("\n")[-max(room, 1) :])
    if made:
        write(pixels, -MARGIN, made, INK, size)
    return measure(made, size)[1] + 2 * PADDING if made else 0


def line(state: State) -> str:
    """The selected element as in its file, numbers to six digits, the active value in brackets."""
    element, active = state.element, state.active
    words = [element.code]
    for field in fields_of(type(element)):
        if active and field == active.field:
            words.append(bracketed(field_text(field, element), active.part))
        elif not field.keyed or getattr(element, field.name) != field.default:
            words.append(field_text(field, element))
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", " ".join(words))


def bracketed(written: str, part: int | None) -> str:
    """A field, or one of its components, in brackets."""
    if part is None:
        return f"[{written}]"
    parts = written.split(",")
    if part >= len(parts):  # left out, because it is at its default
        return f"[{written}]"
    return ",".join([*parts[:part], f"[{parts[part]}]", *parts[part + 1 :]])


def status(shown: Outcome, rate: float = 0.0) -> str:
    """Resolution and time of the picture, how many samples its pixels have of those that they will, and its error."""
    job = shown.job
    coarse = " preview" if shown.preview else f" at 1/{job.divisor}" if job.divisor > 1 else ""
    time = f"    {shown.seconds * 1000:.1f} ms" if shown.seconds else ""
    samples = f"{job.samples} of {job.goal} samples" if job.goal > 1 else "1 sample"
    rays = f"    {rate / 1e6:.3g} million rays a second" if rate else ""
    error = f"    error {shown.estimate:.1g}" if shown.estimate else ""
    return f"{job.width}x{job.height}{coarse}{time}    {samples}{error}{rays}"


def draw_message(pixels: Pixels, text: str, taken: int, size: int) -> None:
    """A message above as many pixels as are taken at the bottom."""
    if text:
        write(pixels, -MARGIN - taken, wrapped(text, pixels.shape[1], size), ACCENT, size)


def wrapped(text: str, width: int, size: int) -> str:
    """`text` in lines that leave a margin in a picture of that width, as far as ten letters do."""
    letters, folded = len(text), text
    while letters > 10 and measure(folded, size)[0] > width - 2 * MARGIN:
        letters = letters * 9 // 10
        folded = "\n".join(textwrap.fill(part, letters) for part in text.split("\n"))
    return folded


def cut(text: str, width: int, size: int) -> str:
    """As many of the groups of words in `text` as have room, but for the first."""
    while measure(text, size)[0] > width - 2 * MARGIN and "    " in text:
        text = text.rpartition("    ")[0]
    return wrapped(text, width, size)


def write(pixels: Pixels, y: int, text: str, ink: int, size: int) -> None:
    """Text at the left border; a negative `y` is where it ends above the lower border."""
    top = y if y >= 0 else pixels.shape[0] + y - measure(text, size)[1]
    draw_text(pixels, MARGIN, top, text, ink, size=size, background=PAPER, padding=PADDING)


def draw_help(pixels: Pixels, layout: str, largest: int) -> None:
    """The table of bindings over a darkened picture, in two columns, in the largest letters that have room."""
    pixels[..., :3] //= 4
    listed = [*groups(layout), ("", [FINE])]
    columns = [listed[:2], listed[2:]]
    height, width = pixels.shape[:2]
    for size in range(largest, SMALLEST - 2, -1):
        laid_out = [column_texts(column) for column in columns]
        widths = [[measure(text, size)[0] + size for text in texts] for texts in laid_out]
        heights = [measure(texts[0], size)[1] for texts in laid_out]
        if sum(map(sum, widths)) + 2 * MARGIN <= width and max(heights) + 2 * MARGIN <= height:
            break
    x = MARGIN
    for texts, steps in zip(laid_out, widths, strict=True):
        for text, step, ink in zip(texts, steps, (ACCENT, INK), strict=True):
            draw_text(pixels, x, MARGIN, text, ink, size=size)
            x += step


def column_texts(column: list[Group]) -> tuple[str, str]:
    """Keys and help of some groups, as two texts with as many lines."""
    keys, helps = [], []
    for title, rows in column:
        keys += [title, *(f"  {key}" for key, _ in rows), ""]
        helps += ["", *(help for _, help in rows), ""]
    return "\n".join(keys), "\n".join(helps)
