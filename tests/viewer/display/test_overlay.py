"""Text over the picture: HUD, messages, help."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from minirt.mlx.text import measure
from minirt.viewer.display import overlay
from minirt.viewer.display.overlay import (
    MARGIN,
    HudLevel,
    bracketed,
    draw_help,
    draw_hud,
    draw_message,
    element_line,
    fit_width,
    status,
    text_size,
)
from minirt.viewer.display.painter import Job, Outcome
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import initial_state
from tests.viewer.fake import scene


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
    ],
)
def test_the_line_of_the_selected_element_marks_the_active_value(actions, text):
    state = initial_state(scene())
    for action in actions:
        state = apply(state, action)
    assert element_line(state) == text


def test_the_active_part_of_a_material_is_marked():
    state = initial_state(scene("A 1 9,9,9\nC 0,0,9 0,0,-1 60\nsp 0,0,0 2 9,9,9 specular:0.5,20\n"))
    lines = []
    for action in ["select next", *["next value"] * 3]:
        state = apply(state, action)
        lines.append(element_line(state))
    assert "sp 0,0,0 2 9,9,9 [specular:0.5],20" in lines
    assert "sp 0,0,0 2 9,9,9 specular:0.5,[20]" in lines


@pytest.mark.parametrize(
    ("part", "text"), [(None, "[a,b,c]"), (0, "[a],b,c"), (1, "a,[b],c"), (2, "a,b,[c]"), (3, "[a,b,c]")]
)
def test_brackets_are_around_one_component_or_the_whole_value(part, text):
    assert bracketed("a,b,c", part) == text


def test_the_status_line():
    job = Job(scene(), 640, 480)
    assert status(Outcome(job, seconds=0.0123)) == "640x480    12.3 ms    1 sample"
    assert status(Outcome(Job(job.scene, 640, 480, 4, goal=16))) == "640x480 at 1/4    1 of 16 samples"
    assert status(Outcome(replace(job, samples=4, goal=16), seconds=0.0123)) == "640x480    12.3 ms    4 of 16 samples"


def test_the_hud_leaves_the_middle_free():
    pixels = blank()
    shown = Outcome(Job(scene(), 640, 480), about=("two threads", "without three planes"))
    bottom = draw_hud(pixels, initial_state(scene()), shown, HudLevel.ALL, 2e8, 16)
    changed = (pixels != 255).any(axis=(1, 2))
    assert changed[:60].any()
    assert changed[-60:].any()
    assert not changed[80:-90].any()
    assert not changed[240 : -10 - bottom].any()
    assert changed[-10 - bottom : -5 - bottom].any()


def test_many_notes_fill_at_most_half_of_the_window():
    pixels = blank()
    shown = Outcome(Job(scene(), 640, 480), about=tuple(f"plane {n} hides nothing from light 1" for n in range(99)))
    draw_hud(pixels, initial_state(scene()), shown, HudLevel.ALL, 0.0, 16)
    assert (pixels[80:200] == 255).all()
    assert (pixels[260:460] != 255).any(axis=(1, 2)).all()


def test_the_line_level_draws_one_line():
    pixels = blank()
    assert draw_hud(pixels, initial_state(scene()), Outcome(Job(scene(), 640, 480)), HudLevel.LINE, 0.0, 16) == 0
    changed = (pixels != 255).any(axis=(1, 2))
    assert changed[:20].any()
    assert not changed[40:].any()
    assert draw_hud(blank(), initial_state(scene()), None, HudLevel.NOTHING, 0.0, 16) == 0


def test_a_message_is_wrapped_and_drawn_above_the_status():
    pixels = blank(300, 200)
    draw_message(pixels, "a very long message " * 10, 27, 16)
    changed = (pixels != 255).any(axis=2)
    assert changed[:-30].any()
    assert not changed[-30:].any()
    assert not changed[:, -5:].any()
    pixels = blank()
    draw_message(pixels, "", 0, 16)
    assert (pixels == 255).all()


def test_the_columns_of_the_help_are_side_by_side(monkeypatch):
    drawn = []
    monkeypatch.setattr(overlay, "draw_text", lambda _, x, y, text, colour, size: drawn.append((x, text, size)))
    draw_help(blank(), "qwerty", 16)
    ends = [x + measure(text, size)[0] for x, text, size in drawn]
    assert all(end < x for end, (x, _, _) in zip(ends, drawn[1:], strict=False))
    assert len(drawn) == 4
    assert ends[-1] <= 640 - MARGIN


def test_groups_of_words_are_dropped_from_a_line_that_is_a_pixel_too_long():
    text = "640x480    12.3 ms    1 sample"
    width = measure(text, 16)[0] + 2 * MARGIN
    assert fit_width(text, width, 16) == text
    assert fit_width(text, width - 1, 16) == "640x480    12.3 ms"


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (640, 480), (200, 100), (1, 1)])
def test_the_help_fits_the_window(width, height):
    pixels = blank(width, height)
    draw_help(pixels, "qwerty", text_size(width, height, 1.0))
    assert pixels[..., :3].min() == 255 // 4  # darkened, with letters that are lighter
    if width >= 640:
        border = np.concatenate([pixels[-5:].reshape(-1, 4), pixels[:, -5:].reshape(-1, 4)])
        assert (border[:, :3] == 255 // 4).all()
        assert (pixels[..., :3] > 255 // 4).any()
