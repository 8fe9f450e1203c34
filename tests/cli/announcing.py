"""`python -m tests.cli.announcing`: the program, which prints a line to standard error when it begins to render.

Tests that interrupt it wait for this line.
"""

from __future__ import annotations

import os
import sys
from threading import Thread
from typing import Any

from minirt.cli import main
from minirt.rendering.frame import Frame
from minirt.rendering.frame_runner import FrameRunner
from tests.waiting import until

RENDERING = b"rendering"


def announce_rendering() -> None:
    """Patch the renderer to announce each picture, except pictures of one pixel, which only compile kernels."""
    run = FrameRunner.run

    def announcing(self: FrameRunner, frame: Frame) -> None:
        if frame.pixels.size > 1:
            Thread(target=watch, args=(frame.next_row,), daemon=True).start()
        run(self, frame)

    FrameRunner.run = announcing  # type: ignore[method-assign]


def watch(next_row: Any) -> None:
    """Announce when a thread has taken the first row; in one write, for others write to standard error too."""
    until(lambda: bool(next_row[0]), "the first row")
    os.write(2, RENDERING + b"\n")


if __name__ == "__main__":
    announce_rendering()
    sys.exit(main())
