"""What is written over the picture: information, messages, help."""

from __future__ import annotations

import re
import textwrap

from minirt.element import fields_of
from minirt.mlx.text import draw_text, measure
from minirt.scene.rewriting import spelling
from minirt.viewer.bindings import FINE, Group, groups
from minirt.viewer.painter import Outcome, Pixels
from minirt.viewer.state import State

INK, ACCENT, PAPER = 0xFFFFFF, 0xFFD75F, 0xA0000000  # PAPER with its opacity
MARGIN, PADDING = 10, 4  # pixels
SIZES = range(16, 7, -1)  # of letters, in pixels; help takes the first that fits
COMPILING = "Compiling kernels (first run only)"

LONG_NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")


def draw_hud(pixels: Pixels, state: State, shown: Outcome | None) -> None:
    """The selected element as its line in the file, what keys do to it, and how the picture was made."""
    active = state.active
    about = f"{state.element.title}: {active.name if active else 'no value'}    move: {state.frame.value}    H: help"
    write(pixels, MARGIN, f"{line(state)}\n{about}", INK)
    if shown:
        write(pixels, -MARGIN, status(shown), INK)


def line(state: State) -> str:
    """The selected element as in its file, numbers to six digits, the active value in brackets."""
    element, active = state.element, state.active
    words = [element.code]
    for field in fields_of(type(element)):
        if field == active:
            words.append(f"[{spelling(field, element)}]")
        elif not field.keyed or getattr(element, field.name) != field.default:
            words.append(spelling(field, element))
    return LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", " ".join(words))


def status(shown: Outcome) -> str:
    """Resolution and time of the picture, how many samples its pixels have of those that they will, and its error."""
    job = shown.job
    coarse = " preview" if shown.preview else f" at 1/{job.divisor}" if job.divisor > 1 else ""
    time = f"    {shown.seconds * 1000:.1f} ms" if shown.seconds else ""
    samples = f"{job.samples} of {job.goal} samples" if job.goal > 1 else "1 sample"
    error = f"    error {shown.estimate:.1g}" if shown.estimate else ""
    return f"{job.width}x{job.height}{coarse}{time}    {samples}{error}"


def draw_message(pixels: Pixels, text: str) -> None:
    """A message above the lower border."""
    if text:
        write(pixels, -MARGIN - 2 * PADDING - measure(" ")[1], wrapped(text, pixels.shape[1]), ACCENT)


def wrapped(text: str, width: int) -> str:
    """`text` in lines that leave a margin in a picture of that width, as far as ten letters do."""
    letters, folded = len(text), text
    while letters > 10 and measure(folded)[0] > width - 2 * MARGIN:
        letters = letters * 9 // 10
        folded = "\n".join(textwrap.fill(part, letters) for part in text.split("\n"))
    return folded


def write(pixels: Pixels, y: int, text: str, ink: int) -> None:
    """Text at the left border; a negative `y` is where it ends above the lower border."""
    top = y if y >= 0 else pixels.shape[0] + y - measure(text)[1]
    draw_text(pixels, MARGIN, top, text, ink, background=PAPER, padding=PADDING)


def draw_help(pixels: Pixels, layout: str) -> None:
    """The table of bindings over a darkened picture, in two columns."""
    pixels[..., :3] //= 4
    listed = [*groups(layout), ("", [FINE])]
    columns = [listed[:2], listed[2:]]
    height, width = pixels.shape[:2]
    for size in SIZES:
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
