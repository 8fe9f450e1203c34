"""Rendering in the background: the latest request wins, nothing hangs."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import pytest

from minirt.errors import RenderError
from minirt.viewer.background import BackgroundPainter
from minirt.viewer.pace import LONGEST, Pace
from minirt.viewer.painter import Job, Outcome
from tests.viewer.fake import TEXT, FakeRenderer, colour_of, scene
from tests.windows import until

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

        until(enough, f"{count} outcomes", 5)
        return taken

    def start(self, job: Job) -> None:
        """Request a picture that takes until the gate is opened."""
        self.renderer.gate.clear()
        self.renderer.started.clear()
        self.painter.request(job)
        assert self.renderer.started.wait(5)


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.renderer.gate.set()
    assert made.painter.close(5)


def test_a_picture_comes_and_is_told(bench):
    bench.painter.request(JOB)
    (outcome,) = bench.outcomes(1)
    assert (outcome.pixels == colour_of(JOB.scene)).all()
    assert outcome.pixels.shape == (48, 64, 4)
    assert outcome.seconds > 0
    assert bench.told.acquire(timeout=5)
    assert not bench.painter.busy


def test_a_coarser_picture_covers_the_window(bench):
    bench.painter.request(Job(JOB.scene, 65, 48, divisor=4))
    assert bench.outcomes(1)[0].pixels.shape == (12, 17, 4)


def test_of_requests_during_an_urgent_picture_the_latest_is_made(bench):
    bench.start(replace(JOB, urgent=True))
    for width in (10, 20, 64):
        bench.painter.request(replace(JOB, divisor=64 // width, urgent=True))
    time.sleep(0.05)  # a wrong cancel would come now
    bench.renderer.gate.set()
    first, last = bench.outcomes(2)
    assert (first.job.divisor, last.job.divisor) == (1, 1)
    assert bench.renderer.rendered == [(64, 48), (64, 48)]
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


def test_an_exception_is_an_outcome_and_the_painter_lives_on(bench):
    bench.renderer.error = ZeroDivisionError("no")
    bench.painter.request(JOB)
    assert isinstance(bench.outcomes(1)[0].error, ZeroDivisionError)
    bench.renderer.error = None
    bench.painter.request(JOB)
    assert bench.outcomes(1)[0].pixels is not None


class TestWithoutAKernel:
    """What is shown while `prepare` takes its time."""

    @pytest.fixture
    def bench(self, bench):
        bench.renderer.ready = False
        return bench

    def test_compiling_is_told_while_it_lasts(self, bench):
        bench.start(JOB)
        assert bench.told.acquire(timeout=5)
        assert bench.painter.compiling
        bench.renderer.gate.set()
        until(lambda: not bench.painter.compiling, "the kernel", 5)

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

    def test_a_kernel_that_is_soon_there_needs_no_preview(self, bench):
        bench.painter.request(JOB)
        (outcome,) = bench.outcomes(1)
        assert not outcome.preview
        assert not bench.painter.compiling

    def test_without_a_preview_the_picture_comes_all_the_same(self, bench):
        bench.renderer.previews = False
        bench.start(JOB)
        until(lambda: bench.painter.compiling, "the word", 5)
        bench.renderer.gate.set()
        assert not bench.outcomes(1)[0].preview

    def test_a_reason_why_there_is_no_kernel_is_an_outcome(self, bench):
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
        until(lambda: bench.painter.compiling, "the word", 5)
        start = time.monotonic()
        assert bench.painter.close(0.05) == stops
        assert time.monotonic() - start < 0.3
        bench.renderer.gate.set()
        assert bench.painter.close(5)


def test_close_stops_a_picture():
    bench = Bench()
    bench.start(JOB)
    assert bench.painter.close(5)
    assert Bench().painter.close(0)


class TestPace:
    @staticmethod
    def made(seconds: float, divisor: int = 1, pixels: bool = True) -> Outcome:
        job = Job(JOB.scene, 800, 600, divisor)
        return Outcome(job, colour_of(JOB.scene) if pixels else None, seconds=seconds)

    @pytest.mark.parametrize(
        ("longest", "divisor"), [(0.5, 1), (1.0, 1), (1.1, 2), (4, 2), (4.1, 4), (16, 4), (17, 8), (1e6, 8)]
    )
    def test_as_coarse_as_needed(self, longest, divisor):
        pace = Pace()
        pace.learn(self.made(longest * LONGEST))
        assert pace.divisor(800, 600) == divisor

    def test_learns_from_coarse_pictures_and_for_other_sizes(self):
        pace = Pace()
        pace.learn(self.made(LONGEST, divisor=4))
        assert pace.divisor(800, 600) == 4
        assert pace.divisor(400, 300) == 2

    def test_is_careful_while_nothing_is_known(self):
        pace = Pace()
        assert pace.divisor(800, 600) == 8
        pace.learn(self.made(0.001, pixels=False))
        assert pace.divisor(800, 600) == 8

    def test_a_cancelled_picture_took_at_least_that_long(self):
        pace = Pace()
        pace.learn(self.made(LONGEST / 2))
        pace.learn(self.made(LONGEST * 3, pixels=False))
        assert pace.divisor(800, 600) == 2
        pace.learn(self.made(LONGEST, pixels=False))
        assert pace.divisor(800, 600) == 2
