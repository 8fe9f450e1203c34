"""Steps of held keys are proportional to time and independent of the frame rate, and none stands still."""

from __future__ import annotations

from itertools import pairwise

import pytest

from minirt.mlx import Key
from minirt.viewer.app.events import HeldEdits
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import State
from minirt.viewer.key_repeat import FIRST_PART, GROWTH, PATIENCE, RATE, Advance, KeyRepeat
from tests.viewer.fake import TEXT, played, scene
from tests.viewer.session_harness import SessionHarness

KEY = 97
TICKS = 144  # a second
ODD_VIEW = TEXT.replace("C 0,0,10 0,0,-1", "C 0.1,0.2,10 0.3,-0.2,-0.9")  # whose steps are no round numbers
PARTS = [0.0, 0.5, 0.6180339, 0.75, 0.9]


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


# A held key moves at once and leaves whole steps, whatever the parts in which it took them.


def state_of(text: str = ODD_VIEW) -> State:
    return played(text=text).state


def in_parts(state: State, action: str, totals: list[float]) -> State:
    """Take steps in parts that end at `totals`."""
    edits = HeldEdits()
    for number, (before, after) in enumerate(pairwise(totals)):
        state = edits.apply(state, Advance(1, action, before, after), 1.0, number / 60)
    return state


@pytest.mark.parametrize("action", ["left", "forward", "turn left", "turn up"])
def test_a_step_in_parts_is_a_whole_step_to_the_last_digit(action):
    state = state_of()
    whole = apply(state, action)
    taken = in_parts(state, action, [*PARTS, 1.0])
    assert (taken.scene.camera, len(taken.undo_stack)) == (whole.scene.camera, 1)
    added = state
    for early, late in zip(PARTS, [*PARTS[1:], 1.0], strict=True):
        added = apply(added, action, late - early)
    assert added.scene.camera != whole.scene.camera  # the sum of the parts is another number


def test_steps_after_the_first_are_added_to_a_whole_one():
    state = state_of()
    assert in_parts(state, "left", [*PARTS, 1.5]).scene == apply(apply(state, "left"), "left", 0.5).scene


def test_a_change_in_between_stays():
    state, edits = state_of(), HeldEdits()
    state = edits.apply(state, Advance(1, "left", 0.0, 0.5), 1.0, 0.0)
    state = apply(state, "turn up")
    after = edits.apply(state, Advance(1, "left", 0.5, 1.0), 1.0, 0.0)
    assert after.scene == apply(state, "left", 0.5).scene


def test_the_first_step_keeps_the_size_that_it_began_with():
    state, edits = state_of(), HeldEdits()
    small = edits.apply(state, Advance(1, "left", 0.0, 0.5), 0.1, 0.0)
    assert edits.apply(small, Advance(1, "left", 0.5, 1.0), 1.0, 0.0).scene == apply(state, "left", 0.1).scene


@pytest.mark.parametrize("size", ["", "Shift+"])
def test_a_tap_of_any_length_is_one_step(size):
    cameras = {played(f"hold {size}d {seconds}", text=ODD_VIEW).state.scene.camera for seconds in (0, 0.05, 0.1)}
    amount = 0.1 if size else 1.0
    assert cameras == {apply(state_of(), "right", amount).scene.camera}


def test_a_held_key_moves_with_the_press_and_with_every_tick():
    harness = SessionHarness()
    states = [harness.session.state]
    harness.memory.after_tick = lambda: states.append(harness.session.state)
    harness.memory.press(Key.D)
    harness.memory.do(lambda: states.append(harness.session.state))
    harness.memory.wait(0.5)
    harness.memory.play()
    positions = [state.scene.camera.position[0] for state in states]
    assert len(positions) > 30
    assert positions == sorted(set(positions))
    assert scene().camera.position[0] == positions[0]
