"""Messages and banners in the window, at every amount of other words."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.mlx.text import measure
from minirt.viewer.display import screen
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, HudLevel, text_size
from minirt.viewer.display.painter import Pixels
from tests.viewer.session_harness import SessionHarness

WIDTH, HEIGHT = 640, 480
TEXT = "saved scene.rt"


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


def test_help_leaves_a_message_visible() -> None:
    assert (shown(HudLevel.LINE, TEXT, help=True) != shown(HudLevel.LINE, help=True)).any()


def test_a_message_that_is_not_drawn_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(screen, "draw_message", lambda *_: None)
    assert not says_it_above_other_words(HudLevel.LINE, message=TEXT)
