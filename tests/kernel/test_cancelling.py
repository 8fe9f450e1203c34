"""Cancelling a frame: it ends at the next packet. Interpreted, since compiled frames end too soon to count packets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel import frame, interpreted
from minirt.kernel.frame import CANCELLED
from minirt.kernel.pixels import TILE
from minirt.lanes import Vec
from minirt.rendering.frame import frame_arguments
from minirt.rendering.scene_packing import Packing
from tests.kernel.pictures import ALL

WIDTH, HEIGHT, SAMPLES = 40, 24, 2
PACKETS = 10 * 6 * SAMPLES


class Counter:
    """A row counter that cancels the frame after a number of reads."""

    def __init__(self, reads: float) -> None:
        self.row, self.reads_left = 0, reads

    def __getitem__(self, index: int) -> int:
        self.reads_left -= 1
        return CANCELLED if self.reads_left < 0 else self.row

    def __setitem__(self, index: int, row: int) -> None:
        self.row = row


def packets_after(reads: float, monkeypatch: pytest.MonkeyPatch) -> tuple[int, int]:
    """Count the packets traced before and after a frame is cancelled, which happens after some reads of the counter."""
    counter, counts = Counter(reads), [0, 0]
    packet = frame.packet_radiance

    def counting_packet(*arguments: Any) -> Vec:
        counts[counter.reads_left <= 0] += 1
        return packet(*arguments)

    monkeypatch.setattr(frame, "packet_radiance", counting_packet)
    traced = Packing(interpreted).pack(ALL, WIDTH, HEIGHT)
    arguments = frame_arguments(traced, np.zeros((HEIGHT, WIDTH, 4), np.uint8), SAMPLES)
    with np.errstate(all="ignore"):
        frame.frame(*arguments._replace(next_row=counter))
    before, after = counts
    return before, after


def test_all_packets_are_traced_if_nobody_cancels(monkeypatch: pytest.MonkeyPatch) -> None:
    assert packets_after(np.inf, monkeypatch) == (PACKETS, 0)


@pytest.mark.parametrize("reads", [0, 1, 2, 3, 4, 20, 60, PACKETS - TILE])
def test_at_most_one_packet_is_traced_after_a_cancel(reads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = packets_after(reads, monkeypatch)
    assert reads - 6 <= before <= reads  # three more reads for each row of tiles
    assert after <= 1
