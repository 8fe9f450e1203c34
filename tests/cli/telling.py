"""python -m tests.cli.telling: the program, which tells on standard error when threads are at work on a picture.

So a test that interrupts it has an event to wait for.
"""

from __future__ import annotations

import os
import sys
from threading import Thread
from typing import Any

from minirt.cli import main
from minirt.rendering.frame_arguments import Frame
from minirt.rendering.running.frame_runner import FrameRunner
from tests.waiting import until

RENDERING = b"rendering"


def tell() -> None:
    """Tell of each picture from now on, but for those of a pixel, for which kernels are compiled."""
    run = FrameRunner.run

    def telling(self: FrameRunner, frames: list[Frame], threads: int) -> None:
        if frames[0].pixels.size > 1:
            Thread(target=watch, args=(frames[0].next_row,), daemon=True).start()
        run(self, frames, threads)

    FrameRunner.run = telling  # type: ignore[method-assign]


def watch(next_row: Any) -> None:
    """Tell when a thread has taken the first row, in one piece: others write on standard error, too."""
    until(lambda: bool(next_row[0]), "the first row")
    os.write(2, RENDERING + b"\n")


if __name__ == "__main__":
    tell()
    sys.exit(main())
