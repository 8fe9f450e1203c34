"""A clock for tests, which moves on by the work that is done and by nothing else: alike on every machine."""

from __future__ import annotations

from collections.abc import Callable, Collection

import numpy as np
import pytest

from minirt import bench, timing
from minirt.kernel.frame import PACKET_HEIGHT
from minirt.rendering import renderer
from minirt.rendering.frame_arguments import Frame
from minirt.rendering.running import to_error
from minirt.rendering.running.frame_runner import FrameRunner
from minirt.rendering.sampling import auto
from minirt.report.measurements import formula_errors, picture_errors
from minirt.timing import Run

PACKET = 1e-6  # seconds that a packet of rays takes
FORMULA = 1e-3  # seconds that the first of some formulas takes for all of its rays, the second twice as many, ...
BUSY = (
    0.95  # of the time the processors work: so little that it is told apart, so much that nothing counts as disturbed
)


class Clock:
    """The seconds that have passed, and how many packets of rays were rendered."""

    def __init__(self) -> None:
        self.packets = 0
        self.slowness = 1.0  # of the machine: how many times as long a packet takes
        self.wall = 0.0

    def rendered(self, packets: int) -> None:
        """Move on by what so many packets take."""
        self.packets += packets
        self.wall += packets * self.slowness * PACKET

    def cpu(self) -> float:
        """Seconds of the processors."""
        return BUSY * self.wall


def simulated(patch: pytest.MonkeyPatch) -> Clock:
    """Put the clock in the place of the machine's wherever pictures or formulas are timed."""
    clock, run = Clock(), FrameRunner.run

    def counted(self: FrameRunner, frames: list[Frame], threads: int) -> None:
        run(self, frames, threads)
        clock.rendered(sum(map(packets_of, frames)))

    patch.setattr(FrameRunner, "run", counted)
    for module in (timing, auto, to_error, renderer, picture_errors, bench):
        patch.setattr(module, "perf_counter", lambda: clock.wall)
    patch.setattr(timing, "process_time", clock.cpu)
    patch.setattr(formula_errors, "in_turn", in_turn)
    return clock


def packets_of(frame: Frame) -> int:
    """The packets of rays of a frame: one for each sample in each packet of pixels that is wanted."""
    height, width = frame.pixels.shape
    samples, numbers = frame.rays.shape
    wanted = np.count_nonzero(frame.wanted) if len(frame.wanted) else packets(width, height, numbers // 3)
    return samples * int(wanted)


def packets(width: int, height: int, rays: int = 16) -> int:
    """The packets of so many rays that cover a picture."""
    return -(-height // PACKET_HEIGHT) * -(-width // (rays // PACKET_HEIGHT))


def in_turn(works: Collection[Callable[[], object]], times: int) -> list[tuple[Run, ...]]:
    """As `minirt.timing.in_turn`, of formulas; each is worked out once, and every second turn is ten times as slow."""
    for work in works:
        work()
    slowness = [10.0 if turn % 2 else 1.0 for turn in range(times)]
    seconds = [FORMULA * number for number in range(1, len(works) + 1)]
    return [tuple(Run(slow * each, BUSY * slow * each) for slow in slowness) for each in seconds]
