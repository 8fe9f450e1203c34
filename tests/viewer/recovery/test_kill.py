"""A program that is killed by SIGKILL while it edits loses no version that was flushed."""

from __future__ import annotations

import pytest

from tests.viewer.recovery.kill import Trial, trial

MOMENTS = [0.0, 0.31]  # seconds after the first edit; `python -m tests.viewer.recovery.kill 200` tries many


@pytest.mark.parametrize("wait", MOMENTS)
def test_a_killed_program_leaves_a_whole_version(tmp_path, wait):
    result = trial(tmp_path, wait, edits=40)
    assert result.flushed <= result.recovered <= len(result.kept) + 1  # one may be on disk before it is reported


def test_losses_are_counted_from_the_first_lost_edit():
    assert Trial([1.0, 2.0, 3.0], 0, 1, 3.5).lost == 1.5
    assert Trial([1.0, 2.0, 3.0], 3, 3, 3.5).lost == 0.0
