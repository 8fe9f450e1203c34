"""Rendering beside the window: the latest request wins, and what nobody waits for any more is cancelled."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Scene

Pixels = NDArray[np.uint8]  # (h, w, 4) BGRA


class Renderer(Protocol):
    """What makes pictures."""

    def prepare(self, scene: Scene) -> None:
        """Compile or load what the scene needs; may take seconds."""

    def is_ready(self, scene: Scene) -> bool:
        """Whether `render` would begin at once."""

    def render(self, scene: Scene, pixels: Pixels) -> bool:
        """Fill `pixels`; False when cancelled."""

    def cancel(self) -> None:
        """From any thread: a running `render` returns False soon."""


@dataclass(frozen=True)
class Job:
    """A picture that is wanted."""

    scene: Scene
    width: int  # of the window
    height: int
    divisor: int = 1  # of both, for a coarser picture
    urgent: bool = False  # worth finishing when another is wanted already: something moves

    @property
    def pixels(self) -> int:
        width, height = self.rendered
        return width * height

    @property
    def rendered(self) -> tuple[int, int]:
        """The size of the coarser picture."""
        return -(-self.width // self.divisor), -(-self.height // self.divisor)

    def outlives(self, newer: Job) -> bool:
        """Whether it should be finished although a newer one waits."""
        return self.urgent and (self.width, self.height) == (newer.width, newer.height)


@dataclass(frozen=True)
class Outcome:
    """What became of a job: a picture, or the reason why there is none, or neither when it was cancelled."""

    job: Job
    pixels: Pixels | None = None
    seconds: float | None = None  # of rendering; None where time is not real
    error: Exception | None = None


class Painter:
    """Renders when asked to, before `request` returns: for replays, where time is simulated."""

    compiling = False

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        self.renderer = renderer
        self.notify = notify  # called when there is something to `take`
        self._outcomes: list[Outcome] = []

    def request(self, job: Job) -> None:
        """Ask for a picture."""
        self._outcomes.append(self._paint(job))
        self.notify()

    def take(self) -> list[Outcome]:
        """What was finished since the last call, oldest first."""
        taken, self._outcomes = self._outcomes, []
        return taken

    @property
    def busy(self) -> bool:
        """Whether a picture is under way."""
        return False

    def close(self, patience: float = 0.0) -> bool:
        """Stop; whether nothing is running any more after at most `patience` seconds."""
        return True

    def _paint(self, job: Job) -> Outcome:
        width, height = job.rendered
        pixels = np.empty((height, width, 4), np.uint8)
        try:
            if not self.renderer.is_ready(job.scene):
                self.renderer.prepare(job.scene)
            done = self.renderer.render(job.scene, pixels)
        except Exception as error:  # it belongs to the thread of the window
            return Outcome(job, error=error)
        return Outcome(job, pixels if done else None)


class BackgroundPainter(Painter):
    """Renders in a thread of its own. `notify` is called from there."""

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        super().__init__(renderer, notify)
        self._changed = threading.Condition()
        self._waiting: Job | None = None
        self._running: Job | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="painter", daemon=True)

    def request(self, job: Job) -> None:
        with self._changed:
            self._waiting = job
            if not self._thread.ident:
                self._thread.start()
            self._changed.notify()
            if self._running and not self._running.outlives(job):
                self.renderer.cancel()

    def take(self) -> list[Outcome]:
        with self._changed:
            return super().take()

    @property
    def busy(self) -> bool:
        with self._changed:
            return bool(self._waiting or self._running or self._outcomes)

    def close(self, patience: float = 0.0) -> bool:
        with self._changed:
            self._closed = True
            self._changed.notify()
        if not self._thread.ident:
            return True
        self.renderer.cancel()
        self._thread.join(patience)
        return not self._thread.is_alive()

    def _work(self) -> None:
        while job := self._next():
            outcome = self._timed(job)
            with self._changed:
                self._running = None
                if not self._closed:
                    self._outcomes.append(outcome)
            self._tell()

    def _next(self) -> Job | None:
        """The latest request, as soon as there is one; None when closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._closed)
            self._running, self._waiting = self._waiting, None
            return None if self._closed else self._running

    def _timed(self, job: Job) -> Outcome:
        start = time.perf_counter()
        return self._paint(job)

    def _tell(self) -> None:
        if not self._closed:
            self.notify()
