"""The viewer in JupyterLab, in a real browser: keys and the mouse move a ball, and the pixels show it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.notebook.jupyterlab import ViewerInPage, opened
from tests.notebook.requirements import require, written
from tests.waiting import until

pytestmark = pytest.mark.slow
WIDTH, HEIGHT = 320, 180
SCENE = "A 1 255,255,255\nC 0,0,-10 0,0,1 40\nsp 0,0,0 2 255,0,0\n"  # a red disc on black, without shades
CELL = f"""
import minirt
viewer = minirt.view(minirt.loads({SCENE!r}), ({WIDTH}, {HEIGHT}))  # without a display: in the notebook
viewer
"""


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ViewerInPage]:
    """Fixture: a viewer in JupyterLab."""
    require("anywidget", "jupyterlab", "ipykernel")
    folder: Path = tmp_path_factory.mktemp("lab")
    with opened(written(folder / "ball.ipynb", CELL), folder) as page:
        yield ViewerInPage(page)


def ball(viewer: ViewerInPage) -> tuple[float, float, int]:
    """Return the centre of the red pixels, and their number; nothing else in the frame is red."""
    pixels = viewer.pixels()
    rows, columns = np.nonzero((pixels[..., 0] > 128) & (pixels[..., 1:].max(axis=-1) < 80))
    return (float(columns.mean()), float(rows.mean()), len(rows)) if len(rows) else (0.0, 0.0, 0)


def test_a_key_and_a_drag_move_the_ball_and_escape_gives_the_keyboard_back(viewer: ViewerInPage) -> None:
    until(lambda: ball(viewer)[2] > 100, "the ball")
    x, y, size = ball(viewer)
    assert abs(x - WIDTH / 2) < 2
    assert abs(y - HEIGHT / 2) < 2

    viewer.press("d", "KeyD")  # before a click the notebook has the keyboard
    assert not viewer.has_focus()
    viewer.drag((WIDTH / 2, HEIGHT / 2), (WIDTH / 2, HEIGHT / 2))  # a click selects the ball
    until(viewer.has_focus, "the focus")
    assert abs(ball(viewer)[0] - x) < 2

    viewer.drag((WIDTH / 2, HEIGHT / 2), (WIDTH / 2 - 60, HEIGHT / 2))
    dragged = x - 60 * 9 / 10  # the point at the distance 9 follows the pointer, and the centre is at 10
    until(lambda: abs(ball(viewer)[0] - dragged) < 4, "the ball where it was dragged")
    assert abs(ball(viewer)[2] - size) < 0.1 * size

    viewer.press("d", "KeyD")
    until(lambda: ball(viewer)[0] > dragged + 6, "the ball on the right")

    viewer.press("Escape", "Escape")
    until(lambda: not viewer.has_focus(), "the end of the focus")
    assert viewer.page.complaints == []
