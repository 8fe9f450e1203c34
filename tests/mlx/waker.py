"""Another thread that wakes the loop of a program on `Memory`, once that sleeps."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

from tests.waiting import until

if TYPE_CHECKING:
    from types import FrameType

    from minirt.mlx import Mlx
    from minirt.mlx.display import Display


def waker(m: Mlx, mlx: Display) -> threading.Thread:
    """A thread to start, which calls `mlx_wake` when the script of the main thread has come to wait for that."""

    def wake() -> None:
        until(_awaits, "the step of the script that waits for mlx_wake")
        m.mlx_wake(mlx)

    return threading.Thread(target=wake)


def _awaits() -> bool:
    """Whether the main thread stands in `Memory._await_wake`, in the wait itself."""
    frame: FrameType | None = sys._current_frames()[threading.main_thread().ident or 0]
    names = []
    while frame is not None:
        names.append(frame.f_code.co_name)
        frame = frame.f_back
    return "_await_wake" in names and names[0] == "wait"
