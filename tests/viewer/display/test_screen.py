"""Messages and banners in the window, at every amount of other words."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from minirt.mlx.text import measure
from minirt.viewer.app import session
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, HudLevel, text_size
from minirt.viewer.display.screen import GRID_COLOUR
from minirt.viewer.editing.state import initial_state
from tests.processes import run
from tests.viewer.fake import played, scene
from tests.viewer.session_harness import SessionHarness

WIDTH, HEIGHT = 640, 480
TEXT = "saved scene.rt"
PROGRAM = """
from threading import Thread
import numpy as np
from minirt.viewer.app import session
from minirt.viewer.display import screen
from tests.usage import Usage

def work():
    np.ones(2 * 2**20)  # glibc takes blocks up to this size from the heap afterwards
    blocks = [np.ones(2**17) for _ in range(100)]  # a mebibyte each
    kept.extend(blocks[::10])

kept = []
thread = Thread(target=work)
thread.start()
thread.join()
usages = [Usage.of().memory]
screen.give_back_memory()
usages.append(Usage.of().memory)
print(usages[0] - usages[1], sum(block.nbytes for block in kept), all((block == 1).all() for block in kept))
"""


def shown(level: HudLevel, message: str = "", banner: str = "", help: bool = False) -> Pixels:
    """Return the frame of a window that shows a picture and these words."""
    harness = SessionHarness()
    harness.memory.resize(WIDTH, HEIGHT)
    harness.memory.play()
    harness.finish(0.001)
    session = harness.session
    session.screen.level, session.screen.banner, session.screen.help = level, banner, help
    session.screen.draw(session.state.with_message(message), session.refinement.latest)
    return session.screen.frame


def says_it_above_other_words(level: HudLevel, help: bool = False, **words: str) -> bool:
    """Whether words are the only change of a frame: as many pixels wide as their text, and above the other words."""
    without, frame = shown(level, help=help), shown(level, help=help, **words)
    rows, columns = np.nonzero((without != frame).any(axis=2))
    if not rows.size:
        return False
    size = text_size(WIDTH, HEIGHT, 1.0)
    colour = np.array([MESSAGE_COLOUR >> shift & 255 for shift in (0, 8, 16)])
    wide = columns.max() + 1 - MARGIN
    bottom_free = level != HudLevel.ALL or rows.max() < HEIGHT - MARGIN - size  # the last line has words then
    return bool((frame[rows, columns, :3] == colour).all(axis=1).any() and bottom_free) and (
        abs(wide - measure(TEXT, size)[0]) <= size
    )


@pytest.mark.parametrize("level", HudLevel)
@pytest.mark.parametrize("words", [{"message": TEXT}, {"banner": TEXT}, {"message": TEXT, "banner": "other"}])
def test_messages_and_banners_stand_above_other_words(level: HudLevel, words: dict[str, str]) -> None:
    assert says_it_above_other_words(level, **words)


def test_no_message_covers_the_help() -> None:
    assert (shown(HudLevel.LINE, TEXT, TEXT, help=True) == shown(HudLevel.LINE, help=True)).all()


def test_tips_are_shown_until_the_first_edit() -> None:
    """Looking around and selecting is no edit, and a message stands above them."""
    harness = SessionHarness()
    screen = harness.session.screen
    screen.tips = True
    harness.play("resize 500x333", "press C", "press d", "press Tab", "press Tab")
    harness.finish(0.001)
    assert screen.tips
    tops = []
    for message in ("", TEXT):
        frames = []
        for screen.tips in (True, False):
            screen.draw(harness.session.state.with_message(message), harness.session.refinement.latest)
            frames.append(screen.frame.copy())
        rows, _ = np.nonzero((frames[0] != frames[1]).any(axis=2))
        assert rows.max() > 315
        tops.append(rows.min())
    assert 200 < tops[1] < tops[0]
    screen.tips = True
    harness.play("press d")
    assert not screen.tips


@pytest.mark.parametrize("height", [0.0, 3.0, -3.0])
def test_a_scene_without_shapes_shows_the_horizon_and_a_grid_on_the_ground_that_no_picture_has(height: float) -> None:
    """The camera looks along -z: the horizon is in the middle, the ground below it or, from below, above it."""
    harness = SessionHarness()
    session = harness.session
    harness.play(f"resize {WIDTH}x{HEIGHT}")
    session.show(initial_state(scene(f"A 0.2 255,255,255\nC 0,{height},9 0,0,-1 70\n")))
    while harness.painter.busy:
        harness.finish(0.001)
    session.screen.level = HudLevel.LINE
    session.draw()
    assert (session.picture == session.picture[0, 0]).all()
    is_grid = (session.screen.frame == GRID_COLOUR).all(axis=2)[60:-60]  # without words
    rows = np.flatnonzero(is_grid.any(axis=1)) + 60
    assert is_grid[HEIGHT // 2 - 60].all()
    assert set(np.sign(rows // 2 - HEIGHT // 4)) - {0} == ({np.sign(height)} - {0})
    harness.play("press N")
    harness.finish(0.001)
    assert not (session.screen.frame == GRID_COLOUR).all(axis=2).any()


def test_the_colour_of_the_sky_is_there_before_the_first_picture() -> None:
    harness = SessionHarness()
    screen = harness.session.screen
    harness.play(f"resize {WIDTH}x{HEIGHT}")
    for line, colour in (("", (0, 0, 0)), ("bg 150,190,235\n", (235, 190, 150))):
        screen.draw(initial_state(scene(f"A 0.2 255,255,255\nC 0,0,9 0,0,-1 70\n{line}")), None)
        assert tuple(screen.frame[HEIGHT // 2, WIDTH // 2, :3]) == colour


# Memory that is given back to the system: once after each resize or reload, and really.


@pytest.mark.skipif(sys.platform != "linux", reason="only glibc can give memory back")
def test_free_blocks_between_used_ones_are_given_back() -> None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}  # set by dask
    done = run([sys.executable, "-c", PROGRAM], text=True, env=environment)
    given_back, kept, are_whole = done.stdout.split()
    assert done.returncode == 0, done.stderr
    assert int(given_back) > 80e6
    assert int(kept) == 10 * 2**20
    assert are_whole == "True"


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["press d", "press T", "click 5,5", "wait 1"], 0),
        (["resize 40x30", "wait 1", "press d", "wait 1"], 1),
        (["press Ctrl+S", "press d", "wait 1", "press Ctrl+R", "wait 1", "press d", "wait 1"], 1),
        (["resize 40x30", "wait 1", "press d", "resize 64x48", "wait 1", "press d", "wait 1"], 2),
    ],
)
def test_memory_is_given_back_once_after_a_resize_or_a_reload(
    lines: list[str], expected: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    calls: list[None] = []
    monkeypatch.setattr(session, "give_back_memory", lambda: calls.append(None))
    played(*lines, path=tmp_path / "scene.rt")
    assert len(calls) == expected
