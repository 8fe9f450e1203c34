"""Background rendering: a thread that renders the latest request and cancels pictures that are no longer wanted.

Until the kernel for a scene is compiled, its pictures are previews; the last one is then rendered again.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from minirt.viewer.display.painter import Job, Outcome, Painter, paint, preview

if TYPE_CHECKING:
    from minirt.rendering.renderer import Renderer

PREVIEW_DELAY = 0.4  # seconds that a kernel may take before a preview appears: loading one takes less


class BackgroundPainter(Painter):
    """A painter with a thread for rendering, started by the first request, and another for compiling kernels.

    Both threads call `notify`.
    """

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        super().__init__(renderer, notify)
        renderer.give_way()
        renderer.specialise_early(self._describe_again)
        self._changed = threading.Condition()
        self._waiting: Job | None = None
        self._running: Job | None = None
        self._last: Job | None = None
        self._previewed: Job | None = None  # to be rendered again when the kernel is ready
        self._closed = False
        self._preparing = False
        self._threads = [threading.Thread(target=self._work, name="minirt-painter", daemon=True)]

    @property
    def busy(self) -> bool:
        with self._changed:
            return bool(self._waiting or self._running or self._previewed or self.outcomes)

    def request(self, job: Job) -> None:
        with self._changed:
            self._waiting, self._previewed = job, None
            self._changed.notify_all()
            if self._running and self._is_superseded(self._running):
                self.renderer.cancel()
        if self._threads[0].ident is None:
            self._threads[0].start()

    def take(self) -> list[Outcome]:
        with self._changed:
            return super().take()

    def close(self, patience: float) -> bool:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if self._threads[0].ident is None:
            return True
        self.renderer.stop()
        self.renderer.cancel()
        end = time.monotonic() + patience
        for thread in self._threads:
            thread.join(max(0.0, end - time.monotonic()))
        return not any(thread.is_alive() for thread in self._threads)

    def _work(self) -> None:
        """Render requests until the painter is closed: the body of the thread."""
        while job := self._next():
            outcome = self._render(job)
            with self._changed:
                self._running = None
                if outcome:
                    self._add(outcome)
                # The loop need not wake to learn that a picture made room for the next: drawing would delay that one.
                made_room = self._waiting is not None and not any(map(is_news, self.outcomes))
            if not made_room:
                self._notify()

    def _describe_again(self) -> None:
        """Renew the notes on the last picture: a faster kernel has been compiled. Callable from any thread."""
        about = tuple(self.renderer.about)
        with self._changed:
            if self._last:
                self.outcomes.append(Outcome(self._last, about=about))
        self._notify()

    def _add(self, outcome: Outcome) -> None:
        """Add an outcome; a new picture replaces older ones that nobody took."""
        if outcome.pixels is not None:
            self.outcomes = [each for each in self.outcomes if each.pixels is None]
        self.outcomes.append(outcome)

    def _next(self) -> Job | None:
        """Wait for a request and return the latest; None when closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._closed)
            self._running, self._waiting = self._waiting, None
            self._last = self._running
            return None if self._closed else self._running

    def _render(self, job: Job) -> Outcome | None:
        """Render a job, or its preview while its kernel is missing; None if it has neither."""
        if not self.renderer.is_ready(job.scene) and not self._is_soon_prepared(job):
            outcome = preview(self.renderer, job)
            return outcome if outcome.pixels is not None or outcome.error else None
        start = time.perf_counter()
        outcome = paint(self.renderer, job, job.base, lambda: not (self._closed or self._is_superseded(job)))
        return replace(outcome, seconds=time.perf_counter() - start)

    def _is_soon_prepared(self, job: Job) -> bool:
        """Start to prepare the kernel, unless that has begun; return whether it is ready within PREVIEW_DELAY."""
        with self._changed:
            if not self._preparing:
                self._preparing = True
                self._threads[1:] = [threading.Thread(target=self._prepare, args=(job,), daemon=True)]
                self._threads[1].start()
                self._changed.wait_for(lambda: not self._preparing or self._closed, PREVIEW_DELAY)
            if not self._preparing:
                return self.renderer.is_ready(job.scene)
            self._previewed = None if self._waiting else job
        return False

    def _prepare(self, job: Job) -> None:
        """Prepare the kernel, then request the picture that was only previewed: the body of the second thread."""
        error = None
        try:
            self.renderer.prepare(job.scene)
        except Exception as reason:
            error = reason
        with self._changed:
            self._preparing = False
            if error:
                self.outcomes.append(Outcome(job, error=error))
            elif not self._waiting:
                self._waiting = self._previewed
            self._previewed = None
            self._changed.notify_all()
        self._notify()

    def _is_superseded(self, job: Job) -> bool:
        """Whether a newer request makes this picture useless."""
        waiting = self._waiting
        return waiting is not None and not job.outlives(waiting)

    def _notify(self) -> None:
        if not self._closed:
            self.notify()


def is_news(outcome: Outcome) -> bool:
    """Whether an outcome has something to show."""
    return outcome.pixels is not None or outcome.error is not None
