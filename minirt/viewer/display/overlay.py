"""Text over the picture: heads-up display with hints on keys, messages, and the tab of the panel."""

from __future__ import annotations

import textwrap
from enum import IntEnum

from minirt.element import fields_of
from minirt.fields import Colour
from minirt.mlx.text import draw_text, measure
from minirt.scene.writer import field_text
from minirt.viewer.display.jobs import Painted, Pixels
from minirt.viewer.display.lists import MARGIN, PADDING, draw_on_dark
from minirt.viewer.display.words import bracketed, short_numbers, title_in_words, value_in_words, values_in_words
from minirt.viewer.editing.state import MoveAxes, State
from minirt.viewer.editing.values import Value, values
from minirt.viewer.language import GAP, translated

TEXT_COLOUR, MESSAGE_COLOUR, BACKGROUND = 0xFFFFFF, 0xFFD75F, 0xA0000000  # BACKGROUND with its opacity
TEXT_SIZE, MIN_TEXT_SIZE = 16, 8  # pixels: on a screen of scale 1, and the least that can be read
USUAL_WINDOW = 1920, 1080  # pixels: in larger windows text is larger, too
COLUMNS, ROWS = 40, 18  # letters for which a window must have room; if it has not, they become smaller
TAB = "< F1"  # on the tab that opens the panel


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


def draw_hud(pixels: Pixels, state: State, shown: Painted | None, level: HudLevel, rate: float, size: int) -> int:
    """Draw the selected element in words, the active keys, and how the picture was rendered.

    With all information there is the element's line in the file, too. `shown`: the picture, None before the first;
    `rate`: primary rays per second, 0 if unknown; `size`: of the text, in pixels. Returns the height in pixels of the
    text at the bottom, 0 without one.
    """
    width = pixels.shape[1]
    keys = hints(state, every=level == HudLevel.ALL)
    if level == HudLevel.LINE:
        rendered = f"{GAP}{status(shown)}" if shown else ""
        line = fit_width(f"{fitting_words(state, width, size)}{GAP}{translated(keys + rendered)}", width, size)
        draw_lines(pixels, MARGIN, line, TEXT_COLOUR, size)
        return 0
    position = f"element {state.selected + 1} of {len(state.scene.elements)}    {len(state.undo_stack)} to undo"
    max_lines = max(2, (pixels.shape[0] // 3 - 4 * PADDING) // measure(" ", size)[1])  # in a third of the window
    words = ", ".join((title_in_words(state.element), *values_in_words(state)))
    keys = translated(f"{keys}{GAP}{position}")
    lines = wrap(f"{words}\n{element_line(state)}\n{keys}", width, size).split("\n")
    top = lines[: max_lines - 1]
    draw_lines(pixels, MARGIN, "\n".join(top), TEXT_COLOUR, size)
    bottom = wrap(translated("\n".join((*shown.about, status(shown, rate)))), width, size) if shown else ""
    bottom = last_lines(bottom, max_lines - len(top))
    if bottom:
        draw_lines(pixels, -MARGIN, bottom, TEXT_COLOUR, size)
    return measure(bottom, size)[1] + 2 * PADDING if bottom else 0


def fitting_words(state: State, width: int, size: int) -> str:
    """Return the title of the selected element and as many values as fit on a line with the keys.

    Where the active one is not among them it takes the place of the others.
    """
    room = width - measure(GAP + translated(hints(state, every=False)), size)[0] - 2 * MARGIN
    title, words, has_active = title_in_words(state.element), "", False
    for value, field in values_in_words(state).items():
        longer = f"{words or title}, {value}"
        if measure(longer, size)[0] > room:
            break
        words, has_active = longer, has_active or field == state.active.field
    return words if has_active else f"{title}, {value_in_words(state, state.active.field)}"


def value_at(state: State, x: int, y: int, width: int, size: int) -> Value | None:
    """Return the value that the line on top shows at pixel x, y, or its part there, such as a y; None beside values.

    width: of the window, in pixels. size: of the text, in pixels. For a colour it is the value as a whole.
    """
    line = fitting_words(state, width, size)
    for words, field in values_in_words(state).items():
        before, found, _ = line.partition(f", {words}")
        parts = words.split(",")
        # Pixels where the words begin, and where each part ends; the last part with the comma and the blank after it.
        start, *ends = (MARGIN + measure(f"{before}, {','.join(parts[:n])}", size)[0] for n in range(len(parts) + 1))
        ends[-1] = MARGIN + measure(f"{before}{found}, ", size)[0]
        if found and start <= x < ends[-1] and is_on_line(x, y, state, width, size):
            own = [each for each in values(state.element) if each.field == field]
            part = next(index for index, end in enumerate(ends) if x < end)
            first = own[0] if own else None  # also of a colour, of which one seldom changes a part alone
            return first if isinstance(field, Colour) else next((each for each in own if each.part == part), first)
    return None


def is_on_line(x: int, y: int, state: State, width: int, size: int) -> bool:
    """Whether a pixel is on the line on top of a window of a width: on its words or on its keys."""
    words = GAP.join((fitting_words(state, width, size), translated(hints(state, every=False))))
    right, bottom = measure(words, size)
    return x < min(width, MARGIN + right + PADDING) and y < MARGIN + bottom + PADDING


def last_lines(text: str, count: int) -> str:
    """Return the last lines of a text; with two or more, the first of them says that others are missing."""
    lines = text.split("\n")
    missing = len(lines) - count
    if missing > 0 and count > 1:
        return "\n".join([translated(f"... {missing + 1} more lines: miniRT -v"), *lines[missing + 1 :]])
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


def status(shown: Painted, rate: float = 0.0) -> str:
    """Return resolution, render time, samples done and wanted, error and ray rate of a picture."""
    job = shown.job
    coarse = " preview" if shown.preview else f" at 1/{job.divisor}" if job.divisor > 1 else ""
    time = f"    {shown.seconds * 1000:.1f} ms" if shown.seconds else ""
    samples = f"{job.samples} of {job.goal} samples" if job.goal > 1 else "1 sample"
    rays = f"    {rate / 1e6:.3g} million rays a second" if rate else ""
    error = f"    error {shown.error_estimate:.1g}" if shown.error_estimate else ""
    return f"{job.width}x{job.height}{coarse}{time}    {samples}{error}{rays}"


def wrap(text: str, width: int, size: int) -> str:
    """Wrap text, of `size` pixels, so that it leaves a margin in a picture of that width.

    Lines break between groups of words, and within a group where that is too long. They keep at least about ten
    letters, even if these do not fit.
    """
    lines, room = list[str](), width - 2 * MARGIN
    for line in text.split("\n"):
        groups = line.split(GAP)
        fitting = groups[0]
        for group in groups[1:]:
            longer = f"{fitting}{GAP}{group}"
            if measure(longer, size)[0] > room:
                lines.append(fitting)
                longer = group
            fitting = longer
        lines.append(fitting)
    return "\n".join(wrap_words(line, room, size) for line in lines)


def wrap_words(line: str, room: int, size: int) -> str:
    """Wrap a line between words so that it fits into so many pixels; lines keep at least about ten letters."""
    letters, wrapped = len(line), line
    while letters > 10 and measure(wrapped, size)[0] > room:
        letters = letters * 9 // 10
        wrapped = textwrap.fill(line, letters)
    return wrapped


def fit_width(text: str, width: int, size: int) -> str:
    """Drop groups of words from the end until the text fits on a line; wrap the first group if it does not fit."""
    while measure(text, size)[0] > width - 2 * MARGIN and GAP in text:
        text = text.rpartition(GAP)[0]
    return wrap(text, width, size)


def draw_lines(pixels: Pixels, y: int, text: str, colour: int, size: int, left: int = 0) -> None:
    """Draw text at the left border, or `left` pixels from it; `y` is its top, or if negative the distance of its end
    from the bottom."""
    top = y if y >= 0 else pixels.shape[0] + y - measure(text, size)[1]
    draw_text(pixels, left + MARGIN, top, text, colour, size=size, background=BACKGROUND, padding=PADDING)


def hints(state: State, every: bool) -> str:
    """Present meanings of keys, the most useful first: `+ - diameter`. `every`: also what is as usual."""
    groups = [f"+ - {state.active.name}", "V: next value"]
    if state.others:
        groups.insert(0, f"{len(state.chosen)} elements selected")
    if every or state.frame is not MoveAxes.VIEW:
        groups.append(f"X: move {'in the ' if state.frame is MoveAxes.VIEW else 'along the '}{state.frame.value}")
    return GAP.join([*groups, "H: help"])


def draw_tab(pixels: Pixels, size: int) -> None:
    """Draw the tab at the right edge that opens the panel."""
    width, height = measure(TAB, size)
    left, top = pixels.shape[1] - width - PADDING, (pixels.shape[0] - height) // 2
    draw_on_dark(pixels, left, top, TAB, MESSAGE_COLOUR, size=size)
