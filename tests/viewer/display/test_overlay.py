"""Text over the picture: HUD, messages, help."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

import minirt
from minirt.mlx.text import measure
from minirt.viewer.bindings import BINDINGS, FINE_NOTE
from minirt.viewer.display.help_pages import Column, draw_help, help_pages, width_of
from minirt.viewer.display.jobs import Painted, PaintJob
from minirt.viewer.display.overlay import (
    MARGIN,
    MESSAGE_COLOUR,
    PADDING,
    HudLevel,
    bracketed,
    draw_hud,
    draw_lines,
    element_line,
    fit_width,
    fitting_words,
    last_lines,
    overlay_scale,
    status,
    text_size,
    wrap,
)
from minirt.viewer.display.words import colour_word
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import initial_state
from minirt.viewer.language import GAP
from tests.paths import ROOT
from tests.viewer.fake import TEXT, scene
from tests.viewer.session_harness import SessionHarness

SIZES = [(320, 240), (640, 480), (1280, 720), (1900, 300), (3840, 2160)]
DARK = 255 // 4
SHINY = "A 1 9,9,9\nC 0,0,9 0,0,-1 60\nsp 0,0,0 2 9,9,9 specular:0.5,20\n"


def blank(width: int = 640, height: int = 480):
    """Return a white picture."""
    return np.full((height, width, 4), 255, np.uint8)


@pytest.mark.parametrize(
    ("actions", "text"),
    [
        ([], "C 0,0,10 0,0,-1 [90]"),
        (["next value"], "C 0,0,10 0,0,-1 90 [roll:0]"),
        (["roll right"], "C 0,0,10 0,0,-1 [90] roll:5"),
        (["turn right"], "C 0,0,10 0.0871557,0,-0.996195 [90]"),
        (["select next", "select next"], "sp 0,0,0 [2] 255,0,0"),
        (["select next", "select next", "next value"], "sp 0,0,0 2 [255,0,0]"),
        (["select previous", "shrink"], "A [0.15] 255,255,255"),
        (["select next", *["next value"] * 2], "sp 0,0,0 2 9,9,9 [specular:0.5],20"),
        (["select next", *["next value"] * 3], "sp 0,0,0 2 9,9,9 specular:0.5,[20]"),
    ],
)
def test_the_line_of_the_selected_element_marks_the_active_value(actions, text):
    state = initial_state(scene(SHINY if "specular" in text else TEXT))
    for action in actions:
        state = apply(state, action)
    assert element_line(state) == text


@pytest.mark.parametrize(
    ("actions", "text"),
    [
        ([], "camera, fov [90], position 0,0,10, direction 0,0,-1"),
        (["next value"], "camera, fov 90, roll [0], position 0,0,10, direction 0,0,-1"),
        (["select previous", "shrink"], "white ambient light, brightness [0.15], colour 255,255,255"),
        (["select next"], "white light, brightness [0.5], position 5,5,5, colour 255,255,255"),
        (["select next"] * 2, "red sphere, diameter [2], centre 0,0,0, colour 255,0,0"),
        (["select next"] * 2 + ["next value"] * 2, "red sphere, diameter 2, centre 0,0,0, colour [255],0,0"),
        (["select next"] * 4, "blue cylinder, diameter [1], height 4, centre 3,0,0, colour 0,0,255, axis 0,1,0"),
        (
            ["select next", *["next value"] * 3],
            "black sphere, diameter 2, specular 0.5,[20], centre 0,0,0, colour 9,9,9",
        ),
    ],
)
def test_words_say_what_is_selected_and_at_least_its_active_value(actions, text):
    state = initial_state(scene(SHINY if "specular" in text else TEXT))
    for action in actions:
        state = apply(state, action)
    assert fitting_words(state, 10_000, 16) == text
    title, *words = text.split(", ")
    (active,) = (each for each in words if "[" in each)
    assert fitting_words(state, 100, 16) == f"{title}, {active}"


def test_words_are_translated_and_the_colour_follows_in_french(monkeypatch):
    monkeypatch.setenv("LANGUAGE", "fr")
    state = apply(apply(initial_state(scene()), "select next"), "select next")
    assert fitting_words(state, 10_000, 16) == "sphère (rouge), diamètre [2], centre 0,0,0, couleur 255,0,0"


@pytest.mark.parametrize("language", ["en", "fr"])
@pytest.mark.parametrize("name", ["demo", "gallery-table", "material-patterns"])
def test_all_words_are_one_line_of_a_usual_window(monkeypatch, language, name):
    monkeypatch.setenv("LANGUAGE", language)
    state = initial_state(minirt.load(ROOT / f"scenes/{name}.rt"))
    for index in range(len(state.scene.elements)):
        pixels = blank(1280, 720)
        draw_hud(pixels, state.select(index), Painted(PaintJob(state.scene, 1280, 720)), HudLevel.LINE, 0.0, 16)
        changed = (pixels != 255).any(axis=(1, 2))
        assert changed[:20].any()
        assert not changed[40:].any()


def test_colours_have_the_words_of_their_nearest_ones():
    colours = [(255, 0, 0), (128, 0, 0), (38, 54, 92), (255, 128, 0), (240, 240, 240), (0, 255, 0), (255, 192, 203)]
    words = ["red", "dark red", "dark blue", "orange", "white", "green", "pink"]
    assert [colour_word(each) for each in colours] == words


def test_brackets_are_around_one_component_or_the_whole_value():
    texts = [bracketed("a,b,c", part) for part in (None, 0, 1, 2, 3)]
    assert texts == ["[a,b,c]", "[a],b,c", "a,[b],c", "a,b,[c]", "[a,b,c]"]


def test_the_status_line():
    job = PaintJob(scene(), 640, 480)
    assert status(Painted(job, seconds=0.0123)) == "640x480    12.3 ms    1 sample"
    assert status(Painted(PaintJob(job.scene, 640, 480, 4, goal=16))) == "640x480 at 1/4    1 of 16 samples"
    assert status(Painted(replace(job, samples=4, goal=16), seconds=0.0123)) == "640x480    12.3 ms    4 of 16 samples"


def test_the_hud_leaves_the_middle_free():
    pixels = blank()
    shown = Painted(PaintJob(scene(), 640, 480), about=("two threads", "without three planes"))
    bottom = draw_hud(pixels, initial_state(scene()), shown, HudLevel.ALL, 2e8, 16)
    changed = (pixels != 255).any(axis=(1, 2))
    assert changed[:60].any()
    assert changed[-60:].any()
    assert not changed[80:-90].any()
    assert not changed[240 : -10 - bottom].any()
    assert changed[-10 - bottom : -5 - bottom].any()


@pytest.mark.parametrize("selected", ["select next", "next kind"])
@pytest.mark.parametrize(("width", "height"), [(1280, 720), (640, 480), (320, 240), (1900, 300), (3840, 2160)])
def test_the_full_information_covers_at_most_a_third_of_the_picture(width, height, selected):
    pixels = blank(width, height)
    text = "A 1 9,9,9\nC 0,0,9 0,0,-1 60\nsp 0,0,0 2 9,9,9 specular:0.5,20 mirror:0.123456 glass:1.5,0.25\n"
    state = initial_state(scene(text if selected == "next kind" else TEXT))
    for _ in range(2):
        state = apply(state, "select next")
    size = text_size(width, height, overlay_scale(width, height, 1.0, 1.0))
    shown = Painted(
        PaintJob(state.scene, width, height), about=tuple(f"plane {n} hides nothing from light 1" for n in range(99))
    )
    bottom = draw_hud(pixels, state, shown, HudLevel.ALL, 2e8, size)
    covered = (pixels != 255).any(axis=2).sum()
    assert 0 < covered <= width * height / 3
    assert bottom > 2 * PADDING


def test_lines_that_are_left_out_are_counted():
    assert last_lines("a\nb\nc", 3) == "a\nb\nc"
    assert last_lines("a\nb\nc\nd", 3) == "... 2 more lines: miniRT -v\nc\nd"
    assert last_lines("a\nb\nc", 1) == "c"


def test_a_message_is_wrapped_and_drawn_above_the_status():
    pixels = blank(300, 200)
    draw_lines(pixels, -MARGIN - 27, wrap("a very long message " * 10, 300, 16), MESSAGE_COLOUR, 16)
    changed = (pixels != 255).any(axis=2)
    assert changed[:-30].any()
    assert not changed[-30:].any()
    assert not changed[:, -5:].any()


def test_groups_of_words_are_dropped_from_a_line_that_is_a_pixel_too_long():
    text = "640x480    12.3 ms    1 sample"
    width = measure(text, 16)[0] + 2 * MARGIN
    assert fit_width(text, width, 16) == text
    assert fit_width(text, width - 1, 16) == "640x480    12.3 ms"


@pytest.mark.parametrize(
    ("size", "screen", "wanted", "pixels"),
    [
        ((1280, 720), 1.0, 1.0, 16),
        ((1920, 1080), 1.0, 1.0, 16),
        ((3840, 2160), 1.0, 1.0, 32),  # a large window
        ((3840, 2160), 2.0, 1.0, 32),  # the same on a screen with small dots
        ((3840, 1080), 1.0, 1.0, 16),  # a wide one
        ((1280, 720), 1.0, 1.5, 24),
        ((1280, 720), 1.0, 9.0, 40),  # room for 18 lines stays
        ((320, 240), 1.0, 0.5, 8),
    ],
)
def test_text_grows_with_the_window_the_screen_and_the_wish(size, screen, wanted, pixels):
    assert text_size(*size, overlay_scale(*size, screen, wanted)) == pixels


# Pages of the help: every row is shown, readable and within the window, whatever its size.


def table(width: int, height: int, search: str = "") -> tuple[int, list[list[Column]]]:
    """Return the size of the text and the pages of the help of a window of that size."""
    return help_pages("qwerty", search, width, height, text_size(width, height, overlay_scale(width, height, 1, 1)))


def drawn(width: int, height: int, number: int) -> NDArray[np.uint8]:
    """Draw a page over a white picture."""
    pixels = np.full((height, width, 4), 255, np.uint8)
    draw_help(pixels, "qwerty", "", text_size(width, height, overlay_scale(width, height, 1, 1)), number)
    return pixels


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_every_row_is_on_some_page(width: int, height: int) -> None:
    columns = [column for page in table(width, height)[1] for column in page]
    shown = " ".join(help for _, help in columns).split()
    texts = [*(binding.help for binding in BINDINGS), FINE_NOTE[1]]
    assert shown == " ".join(texts).split()
    assert {line.strip() for keys, _ in columns for line in keys.split("\n")} >= {
        "Left",
        "Shift+Tab",
        "Select",
        "Window",
    }


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_all_pages_and_their_text_fit_the_window_and_do_not_overlap(width: int, height: int) -> None:
    size, pages = table(width, height)
    footer = height - 5 - measure(" ", size)[1]
    for number, page in enumerate(pages, 1):
        assert width_of(page, size) <= width
        assert not any(keys.split("\n")[-1] and not help.split("\n")[-1] for keys, help in page)  # a title
        used = max(measure(keys, size)[1] for keys, _ in page) + 10
        assert used <= footer + size // 3  # the last line's blank below may be used
        lit = (drawn(width, height, number)[..., :3] > DARK).any(axis=2)
        assert lit.any()
        assert not lit[:, -4:].any()
        assert not lit[-2:].any()


@pytest.mark.parametrize(("size", "pages", "least"), [((320, 240), 8, 11), ((640, 480), 3, 11), ((1280, 720), 1, 12)])
def test_there_are_few_pages_of_readable_text(size: tuple[int, int], pages: int, least: int) -> None:
    text_size, shown = table(*size)
    assert len(shown) <= pages
    assert text_size >= least


@pytest.mark.parametrize(("width", "height"), [(200, 100), (40, 300), (1, 1)])
def test_tiny_windows_have_some_help(width: int, height: int) -> None:
    for number in (1, 5, 10**6):
        assert drawn(width, height, number)[..., :3].min() == DARK


def test_arrows_and_the_wheel_turn_the_pages() -> None:
    harness = SessionHarness()
    session = harness.session
    harness.play("resize 320x240", "press h")
    last = len(table(320, 240)[1])
    assert last > 2
    for key, page in (("Right", 2), ("Left", 1), ("PageUp", 1), ("Down", 2), ("Return", 3)):
        harness.play(f"press {key}")
        assert session.screen.help == page
    harness.play("wheel up")
    assert session.screen.help == 2
    harness.play(f"wheel down {last}")
    assert session.screen.help == last


@pytest.mark.parametrize(
    "close", ["press h", "press Escape", "press ?", "click 9,9", "click 9,9 right", "drag 9,9 30,9"]
)
@pytest.mark.parametrize("turns", [0, 2])
def test_the_help_closes_at_once_from_any_page(close: str, turns: int) -> None:
    harness = SessionHarness()
    harness.play("resize 320x240", "press h", *["press Right"] * turns, close)
    session = harness.session
    assert session.screen.help == 0
    assert session.state == SessionHarness().session.state  # which the click did not change
    harness.play("press h")
    assert session.screen.help == 1


def test_letters_search_the_help() -> None:
    harness = SessionHarness()
    screen = harness.session.screen
    harness.play("press h", "press Right", "text d", "press d", "press u", "press p")
    assert (screen.help, screen.search) == (1, "dup")
    rows = [keys for page in table(640, 480, "dup")[1] for keys, _ in page]
    assert "Ctrl+D" in " ".join(rows)
    assert "Ctrl+S" not in " ".join(rows)
    assert len(table(640, 480, "build")[1][0][0][0].split("\n")) > 5  # the title of a group finds all of it
    harness.play("press Backspace", "text 3", "press Escape", "press h")
    assert (screen.help, screen.search) == (1, "")
    assert screen.list_box is None  # nothing was typed as a value


@pytest.mark.parametrize("width", [120, 200, 300, 400, 640, 1280])
def test_lines_are_wrapped_between_groups_of_words_where_these_fit(width: int) -> None:
    groups = ["drag an object to move it", "wheel: zoom", "L: the light", "Ctrl+S: save"]
    lines = wrap(GAP.join(groups), width, 16).split("\n")
    assert max(measure(line, 16)[0] for line in lines) <= max(width - 2 * MARGIN, measure("w" * 10, 16)[0])
    assert " ".join(lines).split() == " ".join(groups).split()
    for group in groups:
        fits = measure(group, 16)[0] <= width - 2 * MARGIN
        assert fits == any(group in line.split(GAP) for line in lines)
    for line, following in pairwise(lines):
        if line.split(GAP)[-1] in groups and following.split(GAP)[0] in groups:
            assert measure(line + GAP + following.split(GAP)[0], 16)[0] > width - 2 * MARGIN
