"""Programs end by signals at random moments: see `ends.py`, which by hand tries as many as asked for."""

from __future__ import annotations

import random
import sys

import pytest

from tests.cli.ends import trial
from tests.cli.program import environment
from tests.seeds import seed_of

SHARE = 0.3  # of the span of a program, in which the signal comes: at another moment in each run


@pytest.mark.skipif(sys.platform != "linux", reason="the processor time is read from /proc")
@pytest.mark.parametrize("kind", ["start", "film", "cluster", "report", "replay"])
def test_a_signal_at_any_moment_ends_the_program_as_documented(kind: str) -> None:
    assert trial(kind, random.Random(seed_of(f"signal to {kind}")), environment(), share=SHARE).faults == []
