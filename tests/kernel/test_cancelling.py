"""A frame that is cancelled ends with the packet that it is at; counted, since compiled it takes no time to see."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel import frame
from minirt.kernel.culling import binning
from minirt.kernel.frame import CANCELLED, TILE
from minirt.lanes import Vec
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.scene_packing import Packing
from tests.kernel.pictures import ALL

WIDTH, HEIGHT, SAMPLES = 40, 24, 2
PACKETS = 10 * 6 * SAMPLES


class Counter:
    """The rows that threads take; somebody cancels the frame after so many looks at it."""

    def __init__(self, looks: float) -> None:
        self.row, self.left = 0, looks

    def __getitem__(self, index: int) -> int:
        self.left -= 1
        return CANCELLED if self.left < 0 else self.row

    def __setitem__(self, index: int, row: int) -> None:
        self.row = row


def packets_after(looks: float, monkeypatch: pytest.MonkeyPatch) -> tuple[int, int]:
    """How many packets are traced of a frame before it is cancelled, after so many looks at the counter, and after."""
    counter, made = Counter(looks), [0, 0]
    packet = frame.packet_radiance

    def counted(*given: Any) -> Vec:
        made[counter.left <= 0] += 1
        return packet(*given)

    monkeypatch.setattr(frame, "packet_radiance", counted)
    traced = Packing(binning).pack(ALL, WIDTH, HEIGHT)
    given = frame_arguments(traced, np.zeros((HEIGHT, WIDTH, 4), np.uint8), SAMPLES)
    with np.errstate(all="ignore"):
        frame.frame(*given._replace(next_row=counter))
    before, after = made
    return before, after


def test_all_packets_are_traced_where_nobody_cancels(monkeypatch: pytest.MonkeyPatch) -> None:
    assert packets_after(np.inf, monkeypatch) == (PACKETS, 0)


@pytest.mark.parametrize("looks", [0, 1, 2, 3, 4, 20, 60, PACKETS - TILE])
def test_one_packet_at_most_is_traced_after_a_cancel(looks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = packets_after(looks, monkeypatch)
    assert looks - 6 <= before <= looks  # three more looks for each row of tiles
    assert after <= 1
