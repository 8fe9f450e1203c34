"""Rendering in the background: the latest request wins, nothing hangs."""

from __future__ import annotations

import itertools
import threading
from dataclasses import replace

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.viewer.display import background_painter
from minirt.viewer.display.adaptive_resolution import FRAME_TIME, AdaptiveResolution
from minirt.viewer.display.background_painter import BackgroundPainter
from minirt.viewer.display.painter import Job, Outcome
from tests.viewer.fake import MARK, TEXT, FakeRenderer, colour_of, scene
from tests.waiting import HANG_LIMIT, until

JOB = Job(scene(), 64, 48)


class Bench:
    """A painter with its renderer, and how often it had something to tell."""

    def __init__(self) -> None:
        self.renderer = FakeRenderer()
        self.told = threading.Semaphore(0)
        self.painter = BackgroundPainter(self.renderer, self.told.release)

    def outcomes(self, count: int) -> list[Outcome]:
        taken: list[Outcome] = []

        def enough() -> bool:
            taken.extend(self.painter.take())
            return len(taken) >= count

        until(enough, f"{count} outcomes")
        return taken

    def start(self, job: Job) -> None:
        """Request a picture that takes until the gate is opened."""
        self.renderer.gate.clear()
        self.renderer.started.clear()
        self.painter.request(job)
        assert self.renderer.started.wait(HANG_LIMIT)


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.renderer.gate.set()
    assert made.painter.close(HANG_LIMIT)


def test_a_picture_comes_and_is_told(bench):
    bench.painter.request(JOB)
    (outcome,) = bench.outcomes(1)
    assert (outcome.pixels == colour_of(JOB.scene)).all()
    assert outcome.pixels.shape == (48, 64, 4)
    assert outcome.seconds > 0
    assert bench.told.acquire(timeout=HANG_LIMIT)
    assert not bench.painter.busy


def test_a_coarser_picture_covers_the_window(bench):
    bench.painter.request(Job(JOB.scene, 65, 48, divisor=4))
    assert bench.outcomes(1)[0].pixels.shape == (12, 17, 4)


def test_of_requests_during_an_urgent_picture_the_latest_is_made(bench):
    bench.start(replace(JOB, urgent=True))
    for width in (10, 20, 64):
        bench.painter.request(replace(JOB, divisor=64 // width, urgent=True))
    bench.renderer.gate.set()
    until(lambda: bench.renderer.rendered == [(64, 48), (64, 48)], "two pictures")
    assert bench.outcomes(1)[-1].job.divisor == 1
    assert bench.renderer.cancelled == 0


def test_a_picture_that_is_not_urgent_is_cancelled(bench):
    bench.start(JOB)
    bench.painter.request(replace(JOB, divisor=2))
    cancelled = bench.outcomes(1)[0]
    assert (cancelled.job, cancelled.pixels, cancelled.error) == (JOB, None, None)
    bench.renderer.gate.set()
    assert bench.outcomes(1)[0].job.divisor == 2


def test_a_picture_of_another_size_is_cancelled(bench):
    bench.start(replace(JOB, urgent=True))
    bench.painter.request(replace(JOB, width=10, urgent=True))
    assert bench.outcomes(1)[0].pixels is None


def test_of_pictures_that_nobody_took_the_last_is_kept(bench):
    for width in range(60, 70):
        bench.painter.request(Job(scene(), width, 48))
        until(lambda now=width: bench.renderer.rendered[-1:] == [(now, 48)], "the picture")
        assert bench.told.acquire(timeout=HANG_LIMIT)
    (outcome,) = bench.painter.take()
    assert outcome.job.width == 69


def test_an_exception_is_an_outcome_and_the_painter_lives_on(bench):
    bench.renderer.error = ZeroDivisionError("no")
    bench.painter.request(JOB)
    assert isinstance(bench.outcomes(1)[0].error, ZeroDivisionError)
    bench.renderer.error = None
    bench.painter.request(JOB)
    assert bench.outcomes(1)[0].pixels is not None


class TestWithoutAKernel:
    """What is shown while `prepare` takes its time."""

    @pytest.fixture(autouse=True)
    def immediate_previews(self, monkeypatch):
        """A kernel that is not there at once is late."""
        monkeypatch.setattr(background_painter, "PREVIEW_DELAY", 0.0)

    @pytest.fixture
    def bench(self, bench):
        bench.renderer.ready = False
        return bench

    def test_compiling_is_told_while_it_lasts(self, bench):
        bench.renderer.preview = lambda *_: bench.renderer.gate.wait(HANG_LIMIT) and None  # before that is there
        bench.start(JOB)
        assert bench.told.acquire(timeout=HANG_LIMIT)
        assert bench.painter.compiling
        bench.renderer.gate.set()
        until(lambda: not bench.painter.compiling, "the kernel")

    def test_a_preview_is_followed_by_the_picture(self, bench):
        bench.start(JOB)
        (outcome,) = bench.outcomes(1)
        assert (outcome.job, outcome.preview, outcome.error) == (JOB, True, None)
        assert outcome.pixels.shape == (2, 3, 4)
        assert bench.painter.busy
        bench.renderer.gate.set()
        (outcome,) = bench.outcomes(1)
        assert (outcome.job, outcome.preview) == (JOB, False)
        assert outcome.pixels.shape == (48, 64, 4)
        assert not bench.painter.busy

    def test_edits_are_previewed_and_only_the_last_is_rendered(self, bench):
        bench.start(JOB)
        bench.outcomes(1)
        for line in ("sp 1,0,0 2 255,0,0", "sp 2,0,0 2 255,0,0"):
            edited = replace(JOB, scene=scene(f"{TEXT}{line}\n"))
            bench.painter.request(edited)
            (outcome,) = bench.outcomes(1)
            assert (outcome.job, outcome.preview) == (edited, True)
        bench.renderer.gate.set()
        (outcome,) = bench.outcomes(1)
        assert (outcome.job, outcome.preview) == (edited, False)
        assert bench.renderer.rendered == [(64, 48)]

    def test_a_kernel_that_is_soon_there_needs_no_preview(self, bench, monkeypatch):
        monkeypatch.setattr(background_painter, "PREVIEW_DELAY", HANG_LIMIT)
        bench.painter.request(JOB)
        (outcome,) = bench.outcomes(1)
        assert not outcome.preview
        assert not bench.painter.compiling

    def test_without_a_preview_the_picture_comes_all_the_same(self, bench):
        bench.renderer.previews = False
        bench.start(JOB)
        until(lambda: bench.painter.compiling, "the word")
        bench.renderer.gate.set()
        assert not bench.outcomes(1)[0].preview

    def test_a_reason_why_there_is_no_kernel_is_an_outcome(self, bench, monkeypatch):
        monkeypatch.setattr(background_painter, "PREVIEW_DELAY", HANG_LIMIT)
        bench.renderer.prepare_error = RenderError("no")
        bench.painter.request(JOB)
        outcomes = bench.outcomes(2)
        assert [each.error for each in outcomes] == [bench.renderer.prepare_error, None]
        assert outcomes[1].preview
        assert not bench.painter.busy

    @pytest.mark.parametrize("stops", [True, False])
    def test_close_ends_what_can_be_ended(self, stops):
        bench = Bench()
        bench.renderer.ready, bench.renderer.stops = False, stops
        bench.start(JOB)
        until(lambda: bench.painter.compiling, "the word")
        assert bench.painter.close(HANG_LIMIT if stops else 0.01) == stops
        assert bench.renderer.gate.is_set() == stops  # else it would have been waited for
        bench.renderer.gate.set()
        assert bench.painter.close(HANG_LIMIT)


def test_close_stops_a_picture():
    bench = Bench()
    bench.start(JOB)
    assert bench.painter.close(HANG_LIMIT)
    assert Bench().painter.close(0)


REFINED = replace(JOB, samples=16, goal=16, base=np.full((48, 64, 4), colour_of(JOB.scene), np.uint8))


def test_a_picture_is_refined_in_a_copy(bench):
    bench.painter.request(REFINED)
    (outcome,) = bench.outcomes(1)
    assert (outcome.pixels[0, :16] == MARK).all()
    assert (outcome.pixels[1:] == colour_of(JOB.scene)).all()
    assert (REFINED.base == colour_of(JOB.scene)).all()
    assert bench.renderer.refined == [16]
    assert bench.renderer.rendered == []


def test_refining_is_cancelled_by_what_comes_next(bench):
    bench.start(REFINED)
    bench.painter.request(replace(JOB, urgent=True))
    cancelled = bench.outcomes(1)[0]
    assert (cancelled.job, cancelled.pixels, cancelled.error) == (REFINED, None, None)
    assert (REFINED.base == colour_of(JOB.scene)).all()
    bench.renderer.gate.set()
    assert bench.outcomes(1)[0].job.samples == 1


def test_a_request_just_before_the_renderer_can_be_cancelled_is_heard(bench):
    renderer = bench.renderer
    refine = renderer.refine

    def late(*arguments, **keywords):
        bench.painter.request(JOB)  # and its cancel comes too early
        renderer.gate.clear()  # it would never end
        return refine(*arguments, **keywords)

    renderer.refine = late
    bench.painter.request(REFINED)
    assert bench.outcomes(1)[0].pixels is None
    renderer.gate.set()
    assert bench.outcomes(1)[0].job is JOB


@pytest.mark.parametrize(
    ("goal", "passes"), [(1, []), (2, [2]), (4, [4]), (8, [4, 8]), (16, [4, 16]), (64, [4, 16, 64])]
)
def test_the_passes(goal, passes):
    job, made = replace(JOB, goal=goal, urgent=True), []
    pixels = np.zeros(JOB.shape, np.uint8)
    while not job.is_final:
        job = job.next(pixels)
        made.append(job.samples)
        assert job.base is pixels
        assert not job.urgent
    assert made == passes


def test_after_a_coarse_picture_comes_a_whole_one():
    coarse = replace(JOB, divisor=3, goal=16, urgent=True)
    assert not coarse.is_final
    assert coarse.next(np.zeros(coarse.shape, np.uint8)) == replace(JOB, goal=16)


class TestAdaptiveResolution:
    @staticmethod
    def outcome(
        seconds: float, divisor: int = 1, pixels: bool = True, samples: int = 1, urgent: bool = False
    ) -> Outcome:
        job = Job(JOB.scene, 800, 600, divisor, urgent, samples)
        return Outcome(job, colour_of(JOB.scene) if pixels else None, seconds=seconds)

    def render_moving(self, resolution: AdaptiveResolution, seconds: float, always: float = 0.0) -> int:
        """Render a picture while something moves: a whole one takes that long, and each `always` of it."""
        divisor = resolution.divisor(800, 600)
        resolution.record(self.outcome(always + (seconds - always) / divisor**2, divisor, urgent=True))
        return divisor

    @pytest.mark.parametrize(
        ("longest", "divisor"),
        [(0.5, 1), (0.99, 1), (1.1, 2), (3.9, 2), (4.1, 3), (8.9, 3), (9.1, 4), (16, 4), (17, 8), (1e6, 8)],
    )
    def test_as_coarse_as_needed(self, longest, divisor):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(longest * FRAME_TIME))
        assert resolution.divisor(800, 600) == divisor
        for _ in range(20):
            assert self.render_moving(resolution, longest * FRAME_TIME) == divisor

    def test_is_careful_while_nothing_is_known(self):
        resolution = AdaptiveResolution()
        assert resolution.divisor(800, 600) == 8
        resolution.record(self.outcome(0.001, pixels=False))
        assert resolution.divisor(800, 600) == 8

    def test_another_size_has_another_cost(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME * 4))
        assert resolution.divisor(400, 300) == 1

    def test_a_cancelled_picture_took_at_least_that_long(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME / 2))
        resolution.record(self.outcome(FRAME_TIME / 4, pixels=False))  # which says nothing
        for _ in range(2):
            assert resolution.divisor(800, 600) == 1
            resolution.record(self.outcome(FRAME_TIME * 3, pixels=False))
        assert resolution.divisor(800, 600) == 2

    def test_refined_pictures_say_nothing(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME / 2))
        for _ in range(3):
            resolution.record(self.outcome(FRAME_TIME * 9, samples=4))
        assert resolution.divisor(800, 600) == 1

    def test_one_slow_picture_changes_nothing_and_two_do(self):
        resolution = AdaptiveResolution()
        for _ in range(3):
            resolution.record(self.outcome(FRAME_TIME / 2))
        resolution.record(self.outcome(FRAME_TIME * 5, urgent=True))
        assert resolution.divisor(800, 600) == 1
        resolution.record(self.outcome(FRAME_TIME * 5, urgent=True))
        assert resolution.divisor(800, 600) == 3

    def test_what_is_under_way_is_waited_for(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME * 3))
        assert resolution.divisor(800, 600) == 2
        resolution.record(self.outcome(FRAME_TIME * 30, urgent=True))  # of before
        assert resolution.divisor(800, 600) == 2

    def test_a_whole_picture_that_was_not_waited_for_leaves_the_pace_as_it_was(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME * 3))
        self.render_moving(resolution, FRAME_TIME * 3)
        resolution.record(self.outcome(FRAME_TIME / 100, pixels=False))
        assert resolution.divisor(800, 600) == 2

    def test_near_the_limit_the_resolution_does_not_flicker(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME * 0.98))
        used = [self.render_moving(resolution, FRAME_TIME * (1.02 if n // 3 % 2 else 0.98)) for n in range(200)]
        assert set(used) == {1, 2}
        assert sum(a != b for a, b in itertools.pairwise(used)) <= 5
        used = [self.render_moving(resolution, FRAME_TIME * 0.7) for _ in range(5)]
        assert used[-1] == 1  # with ease

    def test_a_finer_picture_is_tried_where_coarse_ones_mislead(self):
        """Each picture takes a tenth of the time, whatever its size."""
        resolution, always = AdaptiveResolution(), FRAME_TIME / 10
        resolution.record(self.outcome(FRAME_TIME * 90))
        assert self.render_moving(resolution, FRAME_TIME * 90, always) == 8  # somebody else had the processor
        used = [self.render_moving(resolution, FRAME_TIME * 0.9, always) for _ in range(1000)]
        assert used[-1] == 1
        assert sum(a != b for a, b in itertools.pairwise(used)) <= 4

    def test_trying_in_vain_becomes_rare(self):
        resolution = AdaptiveResolution()
        resolution.record(self.outcome(FRAME_TIME * 1.1))
        used = [self.render_moving(resolution, FRAME_TIME * 1.1) for _ in range(1000)]
        assert 1 <= used.count(1) <= 12

    def test_what_showing_takes_is_not_left_for_rendering(self):
        for showing, divisor in ((0.1, 1), (0.4, 2), (40, 2)):  # the last is the screen's fault
            resolution = AdaptiveResolution()
            resolution.record_display_time(FRAME_TIME * showing)
            resolution.record(self.outcome(FRAME_TIME * 0.7))
            assert resolution.divisor(800, 600) == divisor
