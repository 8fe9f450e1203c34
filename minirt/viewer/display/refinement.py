"""Progressive refinement: request coarse pictures while something moves, then finer ones until the final picture."""

from __future__ import annotations

from dataclasses import replace

from minirt.mlx import Window
from minirt.scene import Scene
from minirt.viewer.display.adaptive_resolution import AdaptiveResolution
from minirt.viewer.display.painter import Job, Outcome, Painter


class Refinement:
    """The sequence of pictures of one window; the final one has `samples` rays per pixel."""

    def __init__(self, painter: Painter, window: Window, samples: int) -> None:
        self.painter = painter
        self.resolution = AdaptiveResolution()
        self.latest: Outcome | None = None  # the latest picture
        self._window = window
        self._samples = samples
        self._requested: Job | None = None

    @property
    def complete(self) -> bool:
        """Whether the latest picture is the final one of the last request."""
        return self._answer is not None and self._answer.job.is_final

    def request_missing(self, scene: Scene, moving: bool) -> None:
        """Request the next picture of a scene, if one is missing; `moving`: the scene will change again soon."""
        width, height = self._window.width, self._window.height
        last = self._requested
        if last is None:
            self._request(Job(scene, width, height, goal=self._samples))
        elif not last.shows(scene, width, height):
            divisor = self.resolution.divisor(width, height)
            self._request(Job(scene, width, height, divisor, urgent=True, goal=self._samples))
        elif not moving and (answer := self._answer) and answer.pixels is not None and not answer.job.is_final:
            self._request(last.next(answer.pixels))

    def collect(self) -> list[Exception]:
        """Take the outcomes of the painter; return the errors among them."""
        errors = []
        for outcome in self.painter.take():
            if outcome.error:
                errors.append(outcome.error)
                continue
            if outcome.pixels is None and outcome.about:
                self._renew_notes(outcome)
                continue
            if not outcome.preview:
                self.resolution.record(outcome)
            if outcome.pixels is not None:
                self.latest = outcome
            elif outcome.job is self._requested:
                self._request(outcome.job)  # it was cancelled, but no other request replaced it
        return errors

    def _renew_notes(self, outcome: Outcome) -> None:
        """Replace the notes of the latest picture if it shows the same scene: the picture stays as it is."""
        latest = self.latest
        if latest and latest.job.scene is outcome.job.scene:
            self.latest = replace(latest, about=outcome.about)

    @property
    def _answer(self) -> Outcome | None:
        """The latest picture, if it answers the last request and is no preview."""
        latest = self.latest
        return latest if latest and latest.job is self._requested and not latest.preview else None

    def _request(self, job: Job) -> None:
        self._requested = job
        self.painter.request(job)
