"""Rendering in the background: the latest request wins, nothing hangs."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import pytest

from minirt.viewer.background import BackgroundPainter
from minirt.viewer.pace import LONGEST, Pace
from minirt.viewer.painter import Job, Outcome
from tests.viewer.fake import FakeRenderer, colour_of, scene
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


def test_compiling_is_told_while_it_lasts(bench):
    bench.renderer.ready = False
    bench.start(JOB)
    assert bench.told.acquire(timeout=5)
    assert bench.painter.compiling
    bench.renderer.gate.set()
    bench.outcomes(1)
    assert not bench.painter.compiling


def test_close_stops_a_picture_but_not_the_compiler():
    bench = Bench()
    bench.start(JOB)
    assert bench.painter.close(5)
    bench = Bench()
    bench.renderer.ready = False
    bench.start(JOB)
    assert not bench.painter.close(0.05)
    bench.renderer.gate.set()
    assert bench.painter.close(5)
    assert bench.renderer.rendered in ([], [(64, 48)])
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
