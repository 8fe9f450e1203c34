"""Rendering beside the window: the latest request wins, and what nobody waits for any more is cancelled."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace

from minirt.viewer.painter import Job, Outcome, Painter, Renderer, paint


class BackgroundPainter(Painter):
    """Renders in a thread of its own, which starts with the first request. `notify` is called from there."""

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        super().__init__(renderer, notify)
        self._changed = threading.Condition()
        self._waiting: Job | None = None
        self._running: Job | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="minirt-painter", daemon=True)

    @property
    def busy(self) -> bool:
        with self._changed:
            return bool(self._waiting or self._running or self.outcomes)

    def request(self, job: Job) -> None:
        with self._changed:
            self._waiting = job
            self._changed.notify()
            if self._running and self._superseded(self._running):
                self.renderer.cancel()
        if self._thread.ident is None:
            self._thread.start()

    def take(self) -> list[Outcome]:
        with self._changed:
            return super().take()

    def close(self, patience: float) -> bool:
        with self._changed:
            self._closed = True
            self._changed.notify()
        if self._thread.ident is None:
            return True
        self.renderer.cancel()
        self._thread.join(patience)
        return not self._thread.is_alive()

    def _work(self) -> None:
        while job := self._next():
            outcome = self._do(job)
            with self._changed:
                self._running = None
                self.outcomes.append(outcome)
            self._tell()

    def _next(self) -> Job | None:
        """The latest request, as soon as there is one; None when closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._closed)
            self._running, self._waiting = self._waiting, None
            return None if self._closed else self._running

    def _do(self, job: Job) -> Outcome:
        try:
            if not self.renderer.is_ready(job.scene):
                self.compiling = True
                self._tell()
                self.renderer.prepare(job.scene)
        except Exception as error:
            return Outcome(job, error=error)
        finally:
            self.compiling = False
        if self._closed or self._superseded(job):
            return Outcome(job)
        start = time.perf_counter()
        return replace(paint(self.renderer, job), seconds=time.perf_counter() - start)

    def _superseded(self, job: Job) -> bool:
        """Whether nobody waits for that picture any more."""
        waiting = self._waiting
        return waiting is not None and not job.outlives(waiting)

    def _tell(self) -> None:
        if not self._closed:
            self.notify()
