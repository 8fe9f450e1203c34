"""Adaptive resolution: the divisor follows the measured times, without flicker."""

from __future__ import annotations

import itertools

import pytest

from minirt.viewer.display.painter import Job, Outcome
from minirt.viewer.display.refinement import FRAME_TIME, AdaptiveResolution
from tests.viewer.fake import colour_of, scene

SCENE = scene()


def outcome(seconds: float, divisor: int = 1, pixels: bool = True, samples: int = 1, urgent: bool = False) -> Outcome:
    job = Job(SCENE, 800, 600, divisor, urgent, samples)
    return Outcome(job, colour_of(SCENE) if pixels else None, seconds=seconds)


def render_moving(resolution: AdaptiveResolution, seconds: float, always: float = 0.0) -> int:
    """Record a picture while something moves and return its divisor.

    At full resolution it takes `seconds`, of which `always` do not depend on the resolution.
    """
    divisor = resolution.divisor(800, 600)
    resolution.record(outcome(always + (seconds - always) / divisor**2, divisor, urgent=True))
    return divisor


@pytest.mark.parametrize(
    ("longest", "divisor"),
    [(0.5, 1), (0.99, 1), (1.1, 2), (3.9, 2), (4.1, 3), (8.9, 3), (9.1, 4), (16, 4), (17, 6), (37, 8), (1e6, 8)],
)
def test_the_divisor_is_as_small_as_the_render_time_allows(longest, divisor):
    resolution = AdaptiveResolution()
    resolution.record(outcome(longest * FRAME_TIME))
    assert resolution.divisor(800, 600) == divisor
    for _ in range(20):
        assert render_moving(resolution, longest * FRAME_TIME) == divisor


def test_the_divisor_is_greatest_while_no_time_is_known():
    resolution = AdaptiveResolution()
    assert resolution.divisor(800, 600) == 8
    resolution.record(outcome(0.001, pixels=False))
    assert resolution.divisor(800, 600) == 8


def test_the_cost_scales_with_the_window():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME * 4))
    assert resolution.divisor(400, 300) == 1


def test_a_cancelled_picture_counts_as_at_least_its_time():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME / 2))
    resolution.record(outcome(FRAME_TIME / 4, pixels=False))  # too short to count
    for _ in range(2):
        assert resolution.divisor(800, 600) == 1
        resolution.record(outcome(FRAME_TIME * 3, pixels=False))
    assert resolution.divisor(800, 600) == 2


def test_refined_pictures_do_not_count():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME / 2))
    for _ in range(3):
        resolution.record(outcome(FRAME_TIME * 9, samples=4))
    assert resolution.divisor(800, 600) == 1


def test_two_slow_pictures_are_needed_to_coarsen():
    resolution = AdaptiveResolution()
    for _ in range(3):
        resolution.record(outcome(FRAME_TIME / 2))
    resolution.record(outcome(FRAME_TIME * 5, urgent=True))
    assert resolution.divisor(800, 600) == 1
    resolution.record(outcome(FRAME_TIME * 5, urgent=True))
    assert resolution.divisor(800, 600) == 3


def test_a_late_picture_of_the_former_divisor_does_not_coarsen_again():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME * 3))
    assert resolution.divisor(800, 600) == 2
    resolution.record(outcome(FRAME_TIME * 30, urgent=True))  # of the former divisor
    assert resolution.divisor(800, 600) == 2


def test_a_cancelled_picture_at_full_resolution_leaves_the_divisor():
    resolution = AdaptiveResolution()
    resolution.record(outcome(FRAME_TIME * 3))
    render_moving(resolution, FRAME_TIME * 3)
    resolution.record(outcome(FRAME_TIME / 100, pixels=False))
    assert resolution.divisor(800, 600) == 2


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
    assert render_moving(resolution, FRAME_TIME * 90, always) == 8  # another program had the processor
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
        resolution.record_display_time(FRAME_TIME * showing)
        resolution.record(outcome(FRAME_TIME * 0.7))
        assert resolution.divisor(800, 600) == divisor
