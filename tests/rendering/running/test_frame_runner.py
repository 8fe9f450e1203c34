"""Running frames on threads: cancelling, and errors of single threads."""

from __future__ import annotations

from itertools import count

import numpy as np
import pytest

from minirt.kernel.frame import CANCELLED
from minirt.rendering import Renderer
from minirt.rendering.running import frame_runner
from tests.kernel.pictures import ALL, picture
from tests.rendering.cancelling import ENDLESS, SAMPLES, cancelled
from tests.waiting import until


def test_cancelling_ends_a_long_frame_and_the_next_is_right() -> None:
    renderer = Renderer(2)
    expected, _ = picture(ALL, 64, 48)
    renderer.prepare(ALL)
    pixels = np.zeros((*ENDLESS, 4), np.uint8)
    assert not cancelled(renderer, lambda: renderer.render(ALL, pixels, SAMPLES))
    pixels = np.zeros((48, 64, 4), np.uint8)
    assert renderer.render(ALL, pixels)
    assert np.array_equal(pixels, expected)


def test_cancelling_when_nothing_is_rendered_does_nothing() -> None:
    renderer = Renderer(1)
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))


def test_the_seconds_of_a_frame_are_counted_for_its_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, counted = Renderer(1), list[float]()
    renderer.prepare(ALL)
    times = iter((7.0, 7.25))
    monkeypatch.setattr(frame_runner, "perf_counter", lambda: next(times))
    monkeypatch.setattr(renderer.kernels, "count", lambda _choice, seconds: counted.append(seconds))
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
    assert counted == [0.25]


def test_an_error_in_one_thread_reaches_the_caller() -> None:
    renderer = Renderer(3)
    renderer.prepare(ALL)
    turns, stopped = count(1), list[int]()

    class Rows:
        def run(self, words: list[int]) -> None:
            turn = next(turns)
            if turn == 2:
                raise ValueError("out of order")
            until(lambda: renderer.runner.next_row[0] >= CANCELLED, "the end of the other threads")
            stopped.append(turn)

    choose = renderer.kernels.choose
    renderer.kernels.choose = lambda frame: choose(frame)._replace(entry=Rows())
    with pytest.raises(ValueError, match="out of order"):
        renderer.render(ALL, np.zeros((40, 40, 4), np.uint8))
    assert sorted(stopped) == [1, 3]
    renderer.kernels.choose = choose
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
