"""Painters: they render jobs at once, or in a thread that cancels pictures which are no longer wanted.

Until the kernel for a scene is compiled, its pictures in the background are previews; the last one is then rendered
again.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from minirt.rendering.renderer import Renderer
from minirt.rendering.sampling.packets import estimated_error
from minirt.viewer.display.jobs import Painted, PaintJob, Pixels
from minirt.viewer.display.precision import MovingPrecision
from minirt.viewer.display.views import view_pixels

PREVIEW_DELAY = 0.4  # seconds that a kernel may take before a preview appears: loading one takes less
NICENESS = 10  # of rendering: keys and the window are served first


class Painter:
    """A painter that renders before `request` returns: for replays, where time is simulated.

    All pixels get all samples, as in a picture that is rendered without a window.
    """

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        """`notify` is called when there are outcomes to take."""
        self.renderer = renderer
        self.notify = notify
        self.outcomes: list[Painted] = []

    def request(self, job: PaintJob) -> None:
        self.outcomes.append(paint(self.renderer, job))
        self.notify()

    def take(self) -> list[Painted]:
        """Return the outcomes since the last call, oldest first."""
        taken, self.outcomes = self.outcomes, []
        return taken

    def close(self, patience: float) -> bool:
        """Stop; return whether all threads have ended within `patience` seconds."""
        return True


def paint(
    renderer: Renderer, job: PaintJob, base: Pixels | None = None, is_wanted: Callable[[], bool] = lambda: True
) -> Painted:
    """Render a job: all pixels, or only the edges in a copy of `base`, the same picture with fewer samples.

    While rendering, `is_wanted` is asked; after a False the result has no pixels. Nothing is raised: an exception is in
    the result.
    """
    try:
        if job.view:
            height, width, _ = job.shape
            return Painted(job, view_pixels(job.scene, job.view, width, height, is_wanted))
        pixels = np.empty(job.shape, np.uint8) if base is None else base.copy()
        done = renderer.render(job.scene, pixels, job.samples, is_wanted=is_wanted, edges_only=base is not None)
    except Exception as error:  # of any kind: the session raises it in the main thread
        return Painted(job, error=error)
    about = () if job.urgent or not done else tuple(renderer.about)
    estimate = None
    if done and base is not None:
        tone = job.scene.camera.tone
        estimate = estimated_error(base, pixels, job.base_samples, job.samples, is_wanted, tone)
        done = estimate is not None
    return Painted(job, pixels, error_estimate=estimate, about=about) if done else Painted(job)


class BackgroundPainter(Painter):
    """A painter with a thread for rendering, started by the first request, and another for compiling kernels.

    Both threads call `notify`.
    """

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        super().__init__(renderer, lambda: self._closed or notify())
        renderer.specialise_early()
        self._precision = MovingPrecision(renderer)
        self._changed = threading.Condition()
        self._waiting: PaintJob | None = None
        self._running: PaintJob | None = None
        self._previewed: PaintJob | None = None  # to be rendered again when the kernel is ready
        self._closed = False
        self._preparing = False
        self._threads = [threading.Thread(target=self._work, name="minirt-painter", daemon=True)]

    def request(self, job: PaintJob) -> None:
        with self._changed:
            self._waiting, self._previewed = job, None
            self._changed.notify_all()
            if self._running and self._is_superseded(self._running):
                self.renderer.cancel()
        if self._threads[0].ident is None:
            self._threads[0].start()

    def take(self) -> list[Painted]:
        with self._changed:
            return super().take()

    def close(self, patience: float) -> bool:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if self._threads[0].ident is None:
            return True
        for each in (self.renderer, self._precision.single):
            each.stop()
            each.cancel()
        end = time.monotonic() + patience
        for thread in self._threads:
            thread.join(max(0.0, end - time.monotonic()))
        return not any(thread.is_alive() for thread in self._threads)

    def _work(self) -> None:
        """Render requests until the painter is closed: the body of the thread."""
        if sys.platform == "linux":  # for this thread and those that it starts; elsewhere for the whole process
            os.nice(NICENESS)
        while True:
            with self._changed:  # wait for a request, and take the latest
                self._changed.wait_for(lambda: self._waiting or self._closed)
                job = self._running = self._waiting
                self._waiting = None
            if self._closed or not job:
                return
            outcome = self._render(job)
            with self._changed:
                self._running = None
                has_picture = outcome is not None and outcome.pixels is not None
                if has_picture:  # it replaces older ones that nobody took
                    self.outcomes = [each for each in self.outcomes if each.pixels is None]
                if outcome:
                    self.outcomes.append(outcome)
                is_idle = has_picture and not self._waiting
            self.notify()
            if is_idle and job.samples == 1:
                height, width, _ = job.shape
                self._precision.judge(job.scene, width, height)

    def _render(self, job: PaintJob) -> Painted | None:
        """Render a job, or while its kernel is missing its preview; return the outcome.

        Returns None if the kernel is missing and there is no preview, or no need of one: for a job that refines a
        picture. The time and precision of pictures of something that moves are recorded.
        """
        try:
            if not self.renderer.is_ready(job.scene, job.samples) and not self._is_soon_prepared(job):
                pixels = None if job.base is not None else self.renderer.preview(job.scene, job.width, job.height)
                return None if pixels is None else Painted(job, pixels, preview=True)
        except Exception as error:  # the file of a texture may be gone meanwhile
            return Painted(job, error=error)
        single, start = not job.view and self._precision.is_single(urgent=job.urgent), time.perf_counter()
        renderer = self._precision.single if single else self.renderer
        outcome = paint(renderer, job, job.base, lambda: not (self._closed or self._is_superseded(job)))
        seconds = time.perf_counter() - start
        if job.urgent and outcome.pixels is not None and not job.view:
            self._precision.record(seconds / outcome.pixels.size, single=single)
        return replace(outcome, seconds=seconds, single=single)

    def _is_soon_prepared(self, job: PaintJob) -> bool:
        """Start to prepare the kernel, unless that has begun; return whether it is ready within PREVIEW_DELAY."""
        with self._changed:
            if not self._preparing:
                self._preparing = True
                self._threads[1:] = [threading.Thread(target=self._prepare, args=(job,), daemon=True)]
                self._threads[1].start()
                self._changed.wait_for(lambda: not self._preparing or self._closed, PREVIEW_DELAY)
            if not self._preparing:
                return self.renderer.is_ready(job.scene, job.samples)
            self._previewed = None if self._waiting else job
        return False

    def _prepare(self, job: PaintJob) -> None:
        """Prepare the kernel, then request the picture that was only previewed, unless another one is requested. This
        is the body of the second thread. Exceptions become outcomes."""
        error = None
        try:
            self.renderer.prepare(job.scene, job.samples)
        except Exception as reason:
            error = reason
        with self._changed:
            self._preparing = False
            if error:
                self.outcomes.append(Painted(job, error=error))
            elif not self._waiting:
                self._waiting = self._previewed
            self._previewed = None
            self._changed.notify_all()
        self.notify()

    def _is_superseded(self, job: PaintJob) -> bool:
        """Whether a newer request makes this picture useless."""
        waiting = self._waiting
        return waiting is not None and not (job.urgent and job.shows(job.scene, waiting.size))
