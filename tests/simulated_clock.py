"""Simulated clock, which advances by rendered packets alone, so that timings are the same on every machine."""

from __future__ import annotations

import pytest

from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering import frame_runner, renderer
from minirt.rendering.frame import Frame
from minirt.rendering.frame_runner import FrameRunner
from minirt.rendering.sampling import auto
from minirt.report import bench

PACKET_SECONDS = 1e-6  # for a packet of rays
# Processor time by wall time: different enough from 1 to be told apart.
PROCESSOR_SHARE = 0.95


class Clock:
    """Simulated seconds and the number of rendered packets of rays."""

    def __init__(self) -> None:
        self.packets = 0
        self.slowness = 1.0  # factor on the time of a packet
        self.wall = 0.0

    def rendered(self, packets: int) -> None:
        """Advance by the time of a number of packets."""
        self.packets += packets
        self.wall += packets * self.slowness * PACKET_SECONDS

    def cpu(self) -> float:
        """Processor time in seconds."""
        return PROCESSOR_SHARE * self.wall


def simulate_clock(patch: pytest.MonkeyPatch) -> Clock:
    """Replace the machine's clock wherever pictures are timed."""
    clock, run = Clock(), FrameRunner.run

    def counted(self: FrameRunner, frame: Frame) -> None:
        run(self, frame)
        clock.rendered(packets_of(frame))

    patch.setattr(FrameRunner, "run", counted)
    for module in (auto, frame_runner, renderer, bench):
        patch.setattr(module, "perf_counter", lambda: clock.wall)
    patch.setattr(bench, "process_time", clock.cpu)
    patch.setattr(bench, "waiting_time", lambda: 0.0)
    return clock


def packets_of(frame: Frame) -> int:
    """Count the packets of rays of a frame: one for each sample in each packet of pixels that takes any."""
    height, width = frame.pixels.shape
    samples, numbers = frame.rays.shape
    if not len(frame.plan):
        return samples * packets(width, height, numbers // 3)
    drawn, probed = frame.plan[:, 3], frame.plan[:, 4] > 0
    return int(drawn.sum() + 2 * drawn[probed].sum())


def packets(width: int, height: int, rays: int = 16) -> int:
    """Count the packets of `rays` rays that cover a picture."""
    return -(-height // PACKET_HEIGHT) * -(-width // (rays // PACKET_HEIGHT))
