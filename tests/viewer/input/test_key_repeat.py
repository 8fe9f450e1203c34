"""Steps of held keys are proportional to time and independent of the frame rate, and none stands still."""

from __future__ import annotations

from itertools import pairwise

import pytest

from minirt.viewer.key_repeat import FIRST_PART, GROWTH, PATIENCE, RATE, Advance, KeyRepeat

KEY = 97
TICKS = 144  # a second


def taken(seconds: float, ticks: int) -> list[float]:
    """Steps that a held key has taken after its press, after each of `ticks`, and after its release."""
    keys = KeyRepeat()
    advances = keys.press(KEY, "left", 10.0)
    for tick in range(1, ticks + 1):
        advances += keys.advance(10.0 + seconds * tick / ticks)
    advances += keys.release(KEY, 10.0 + seconds)
    assert all(early.after == late.before for early, late in pairwise(advances))
    return [advance.after for advance in advances]


@pytest.mark.parametrize("ticks", [0, 1, 7, 144])
@pytest.mark.parametrize("seconds", [0.5, 1.0])
def test_steps_are_proportional_to_time(seconds, ticks):
    assert taken(seconds, ticks)[-1] == pytest.approx(RATE * seconds)


@pytest.mark.parametrize("ticks", [0, 1, 7, 144])
@pytest.mark.parametrize("seconds", [1.5, 2.0, 4.0])
def test_steps_grow_while_a_key_is_held(seconds, ticks):
    count = 100_000
    times = ((number + 0.5) * seconds / count for number in range(count))
    expected = sum(RATE * (1 + GROWTH * max(0.0, time - PATIENCE)) for time in times) * seconds / count
    assert taken(seconds, ticks)[-1] == pytest.approx(expected, rel=1e-6)
    assert expected > 1.1 * RATE * seconds


@pytest.mark.parametrize("ticks", [0, 3])
def test_a_tap_is_one_step(ticks):
    assert taken(0.9 / RATE, ticks)[-1] == 1


def stands_still(steps: list[float]) -> bool:
    """Whether a tick took less than half of its share of the steps."""
    return any(late - early < 0.5 * FIRST_PART * RATE / TICKS for early, late in pairwise(steps))


def test_a_held_key_never_stands_still():
    steps = taken(1.0, TICKS)[:-1]  # after the last tick no time passes until the release
    assert steps[0] == FIRST_PART
    assert not stands_still(steps)
    assert stands_still([max(1.0, each) for each in steps])  # a whole step with the press, and then a pause


def test_keys_are_independent():
    keys = KeyRepeat()
    keys.press(KEY, "left", 0.0)
    keys.press(119, "forward", 1.0)
    left, forward = keys.advance(1.0)
    assert left == Advance(KEY, "left", FIRST_PART, RATE)
    assert forward == Advance(119, "forward", FIRST_PART, FIRST_PART)
    assert keys.release(KEY, 1.0) == [Advance(KEY, "left", RATE, RATE)]
    assert keys
    assert keys.release(42, 1.0) == []
    keys.release(119, 1.0)
    assert not keys
