"""Outcomes of automatic sampling: whether the goal was reached, and what is said about it."""

from __future__ import annotations

import pytest

from minirt.rendering.sampling.outcome import MOST_SAMPLES, Outcome

REACHED = Outcome(4.0, 16, 0.002, 0.1, goal=0.003)


@pytest.mark.parametrize(
    ("outcome", "is_reached", "notice"),
    [
        (REACHED, True, ""),
        (REACHED._replace(goal=0.002), True, ""),
        (REACHED._replace(goal=0.0), True, ""),
        (REACHED._replace(goal=0.001), False, "error 0.001 not reached: the time was over"),
        (
            REACHED._replace(goal=0.001, most=MOST_SAMPLES),
            False,
            f"error 0.001 not reached: some pixels have {MOST_SAMPLES} samples, the most there are",
        ),
        (
            REACHED._replace(goal=0.001, rounded=True, rounding=0.006),
            False,
            "no more samples: rounding to 8 bits decides below an error of 0.003",
        ),
    ],
)
def test_a_goal_that_is_not_reached_is_said_with_the_reason(outcome: Outcome, is_reached: bool, notice: str) -> None:
    assert outcome.is_reached is is_reached
    assert outcome.notice == notice


def test_errors_of_light_and_of_rounding_add_as_independent_ones() -> None:
    assert REACHED._replace(error=0.003, rounding=0.004).error_of_bytes == pytest.approx(0.005, rel=1e-15)
