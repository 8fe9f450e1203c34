"""Programs end by signals at random moments: see `ends.py`, which by hand tries as many as asked for."""

from __future__ import annotations

import random
import sys

import pytest

from tests.cli.ends import trial
from tests.cli.program import environment

COUNT, SHARE = 2, 0.3  # signals of each kind, and the share of its span in which they come


@pytest.mark.skipif(sys.platform != "linux", reason="the processor time is read from /proc")
@pytest.mark.parametrize("kind", ["start", "film", "cluster", "report", "replay"])
def test_a_signal_at_any_moment_ends_the_program_as_documented(kind: str) -> None:
    seed = random.randrange(10**9)
    print(f"seed {seed}")  # which a failure shows
    chance = random.Random(seed)
    for _ in range(COUNT):
        assert trial(kind, chance, environment(), share=SHARE).faults == []
