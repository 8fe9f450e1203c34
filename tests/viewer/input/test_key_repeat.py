"""Held keys: as far as the time says, whatever the number of pictures."""

from __future__ import annotations

import pytest

from minirt.viewer.input.key_repeat import RATE, KeyRepeat


def total(seconds: float, ticks: int) -> float:
    held = KeyRepeat()
    held.press(97, "left", 10.0)
    steps = 1.0  # with the press
    for tick in range(1, ticks + 1):
        steps += sum(amount for _, amount in held.advance(10.0 + seconds * tick / ticks))
    return steps + sum(amount for _, amount in held.release(97, 10.0 + seconds))


@pytest.mark.parametrize("ticks", [0, 1, 7, 144])
@pytest.mark.parametrize("seconds", [0.5, 2.0])
def test_steps_are_proportional_to_time(seconds, ticks):
    assert total(seconds, ticks) == pytest.approx(RATE * seconds)


@pytest.mark.parametrize("ticks", [0, 3])
def test_a_tap_is_one_step(ticks):
    assert total(0.9 / RATE, ticks) == 1


def test_keys_are_independent():
    held = KeyRepeat()
    held.press(97, "left", 0.0)
    held.press(119, "forward", 1.0)
    assert held.advance(1.0) == [("left", RATE - 1), ("forward", 0.0)]
    assert held.release(97, 1.0) == [("left", 0.0)]
    assert held
    assert held.release(42, 1.0) == []
    held.release(119, 1.0)
    assert not held
