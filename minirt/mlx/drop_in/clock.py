"""Simulated time: the functions of the module `time`, for a program whose loop runs without a screen."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

READING = 1e-6  # seconds that pass with each reading, so that a loop that waits for a time ends


def simulate_time(now: Callable[[], float], advance: Callable[[float], None]) -> None:
    """Replace the clocks by `now`, and sleeping in the main thread by `advance`; other threads sleep as usual.

    Call it before the program is imported, which may import the functions by their names.
    """
    start, sleep = time.time(), time.sleep

    def read() -> float:
        advance(READING)
        return now()

    def simulated_sleep(seconds: float) -> None:
        if threading.current_thread() is threading.main_thread():
            advance(seconds)
        else:
            sleep(seconds)

    time.monotonic = time.perf_counter = read
    time.time = lambda: start + read()
    time.monotonic_ns = time.perf_counter_ns = lambda: int(1e9 * read())
    time.time_ns = lambda: int(1e9 * (start + read()))
    time.sleep = simulated_sleep  # type: ignore[assignment]
