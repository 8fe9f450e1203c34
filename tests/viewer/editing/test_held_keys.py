"""Steps of held keys are proportional to time and independent of the frame rate, and leave whole steps."""

from __future__ import annotations

from itertools import pairwise

import pytest

from minirt.mlx import Key
from minirt.viewer.editing import editor
from minirt.viewer.editing.editor import FIRST_PART, GROWTH, PATIENCE, RATE, HeldKey, apply
from minirt.viewer.editing.state import State
from tests.viewer.fake import TEXT, played, scene
from tests.viewer.session_harness import SessionHarness

TICKS = 144  # a second
ODD_VIEW = TEXT.replace("C 0,0,10 0,0,-1", "C 0.1,0.2,10 0.3,-0.2,-0.9")  # whose steps are no round numbers
PARTS = [0.5, 0.6180339, 0.75, 0.9]


@pytest.fixture
def counting(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the state be the number of steps that were taken."""
    monkeypatch.setattr(editor, "apply", lambda state, _action, amount, _now: state + amount)


def taken(seconds: float, ticks: int) -> list[float]:
    """Steps that a held key has taken after its press, after each of `ticks`, and after its release."""
    key = HeldKey("left", 10.0, 1.0, is_typed=False)
    steps = [key.advance(0.0, FIRST_PART, 1.0, 10.0)]
    for tick in range(1, ticks + 1):
        now = 10.0 + seconds * tick / ticks
        steps.append(key.advance(steps[-1], key.steps(now), 1.0, now))
    return [*steps, key.advance(steps[-1], max(1.0, key.steps(10.0 + seconds)), 1.0, 10.0 + seconds)]


@pytest.mark.usefixtures("counting")
@pytest.mark.parametrize("ticks", [0, 1, 7, 144])
@pytest.mark.parametrize("seconds", [0.9 / RATE, 0.5, 1.0, 1.5, 4.0])
def test_steps_are_proportional_to_time_and_grow_after_a_second(seconds: float, ticks: int) -> None:
    count = 100_000
    times = ((number + 0.5) * seconds / count for number in range(count))
    expected = sum(RATE * (1 + GROWTH * max(0.0, time - PATIENCE)) for time in times) * seconds / count
    assert taken(seconds, ticks)[-1] == pytest.approx(max(1.0, expected), rel=1e-6)


def stands_still(steps: list[float]) -> bool:
    """Whether a tick took less than half of its share of the steps."""
    return any(late - early < 0.5 * FIRST_PART * RATE / TICKS for early, late in pairwise(steps))


@pytest.mark.usefixtures("counting")
def test_a_held_key_never_stands_still() -> None:
    steps = taken(1.0, TICKS)[:-1]  # after the last tick no time passes until the release
    assert steps[0] == FIRST_PART
    assert not stands_still(steps)
    assert stands_still([max(1.0, each) for each in steps])  # a whole step with the press, and then a pause


def test_keys_are_independent() -> None:
    harness = SessionHarness()
    harness.play("down d", "down e", "up d", "up F3")
    x, y, _ = harness.session.state.scene.camera.position
    assert (x, y) == pytest.approx((harness.session.state.stride, FIRST_PART * harness.session.state.stride))
    assert list(harness.session.held_keys) == [Key.E]


# A held key moves at once and leaves whole steps, whatever the parts in which it took them.


def state_of() -> State:
    return played(text=ODD_VIEW).state


def in_parts(state: State, action: str, totals: list[float], size: float = 1.0) -> State:
    """Take steps in parts that end at `totals`, where the size of a step is 1 again after the first part."""
    held = HeldKey(action, 0.0, size, is_typed=False)
    for number, total in enumerate(totals):
        state = held.advance(state, total, 1.0 if number else size, number / 60)
    return state


@pytest.mark.parametrize("action", ["left", "forward", "turn left", "turn up"])
def test_a_step_in_parts_is_a_whole_step_to_the_last_digit(action: str) -> None:
    state = state_of()
    whole = apply(state, action)
    taken = in_parts(state, action, [*PARTS, 1.0])
    assert (taken.scene.camera, len(taken.undo_stack)) == (whole.scene.camera, 1)
    added = state
    for early, late in pairwise([0.0, *PARTS, 1.0]):
        added = apply(added, action, late - early)
    assert added.scene.camera != whole.scene.camera  # the sum of the parts is another number


def test_later_steps_are_added_and_a_change_in_between_and_the_first_size_stay() -> None:
    state = state_of()
    assert in_parts(state, "left", [*PARTS, 1.5]).scene == apply(apply(state, "left"), "left", 0.5).scene
    assert in_parts(state, "left", [0.5, 1.0], size=0.1).scene == apply(state, "left", 0.1).scene
    held = HeldKey("left", 0.0, 1.0, is_typed=False)
    state = apply(held.advance(state, 0.5, 1.0, 0.0), "turn up")
    assert held.advance(state, 1.0, 1.0, 0.0).scene == apply(state, "left", 0.5).scene


@pytest.mark.parametrize("size", ["", "Shift+"])
def test_a_tap_of_any_length_is_one_step(size: str) -> None:
    cameras = {played(f"hold {size}d {seconds}", text=ODD_VIEW).state.scene.camera for seconds in (0, 0.05, 0.1)}
    amount = 0.1 if size else 1.0
    assert cameras == {apply(state_of(), "right", amount).scene.camera}


def test_a_held_key_moves_with_the_press_and_with_every_tick() -> None:
    harness = SessionHarness()
    states = [harness.session.state]
    harness.memory.after_tick = lambda: states.append(harness.session.state)
    harness.memory.press(Key.D)
    harness.memory.do(lambda: states.append(harness.session.state))
    harness.play("wait 0.5")
    positions = [state.scene.camera.position[0] for state in states]
    assert len(positions) > 30
    assert positions == sorted(set(positions))
    assert scene().camera.position[0] == positions[0]
