"""Which pictures are asked for, and when: none while nothing changes, coarse ones in haste, a fine one in the end."""

from __future__ import annotations

from dataclasses import replace

from minirt.mlx import Window
from minirt.scene import Scene
from minirt.viewer.pace import Pace
from minirt.viewer.painter import Job, Outcome, Painter


class Pictures:
    """The pictures of one window."""

    def __init__(self, painter: Painter, win: Window) -> None:
        self.painter = painter
        self.latest: Outcome | None = None  # the last one that came
        self._win = win
        self._pace = Pace()
        self._requested: Job | None = None

    @property
    def complete(self) -> bool:
        """Whether the latest picture is the one that was asked for last, in full resolution."""
        latest = self.latest
        return bool(latest and latest.job is self._requested and latest.job.divisor == 1 and not latest.preview)

    def want(self, scene: Scene, moving: bool) -> None:
        """Ask for what is missing of the picture of that scene; `moving`: it will soon be another."""
        width, height = self._win.width, self._win.height
        now = Job(scene, width, height)
        last = self._requested
        if last is None:
            self._request(now)
        elif not last.shows(scene, width, height):
            self._request(replace(now, divisor=self._pace.divisor(width, height), urgent=True))
        elif last.divisor > 1 and not moving and not self.painter.busy:
            self._request(now)

    def collect(self) -> list[Exception]:
        """Take what the painter has; returns the reasons for pictures that did not come."""
        errors = []
        for outcome in self.painter.take():
            if outcome.error:
                errors.append(outcome.error)
                continue
            if not outcome.preview:
                self._pace.learn(outcome)
            if outcome.pixels is not None:
                self.latest = outcome
            elif outcome.job is self._requested:
                self._requested = None  # cancelled, and there is no other
        return errors

    def _request(self, job: Job) -> None:
        self._requested = job
        self.painter.request(job)
