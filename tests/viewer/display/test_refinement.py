"""Progressive refinement: which pictures a session requests while something moves, and when nothing does."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from minirt.mlx import Key
from minirt.mlx.memory import Memory, MemoryWindow
from minirt.viewer.app.judging import PictureJudge
from minirt.viewer.display.jobs import Painted, PaintJob
from minirt.viewer.display.refinement import FRAME_TIME, AdaptiveResolution
from tests.viewer.fake import MARK, colour_of, scene
from tests.viewer.session_harness import SIZE, SessionHarness

SCENE = scene()
URGENT, CANCELLED = {"urgent": True}, {"pixels": False}  # options of `outcome`


def test_the_first_picture_has_full_resolution_and_is_rendered_once():
    harness = SessionHarness()
    assert harness.painter.requests == [PaintJob(harness.session.state.scene, *SIZE)]
    harness.finish(10.0)
    harness.memory.wait(2)
    harness.memory.do(harness.memory.window.on_expose)
    harness.play("move 5,5", "hide", "show", "press i", "press h", "press Tab")
    assert len(harness.painter.requests) == 1


def test_slow_pictures_are_coarse_only_while_a_key_is_held():
    harness = SessionHarness()
    harness.finish(FRAME_TIME * 3)
    harness.memory.press(Key.D)
    for _ in range(2):
        harness.play("wait 0.5")
        harness.finish(FRAME_TIME * 3 / 4)
        assert not harness.painter.busy
    assert set(harness.painter.divisors[1:]) == {2}
    assert all(job.urgent for job in harness.painter.requests[1:])
    harness.play("up d")
    assert harness.painter.requests[-1] == PaintJob(harness.session.state.scene, *SIZE)
    harness.finish(FRAME_TIME * 3)
    harness.play("wait 1")
    assert not harness.painter.busy
    assert harness.session.refinement.latest.job == PaintJob(harness.session.state.scene, *SIZE)


def test_a_still_picture_is_refined_pass_by_pass_until_it_is_final(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PictureJudge, "judge", lambda _: None)  # which would say that these pictures have one colour
    harness = SessionHarness(samples=16)
    harness.hide_overlay()
    for marked in (0, 4, 16):
        harness.finish(0.001)
        shown = harness.memory.screenshot()
        assert (shown[0, :marked] == MARK).all()
        assert (shown[0, marked:] == colour_of(scene())).all()
        assert (shown[1:] == colour_of(scene())).all()
    harness.memory.wait(2)
    harness.memory.do(harness.memory.window.on_expose)
    harness.play("press h", "press Tab")
    assert harness.painter.samples == [1, 4, 16]
    assert harness.painter.divisors == [1, 1, 1]
    assert not harness.painter.busy
    assert not harness.display.busy


def test_a_new_movement_returns_to_one_sample_at_once():
    harness = SessionHarness(samples=16)
    harness.finish(0.001)
    harness.finish(0.001)
    harness.play("down d")
    job = harness.painter.requests[-1]
    assert (job.samples, job.base, job.urgent, job.divisor) == (1, None, True, 1)
    harness.finish(0.001)
    assert (harness.session.picture == colour_of(harness.session.state.scene)).all()
    for _ in range(3):
        harness.play("wait 0.5")
        harness.finish(0.001)
    assert set(harness.painter.samples[3:]) == {1}
    harness.play("up d")
    while harness.painter.busy:
        harness.finish(0.001)
    assert harness.painter.samples[-3:] == [1, 4, 16]


class SlowWindow(MemoryWindow):
    """A window on which showing a picture takes four tenths of the frame time."""

    def blit(self) -> None:
        super().blit()
        self.display._now += 0.4 * FRAME_TIME


class SlowScreen(Memory):
    window_type = SlowWindow


def test_a_slow_screen_leaves_less_time_for_rendering():
    for memory, divisor in ((Memory(), 1), (SlowScreen(), 2)):
        harness = SessionHarness(memory=memory)
        harness.finish(FRAME_TIME * 0.7)
        harness.play("press d")
        assert harness.painter.divisors == [1, divisor, divisor]


def test_a_picture_cancelled_without_a_newer_request_is_requested_again():
    harness = SessionHarness()
    harness.painter.open.clear()
    harness.painter.outcomes.append(Painted(harness.painter.requests[0]))
    harness.painter.notify()
    harness.memory.play()
    assert len(harness.painter.requests) == 2


def test_a_still_picture_that_is_late_does_not_slow_down_the_next_movement():
    """Seen on a slow scene: a press came while the still picture's levels were written, and the press after it had to
    wait for a picture of full resolution."""
    harness = SessionHarness()
    still = harness.painter.requests[0]
    harness.finish(FRAME_TIME * 30)
    harness.play("down d")
    coarse = harness.painter.divisors[-1]
    assert coarse > 1
    harness.painter.outcomes.append(Painted(still, np.zeros(still.shape, np.uint8), seconds=FRAME_TIME * 30))
    harness.painter.notify()
    harness.memory.play()
    harness.finish(FRAME_TIME * 30 / coarse**2)
    harness.play("up d", "down d")
    assert harness.painter.requests[-1].urgent
    assert harness.painter.divisors[-1] == coarse


# Adaptive resolution: the divisor follows the measured times, without flicker.


def outcome(seconds: float, divisor: int = 1, pixels: bool = True, samples: int = 1, urgent: bool = False) -> Painted:
    job = PaintJob(SCENE, 800, 600, divisor, urgent, samples)
    return Painted(job, colour_of(SCENE) if pixels else None, seconds=seconds)


def render_moving(resolution: AdaptiveResolution, seconds: float, always: float = 0.0) -> int:
    """Record a picture while something moves and return its divisor.

    At full resolution it takes `seconds`, of which `always` do not depend on the resolution.
    """
    divisor = resolution.divisor(800, 600)
    resolution.record(outcome(always + (seconds - always) / divisor**2, divisor, urgent=True))
    return divisor


@pytest.mark.parametrize(
    ("longest", "divisor"),
    [(0.5, 1), (0.99, 1), (1.1, 2), (3.9, 2), (4.1, 3), (8.9, 3), (9.1, 4), (16, 4), (17, 6), (37, 8), (1e6, 12)],
)
def test_the_divisor_is_as_small_as_the_render_time_allows(longest, divisor):
    resolution = AdaptiveResolution()
    resolution.record(outcome(longest * FRAME_TIME))
    assert resolution.divisor(800, 600) == divisor
    for _ in range(20):
        assert render_moving(resolution, longest * FRAME_TIME) == divisor


@pytest.mark.parametrize(
    ("pictures", "divisors"),
    [
        ([(0.06, CANCELLED)], [12, 12]),  # no time is known
        ([(0.5, {}), (0.25, CANCELLED), (9, {"samples": 4})], [12, 1, 1, 1]),  # too short to count; refined
        ([(0.5, {}), (3, CANCELLED), (3, CANCELLED)], [12, 1, 1, 2]),  # at least its time
        ([(0.5, {}), (0.5, {}), (0.5, {}), (5, URGENT), (5, URGENT)], [12, 1, 1, 1, 1, 3]),
        ([(3, {}), (30, URGENT)], [12, 2, 2]),  # late, of the former divisor
        ([(3, {}), (0.75, {"divisor": 2, **URGENT}), (0.01, CANCELLED)], [12, 2, 2, 2]),  # at full resolution
    ],
)
def test_two_slow_pictures_are_needed_to_coarsen_and_some_do_not_count(pictures, divisors):
    resolution = AdaptiveResolution()
    found = [resolution.divisor(800, 600)]
    for frames, options in pictures:
        resolution.record(outcome(frames * FRAME_TIME, **options))
        found.append(resolution.divisor(800, 600))
    assert found == divisors


def first_divisors(resolution: AdaptiveResolution, factors: list[float]) -> list[int]:
    """Move some times after a still picture of 7.5 frames; return the first divisor of each movement.

    Rays of the coarse pictures cost as many times those of the still one as `factors` say.
    """
    first = []
    for factor in factors:
        resolution.record(outcome(FRAME_TIME * 7.5))
        first.append(render_moving(resolution, FRAME_TIME * 7.5 * factor))
        for _ in range(5):
            render_moving(resolution, FRAME_TIME * 7.5 * factor)
    return first


def test_the_first_divisor_of_a_movement_learns_from_the_movements_before():
    assert first_divisors(AdaptiveResolution(), [2.0] * 4) == [3, 4, 4, 4]
    assert first_divisors(AdaptiveResolution(), [0.8] * 4) == [3, 3, 3, 3]  # never finer than the still picture says
    assert first_divisors(AdaptiveResolution(), [1.0, 1.0, 50.0, 1.0]) == [3, 3, 3, 3]  # a single slow picture


@pytest.mark.parametrize(("finer", "coarser"), [(1, 2), (2, 3), (3, 4)])
def test_near_the_limit_the_resolution_does_not_flicker(finer, coarser):
    resolution, limit = AdaptiveResolution(), FRAME_TIME * finer**2
    resolution.record(outcome(limit * 0.98))
    used = [render_moving(resolution, limit * (1.02 if n // 3 % 2 else 0.98)) for n in range(200)]
    assert set(used) == {finer, coarser}
    assert sum(a != b for a, b in itertools.pairwise(used)) <= 5
    used = [render_moving(resolution, limit * 0.7) for _ in range(5)]
    assert used[-1] == finer  # it fits into FINER_SHARE of the time


def test_a_finer_picture_is_tried_where_coarse_ones_mislead():
    """Each picture takes at least a tenth of the frame time, at any resolution."""
    resolution, always = AdaptiveResolution(), FRAME_TIME / 10
    resolution.record(outcome(FRAME_TIME * 90))
    assert render_moving(resolution, FRAME_TIME * 90, always) == 12  # another program had the processor
    used = [render_moving(resolution, FRAME_TIME * 0.9, always) for _ in range(1000)]
    assert used[-1] == 1
    assert sum(a != b for a, b in itertools.pairwise(used)) <= 4


def test_failed_trials_of_a_finer_picture_become_rare():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME * 1.1))
    used = [render_moving(resolution, FRAME_TIME * 1.1) for _ in range(1000)]
    assert 1 <= used.count(1) <= 12


def test_display_time_is_not_left_for_rendering():
    for showing, divisor in ((0.1, 1), (0.4, 2), (40, 2)):  # for the last, coarser pictures would not help
        resolution = AdaptiveResolution()
        resolution.display_times.append(FRAME_TIME * showing)
        resolution.record(outcome(FRAME_TIME * 0.7))
        assert resolution.divisor(800, 600) == divisor
