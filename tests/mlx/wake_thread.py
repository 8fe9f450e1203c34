"""A thread that wakes the loop of a program on `Memory` when the loop sleeps."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

from tests.waiting import until

if TYPE_CHECKING:
    from types import FrameType

    from minirt.mlx import Mlx
    from minirt.mlx.backend import Display


def wake_thread(m: Mlx, mlx: Display) -> threading.Thread:
    """Make a thread that calls `mlx_wake` as soon as the script in the main thread waits for it."""

    def wake() -> None:
        until(_main_thread_waits, "the step of the script that waits for mlx_wake")
        m.mlx_wake(mlx)

    return threading.Thread(target=wake)


def _main_thread_waits() -> bool:
    """Whether the main thread is in the wait of `Memory._await_wake`."""
    frame: FrameType | None = sys._current_frames()[threading.main_thread().ident or 0]
    names = []
    while frame is not None:
        names.append(frame.f_code.co_name)
        frame = frame.f_back
    return "_await_wake" in names and names[0] == "wait"
