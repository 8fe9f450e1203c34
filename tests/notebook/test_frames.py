"""No more than two frames are under way, the last one is the finest, and a slow page gets the newest."""

from __future__ import annotations

import io

import numpy as np
from PIL import Image

from minirt.notebook.page_back_end import AHEAD, COARSE, FINE, QUIET, FrameStream, encode

GRADIENT = np.dstack([np.add.outer(np.arange(64), np.arange(96) + shift).astype(np.uint8) for shift in (0, 20, 60, 0)])


class PageOfFrames:
    """A page that keeps frames, and shows them when it is told to."""

    def __init__(self) -> None:
        self.frames: list[tuple[int, bytes]] = []
        self.stream = FrameStream(lambda number, data: self.frames.append((number, data)))

    def show_all(self) -> None:
        for number, _ in self.frames:
            self.stream.acknowledge(number)


def test_frames_wait_for_a_page_that_shows_none() -> None:
    page = PageOfFrames()
    assert [page.stream.offer(GRADIENT, 0.0) for _ in range(4)] == [True] * AHEAD + [False] * (4 - AHEAD)
    page.stream.acknowledge(page.frames[0][0])
    assert [page.stream.offer(GRADIENT, 0.0) for _ in range(2)] == [True, False]
    page.stream.restart()
    assert page.stream.offer(GRADIENT, 0.0)


def test_a_page_cannot_acknowledge_what_was_not_sent() -> None:
    page = PageOfFrames()
    page.stream.acknowledge(1000)
    assert [page.stream.offer(GRADIENT, 0.0) for _ in range(3)] == [True, True, False]


def test_the_last_frame_is_sent_again_in_finer_quality_once() -> None:
    page = PageOfFrames()
    page.stream.offer(GRADIENT, 1.0)
    assert page.stream.patience(1.0) is None  # the page has not shown it: its answer comes as an event
    page.show_all()
    assert page.stream.patience(0.0) == 1.0 + QUIET
    page.stream.sharpen(GRADIENT, 1.0 + QUIET / 2)
    assert len(page.frames) == 1
    page.stream.sharpen(GRADIENT, 1.0 + QUIET)
    page.show_all()
    page.stream.sharpen(GRADIENT, 1.0 + 2 * QUIET)
    assert [data for _, data in page.frames] == [encode(GRADIENT, COARSE), encode(GRADIENT, FINE)]
    assert page.stream.patience(2.0) is None


def test_frames_have_the_colours_of_the_picture() -> None:
    for quality, allowed in ((FINE, 3), (COARSE, 12)):
        shown = np.asarray(Image.open(io.BytesIO(encode(GRADIENT, quality)))).astype(int)
        error = np.abs(shown - GRADIENT[..., 2::-1])
        assert error.mean() < allowed
        assert np.abs(shown - GRADIENT[..., :3]).mean() > 20  # red and blue are not swapped
