"""Cancels a renderer once it has begun a picture."""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread
from typing import TypeVar

from minirt.kernel.frame import CANCELLED
from minirt.rendering import Renderer
from tests.waiting import HANG_LIMIT, until

ENDLESS = (32, 65536)  # height and width: two rows of tiles, one for each thread, which are never done
SAMPLES = 50_000  # a pixel: a quarter of an hour for a thread that traces 50 million rays a second

Answer = TypeVar("Answer")


def cancelled(renderer: Renderer, work: Callable[[], Answer]) -> Answer:
    """Run `work`, which makes `renderer` render, cancel it when its first row has begun, and return its answer."""
    before, answers = renderer.runner.next_row, list[Answer]()
    thread = Thread(target=lambda: answers.append(work()), daemon=True)
    thread.start()
    until(lambda: renderer.runner.next_row is not before and renderer.runner.next_row[0] > 0, "the first row")
    assert renderer.runner.next_row.max() < CANCELLED
    renderer.cancel()
    thread.join(HANG_LIMIT)
    (answer,) = answers
    return answer
