"""When automatic sampling ends with its first sweep: by how much the mean of the probes may be in doubt."""

from __future__ import annotations

from math import sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from minirt.rendering.sampling.auto import AutoSampler

PACKETS = 100  # all of them are probed
EVEN = np.full(PACKETS, 0.04)
UNEVEN = np.repeat([1.0, 0.0], [4, 96])  # the same mean, with a standard error of 0.0196


class FirstSweep(AutoSampler):
    """A sampler whose first sweep finds these squared errors, and that only notes whether it refines them."""

    def __init__(self, errors: np.ndarray) -> None:
        packets: Any = SimpleNamespace(errors=errors, count=PACKETS, samples=(1.0, 1))
        super().__init__(lambda _: True, lambda: (errors, errors), packets, PACKETS, 1)
        self.refines = False

    def draw_first(self) -> bool:
        return True

    def refine(self, goal: float, end: float) -> float:
        self.refines = True
        return goal


@pytest.mark.parametrize(
    ("errors", "squared_goal", "refines"),
    [
        (EVEN, 0.03, True),
        (EVEN, 0.05, False),
        (UNEVEN, 0.05, True),
        (UNEVEN, 0.08, True),  # above mean and standard error, but the doubt is vague: 0.0792 / 0.7 = 0.113 counts
        (UNEVEN, 0.11, True),
        (UNEVEN, 0.12, False),
    ],
)
def test_the_first_sweep_is_enough_where_its_doubt_leaves_the_goal_certain(
    errors: np.ndarray, squared_goal: float, refines: bool
) -> None:
    sampler = FirstSweep(errors)
    assert sampler.reach(sqrt(squared_goal), 1e9)
    assert sampler.refines is refines
