"""Background rendering: the latest request wins, nothing hangs; adaptive resolution."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.viewer.display import painter as painter_module
from minirt.viewer.display.jobs import Painted, PaintJob
from minirt.viewer.display.painter import BackgroundPainter, paint
from tests.viewer.fake import MARK, TEXT, FakeRenderer, colour_of, scene
from tests.waiting import HANG_LIMIT, until

JOB = PaintJob(scene(), 64, 48)
REFINED = replace(JOB, samples=16, goal=16, base=np.full((48, 64, 4), colour_of(JOB.scene), np.uint8))


class PainterHarness:
    """A background painter with a fake renderer, and a count of its notifications."""

    def __init__(self) -> None:
        self.renderer = FakeRenderer()
        self.notifications = threading.Semaphore(0)
        self.painter = BackgroundPainter(self.renderer, self.notifications.release)

    def outcomes(self, count: int) -> list[Painted]:
        """Wait for so many outcomes and return them."""
        taken: list[Painted] = []

        def enough() -> bool:
            taken.extend(self.painter.take())
            return len(taken) >= count

        until(enough, f"{count} outcomes")
        return taken

    def start(self, job: PaintJob) -> None:
        """Request a picture that is not finished until the gate is opened."""
        self.renderer.gate.clear()
        self.renderer.started.clear()
        self.painter.request(job)
        assert self.renderer.started.wait(HANG_LIMIT)


@pytest.fixture
def harness():
    harness = PainterHarness()
    yield harness
    harness.renderer.gate.set()
    assert harness.painter.close(HANG_LIMIT)


def test_a_finished_picture_is_notified(harness):
    harness.painter.request(JOB)
    (outcome,) = harness.outcomes(1)
    assert (outcome.pixels == colour_of(JOB.scene)).all()
    assert outcome.pixels.shape == (48, 64, 4)
    assert outcome.seconds > 0
    assert harness.notifications.acquire(timeout=HANG_LIMIT)


def test_during_an_urgent_picture_only_the_latest_request_is_kept(harness):
    harness.start(replace(JOB, urgent=True))
    for width in (10, 20, 64):
        harness.painter.request(replace(JOB, divisor=64 // width, urgent=True))
    harness.renderer.gate.set()
    until(lambda: harness.renderer.rendered == [(64, 48), (64, 48)], "two pictures")
    assert harness.outcomes(1)[-1].job.divisor == 1
    assert harness.renderer.cancelled == 0


@pytest.mark.parametrize("job", [JOB, REFINED], ids=["picture", "refinement"])
def test_a_picture_that_is_not_urgent_is_cancelled(harness, job):
    harness.start(job)
    harness.painter.request(replace(JOB, divisor=2))
    cancelled = harness.outcomes(1)[0]
    assert (cancelled.job, cancelled.pixels, cancelled.error) == (job, None, None)
    assert (REFINED.base == colour_of(JOB.scene)).all()
    harness.renderer.gate.set()
    assert harness.outcomes(1)[0].job.divisor == 2


def test_only_the_latest_untaken_picture_is_kept(harness):
    for width in range(60, 70):
        harness.painter.request(PaintJob(scene(), width, 48))
        until(lambda now=width: harness.renderer.rendered[-1:] == [(now, 48)], "the picture")
        assert harness.notifications.acquire(timeout=HANG_LIMIT)
    (outcome,) = harness.painter.take()
    assert outcome.job.width == 69


def test_an_exception_is_an_outcome_and_the_painter_goes_on(harness):
    harness.renderer.error = ZeroDivisionError("no")
    harness.painter.request(JOB)
    assert isinstance(harness.outcomes(1)[0].error, ZeroDivisionError)
    harness.renderer.error = None
    harness.painter.request(JOB)
    assert harness.outcomes(1)[0].pixels is not None


def test_an_error_before_the_picture_is_an_outcome_and_the_next_one_is_rendered(harness, monkeypatch):
    """A texture may be gone when the kernels for the scene are looked for."""

    def fail(*_):
        raise RenderError("dots.png: cannot be read: no such file or directory")

    with monkeypatch.context() as patch:
        patch.setattr(harness.renderer, "is_ready", fail)
        harness.painter.request(JOB)
        assert isinstance(harness.outcomes(1)[0].error, RenderError)
    harness.painter.request(JOB)
    assert harness.outcomes(1)[0].error is None


class TestWithoutAKernel:
    """Pictures while `prepare` compiles the kernel."""

    @pytest.fixture(autouse=True)
    def immediate_previews(self, monkeypatch):
        """Let previews begin at once if the kernel is not ready."""
        monkeypatch.setattr(painter_module, "PREVIEW_DELAY", 0.0)

    @pytest.fixture
    def harness(self, harness):
        harness.renderer.ready = False
        return harness

    def test_a_preview_is_followed_by_the_picture(self, harness):
        harness.start(JOB)
        (outcome,) = harness.outcomes(1)
        assert (outcome.job, outcome.preview, outcome.error) == (JOB, True, None)
        assert outcome.pixels.shape == (2, 3, 4)
        harness.renderer.gate.set()
        (outcome,) = harness.outcomes(1)
        assert (outcome.job, outcome.preview) == (JOB, False)
        assert outcome.pixels.shape == (48, 64, 4)

    def test_edits_are_previewed_and_only_the_last_is_rendered(self, harness):
        harness.start(JOB)
        harness.outcomes(1)
        for line in ("sp 1,0,0 2 255,0,0", "sp 2,0,0 2 255,0,0"):
            edited = replace(JOB, scene=scene(f"{TEXT}{line}\n"))
            harness.painter.request(edited)
            (outcome,) = harness.outcomes(1)
            assert (outcome.job, outcome.preview) == (edited, True)
        harness.renderer.gate.set()
        (outcome,) = harness.outcomes(1)
        assert (outcome.job, outcome.preview) == (edited, False)
        assert harness.renderer.rendered == [(64, 48)]

    def test_a_kernel_that_is_soon_ready_needs_no_preview(self, harness, monkeypatch):
        monkeypatch.setattr(painter_module, "PREVIEW_DELAY", HANG_LIMIT)
        harness.painter.request(JOB)
        (outcome,) = harness.outcomes(1)
        assert not outcome.preview

    def test_without_a_preview_the_picture_still_follows(self, harness):
        previewed = threading.Event()
        harness.renderer.preview = lambda *_: previewed.set()
        harness.start(JOB)
        assert previewed.wait(HANG_LIMIT)
        harness.renderer.gate.set()
        assert not harness.outcomes(1)[0].preview

    def test_a_picture_with_fewer_samples_stays_until_the_kernel_for_more_is_there(self, harness):
        """One sample has a kernel of its own where the scene has a lens."""
        harness.renderer.is_ready = lambda _scene, samples: samples == 1 or harness.renderer.ready
        harness.start(REFINED)
        edited = replace(JOB, scene=scene(f"{TEXT}sp 1,0,0 2 255,0,0\n"))
        harness.painter.request(edited)
        harness.renderer.gate.set()
        (outcome,) = harness.outcomes(1)
        assert (outcome.job, outcome.preview) == (edited, False)
        harness.painter.request(REFINED)
        assert harness.outcomes(1)[0].job is REFINED
        assert (harness.renderer.samples, harness.renderer.refined) == ([1], [16])

    def test_an_error_of_prepare_is_an_outcome(self, harness, monkeypatch):
        monkeypatch.setattr(painter_module, "PREVIEW_DELAY", HANG_LIMIT)
        harness.renderer.prepare_error = RenderError("no")
        harness.painter.request(JOB)
        outcomes = harness.outcomes(2)
        assert [each.error for each in outcomes] == [harness.renderer.prepare_error, None]
        assert outcomes[1].preview

    @pytest.mark.parametrize("stops", [True, False])
    def test_close_ends_prepare_if_the_renderer_can_stop(self, stops):
        harness = PainterHarness()
        harness.renderer.ready, harness.renderer.stops = False, stops
        harness.start(JOB)
        assert harness.painter.close(HANG_LIMIT if stops else 0.01) == stops
        assert harness.renderer.gate.is_set() == stops  # otherwise close would have waited for it
        harness.renderer.gate.set()
        assert harness.painter.close(HANG_LIMIT)


def test_close_cancels_a_picture():
    harness = PainterHarness()
    harness.start(JOB)
    assert harness.painter.close(HANG_LIMIT)
    assert PainterHarness().painter.close(0)


def test_a_picture_is_refined_in_a_copy(harness):
    harness.painter.request(REFINED)
    (outcome,) = harness.outcomes(1)
    assert (outcome.pixels[0, :16] == MARK).all()
    assert (outcome.pixels[1:] == colour_of(JOB.scene)).all()
    assert (REFINED.base == colour_of(JOB.scene)).all()
    assert harness.renderer.refined == [16]
    assert harness.renderer.rendered == []


def test_a_picture_is_dropped_if_it_becomes_unwanted_while_its_error_is_estimated():
    answers = iter([True, False])  # to the renderer, and to the estimate
    outcome = paint(FakeRenderer(), REFINED, REFINED.base, lambda: next(answers))
    assert (outcome.pixels, outcome.error) == (None, None)


def test_a_request_before_the_renderer_can_be_cancelled_still_cancels(harness):
    renderer = harness.renderer
    refine = renderer.refine

    def late(*arguments, **keywords):
        harness.painter.request(JOB)  # its cancel comes too early
        renderer.gate.clear()  # so that it would never end
        return refine(*arguments, **keywords)

    renderer.refine = late
    harness.painter.request(REFINED)
    assert harness.outcomes(1)[0].pixels is None
    renderer.gate.set()
    assert harness.outcomes(1)[0].job is JOB


@pytest.mark.parametrize(
    ("goal", "passes"), [(1, []), (2, [2]), (4, [4]), (8, [4, 8]), (16, [4, 16]), (64, [4, 16, 64])]
)
def test_samples_grow_fourfold_per_pass_up_to_the_goal(goal, passes):
    job, samples = replace(JOB, goal=goal, urgent=True), []
    pixels = np.zeros(JOB.shape, np.uint8)
    while not (outcome := Painted(job, pixels)).is_final:
        job = outcome.next()
        samples.append(job.samples)
        assert job.base is pixels
        assert not job.urgent
    assert samples == passes


def test_after_a_coarse_picture_follows_full_resolution():
    coarse = replace(JOB, divisor=3, goal=16, urgent=True)
    outcome = Painted(coarse, np.zeros(coarse.shape, np.uint8))
    assert not outcome.is_final
    assert outcome.next() == replace(JOB, goal=16)
