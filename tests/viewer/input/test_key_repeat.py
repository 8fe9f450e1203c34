"""Steps of held keys are proportional to time and independent of the frame rate."""

from __future__ import annotations

import pytest

from minirt.viewer.input.key_repeat import RATE, KeyRepeat


def total(seconds: float, ticks: int) -> float:
    """Steps of a key that is held for some seconds, in which the frame is drawn `ticks` times."""
    keys = KeyRepeat()
    keys.press(97, "left", 10.0)
    steps = 1.0  # with the press
    for tick in range(1, ticks + 1):
        steps += sum(amount for _, amount in keys.advance(10.0 + seconds * tick / ticks))
    return steps + sum(amount for _, amount in keys.release(97, 10.0 + seconds))


@pytest.mark.parametrize("ticks", [0, 1, 7, 144])
@pytest.mark.parametrize("seconds", [0.5, 2.0])
def test_steps_are_proportional_to_time(seconds, ticks):
    assert total(seconds, ticks) == pytest.approx(RATE * seconds)


@pytest.mark.parametrize("ticks", [0, 3])
def test_a_tap_is_one_step(ticks):
    assert total(0.9 / RATE, ticks) == 1


def test_keys_are_independent():
    keys = KeyRepeat()
    keys.press(97, "left", 0.0)
    keys.press(119, "forward", 1.0)
    assert keys.advance(1.0) == [("left", RATE - 1), ("forward", 0.0)]
    assert keys.release(97, 1.0) == [("left", 0.0)]
    assert keys
    assert keys.release(42, 1.0) == []
    keys.release(119, 1.0)
    assert not keys
