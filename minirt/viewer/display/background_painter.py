"""Rendering beside the window: the latest request wins, and what nobody waits for any more is cancelled.

Until the kernel for a scene is there, its pictures are previews; the last of them is then made again.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace

from minirt.viewer.display.painter import Job, Outcome, Painter, Renderer, paint, preview

GRACE = 0.4  # seconds until a kernel that is not there yet is worth a preview and a word: loading one takes less


class BackgroundPainter(Painter):
    """Renders in a thread of its own, which starts with the first request; another has kernels made. `notify` is called
    from both."""

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        super().__init__(renderer, notify)
        self._changed = threading.Condition()
        self._waiting: Job | None = None
        self._running: Job | None = None
        self._previewed: Job | None = None  # to be made again when the kernel is there
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
            if self._running and self._superseded(self._running):
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
        while job := self._next():
            outcome = self._do(job)
            with self._changed:
                self._running = None
                if outcome:
                    self._add(outcome)
            self._tell()

    def _add(self, outcome: Outcome) -> None:
        """Of the pictures that nobody took yet only the last will be looked at."""
        if outcome.pixels is not None:
            self.outcomes = [each for each in self.outcomes if each.pixels is None]
        self.outcomes.append(outcome)

    def _next(self) -> Job | None:
        """The latest request, as soon as there is one; None when closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._closed)
            self._running, self._waiting = self._waiting, None
            return None if self._closed else self._running

    def _do(self, job: Job) -> Outcome | None:
        """What becomes of a job; None where there is no kernel for it yet and no preview of it."""
        if not self.renderer.is_ready(job.scene) and not self._prepared_soon(job):
            outcome = preview(self.renderer, job)
            return outcome if outcome.pixels is not None or outcome.error else None
        start = time.perf_counter()
        outcome = paint(self.renderer, job, job.base, lambda: not (self._closed or self._superseded(job)))
        return replace(outcome, seconds=time.perf_counter() - start)

    def _prepared_soon(self, job: Job) -> bool:
        """Have the kernel made, unless that is under way; whether it is there before the time of grace is over."""
        with self._changed:
            if not self._preparing:
                self._preparing = True
                self._threads[1:] = [threading.Thread(target=self._prepare, args=(job,), daemon=True)]
                self._threads[1].start()
                self._changed.wait_for(lambda: not self._preparing or self._closed, GRACE)
            if not self._preparing:
                return self.renderer.is_ready(job.scene)
            self.compiling = True
            self._previewed = None if self._waiting else job
        self._tell()
        return False

    def _prepare(self, job: Job) -> None:
        """Have the kernel made and then, if it was missed, the picture."""
        error = None
        try:
            self.renderer.prepare(job.scene)
        except Exception as reason:
            error = reason
        with self._changed:
            self._preparing = self.compiling = False
            if error:
                self.outcomes.append(Outcome(job, error=error))
            elif not self._waiting:
                self._waiting = self._previewed
            self._previewed = None
            self._changed.notify_all()
        self._tell()

    def _superseded(self, job: Job) -> bool:
        """Whether nobody waits for that picture any more."""
        waiting = self._waiting
        return waiting is not None and not job.outlives(waiting)

    def _tell(self) -> None:
        if not self._closed:
            self.notify()
