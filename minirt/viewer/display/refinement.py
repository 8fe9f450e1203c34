"""Which pictures are asked for, and when: coarse ones in haste, then finer and finer ones, and none in the end."""

from __future__ import annotations

from minirt.mlx import Window
from minirt.scene import Scene
from minirt.viewer.display.adaptive_resolution import AdaptiveResolution
from minirt.viewer.display.painter import Job, Outcome, Painter


class Refinement:
    """The pictures of one window; the last one of what does not move has so many samples a pixel."""

    def __init__(self, painter: Painter, win: Window, samples: int) -> None:
        self.painter = painter
        self.pace = AdaptiveResolution()
        self.latest: Outcome | None = None  # the last one that came
        self._win = win
        self._samples = samples
        self._requested: Job | None = None

    @property
    def complete(self) -> bool:
        """Whether the latest picture is the best there will be of what was asked for last."""
        return self._answered is not None and self._answered.job.is_last

    def want(self, scene: Scene, moving: bool) -> None:
        """Ask for what is missing of the picture of that scene; `moving`: it will soon be another."""
        width, height = self._win.width, self._win.height
        last = self._requested
        if last is None:
            self._request(Job(scene, width, height, goal=self._samples))
        elif not last.shows(scene, width, height):
            divisor = self.pace.divisor(width, height)
            self._request(Job(scene, width, height, divisor, urgent=True, goal=self._samples))
        elif not moving and (shown := self._answered) and shown.pixels is not None and not shown.job.is_last:
            self._request(last.next(shown.pixels))

    def collect(self) -> list[Exception]:
        """Take what the painter has; returns the reasons for pictures that did not come."""
        errors = []
        for outcome in self.painter.take():
            if outcome.error:
                errors.append(outcome.error)
                continue
            if not outcome.preview:
                self.pace.learn(outcome)
            if outcome.pixels is not None:
                self.latest = outcome
            elif outcome.job is self._requested:
                self._request(outcome.job)  # cancelled, and there is no other
        return errors

    @property
    def _answered(self) -> Outcome | None:
        """The latest picture, where it is what was asked for last and no preview of it."""
        latest = self.latest
        return latest if latest and latest.job is self._requested and not latest.preview else None

    def _request(self, job: Job) -> None:
        self._requested = job
        self.painter.request(job)
