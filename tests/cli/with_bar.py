"""`python -m tests.cli.with_bar`: the program with a bar at once, which is not done before it was stopped."""

from __future__ import annotations

import signal
import sys
from threading import Event

from minirt.cli import main
from minirt.helpers import progress
from minirt.rendering.frame import Frame
from minirt.rendering.frame_runner import FrameRunner
from tests.waiting import until


def wait_after_each_picture(continued: Event) -> None:
    """Patch the renderer to wait for an event after each picture, except pictures of one pixel."""
    run = FrameRunner.run

    def waiting(self: FrameRunner, frames: list[Frame], threads: int) -> None:
        run(self, frames, threads)
        if frames[0].pixels.size > 1:
            until(continued.is_set, "SIGCONT")  # looks again and again: another thread may take the signal

    FrameRunner.run = waiting  # type: ignore[method-assign]


if __name__ == "__main__":
    progress.PATIENCE = progress.PAUSE = 0.01
    going_on = Event()
    signal.signal(signal.SIGCONT, lambda *_: going_on.set())
    wait_after_each_picture(going_on)
    sys.exit(main())
