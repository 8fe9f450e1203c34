"""Progressive refinement: pictures as coarse as a steady frame rate needs while something moves, then finer ones."""

from __future__ import annotations

from collections import deque
from math import prod
from statistics import median_low
from typing import Any

from minirt.scene import Scene
from minirt.viewer.display.jobs import Painted, PaintJob, Pixels
from minirt.viewer.display.painter import Painter

FRAME_TIME = 0.016  # seconds from a key to its picture on the screen while something moves
DIVISORS = (1, 2, 3, 4, 6, 8, 12)  # of width and height
FINER_SHARE = 0.8  # of the time: a finer picture must fit into it before it replaces a coarser one
TRIAL_EXCESS = 1.5  # times the time: a finer picture that is estimated to take at most this is tried all the same ...
TRIAL_INTERVAL = 30  # ... after so many pictures in a row


class Refinement:
    """The sequence of pictures of one window; the final one has `samples` rays per pixel."""

    def __init__(self, painter: Painter, samples: int) -> None:
        self.painter = painter
        self.resolution = AdaptiveResolution()
        self.latest: Painted | None = None  # the latest picture
        self.samples = samples
        self.view = ""  # what pictures show in place of colours
        self._requested: PaintJob | None = None

    def restart(self, samples: int) -> None:
        """Let the next request be that of a first picture, whose final one has so many rays per pixel."""
        self.samples, self._requested = samples, None

    def shown(self, drawn: Painted | None, size: tuple[int, int]) -> Painted | None:
        """The latest picture; or the one that is drawn, of this size, while the same is rendered at another one."""
        latest = self.latest
        is_kept = drawn and latest and latest.job.size != size and drawn.job.shows(latest.job.scene, size)
        return drawn if is_kept else latest

    def finished(self, size: tuple[int, int]) -> Pixels | None:
        """The pixels of the final picture, if that is complete and of this size."""
        return self.latest.pixels if self.complete and self.latest and self.latest.job.size == size else None

    def resume(self, drawn: Painted | None, size: tuple[int, int]) -> None:
        """Go on after the picture that was kept while another size was rendered."""
        kept = self.shown(drawn, size)
        if kept and kept is not self.latest:
            self.latest, self._requested = kept, kept.job

    def show_view(self, view: str) -> None:
        """Let the next request be that of a first picture of a view."""
        self.view, self._requested = view, None

    @property
    def complete(self) -> bool:
        """Whether the latest picture is the final one of the last request."""
        return self._answer is not None and self._answer.is_final

    def request_missing(self, scene: Scene, size: tuple[int, int], moving: bool) -> None:
        """Request the next picture of a scene, if one is missing; `moving`: the scene will change again soon."""
        last = self._requested
        how: dict[str, Any] = {"view": self.view} if self.view else {"goal": self.samples}
        if last is None:
            self._request(PaintJob(scene, *size, **how))
        elif not last.shows(scene, size):
            divisor = self.resolution.divisor(*size)
            self._request(PaintJob(scene, *size, divisor, urgent=True, **how))
        elif not moving and (answer := self._answer) and answer.pixels is not None and not answer.is_final:
            self._request(answer.next())

    def collect(self) -> list[Exception]:
        """Take the outcomes of the painter, and make the last picture among them `latest`; return the errors.

        Their times are recorded. A job that was cancelled and is still wanted is requested again.
        """
        errors = []
        for outcome in self.painter.take():
            if outcome.error:
                errors.append(outcome.error)
                continue
            # A recorded still picture sets the resolution of the next movement: one that is late must not.
            is_still = outcome.pixels is not None and not outcome.job.urgent
            is_late = is_still and outcome.job is not self._requested
            if not outcome.preview and not is_late:
                self.resolution.record(outcome)
            if outcome.pixels is not None:
                self.latest = outcome
            elif outcome.job is self._requested:
                self._request(outcome.job)  # it was cancelled, but no other request replaced it
        return errors

    @property
    def _answer(self) -> Painted | None:
        """The latest picture, if it answers the last request and is no preview."""
        latest = self.latest
        return latest if latest and latest.job is self._requested and not latest.preview else None

    def _request(self, job: PaintJob) -> None:
        self._requested = job
        self.painter.request(job)


class AdaptiveResolution:
    """Choose the resolution from the measured time of rendering and of displaying pictures.

    Coarse pictures cost more a pixel: a finer one is tried now and then, ever less often until nothing moves. How much
    more than the still picture before them is learned from the last movements.
    """

    def __init__(self) -> None:
        # The median of the last times counts: a single slow picture changes nothing.
        self._costs: deque[float] = deque(maxlen=3)  # seconds per pixel
        self.display_times: deque[float] = deque(maxlen=3)  # seconds per picture
        self._excesses: deque[float] = deque(maxlen=3)  # cost of the first coarse picture by that of the still one
        self._measured = 0  # the divisor that had these costs; 0 while nothing is known
        self._chosen = DIVISORS[-1]
        self._candidates = 0  # pictures in a row after which a finer one seemed possible
        self._trial_interval = TRIAL_INTERVAL

    def record(self, outcome: Painted) -> None:
        """Record the time of a picture that was finished, or was cancelled after more than the median time. Pictures of
        several samples a pixel do not count. One of a scene that does not move chooses its divisor, too."""
        job, cost = outcome.job, 4 * outcome.seconds / prod(outcome.job.shape)  # of a pixel, which has four bytes
        if job.samples > 1:
            return
        if outcome.pixels is None:
            if job.divisor == self._measured and cost > median_low(self._costs):
                self._costs.append(cost)
            return
        if job.divisor != self._measured:
            if self._measured == 1:  # the first coarse picture after a still one
                self._excesses.append(max(1.0, cost / median_low(self._costs)))
            self._costs.clear()
            self._measured = job.divisor
        self._costs.append(cost)
        if not job.urgent:  # nothing moves: the next movement begins with the resolution of this picture
            self._chosen, self._candidates, self._trial_interval = job.divisor, 0, TRIAL_INTERVAL

    @property
    def rate(self) -> float:
        """Primary rays per second, 0 while nothing is known."""
        cost = median_low(self._costs) if self._costs else 0.0
        return 1 / cost if cost else 0.0

    def divisor(self, width: int, height: int) -> int:
        """Return the least divisor that is fast enough; the greatest if none is, or while nothing is known."""
        if self._measured == self._chosen:
            self._chosen = self._next_divisor(median_low(self._costs) * width * height)
        return self._chosen

    def _next_divisor(self, seconds: float) -> int:
        """Return the divisor that should follow the chosen one, given the estimated time of a picture at full size.

        The chosen one stays until it is too slow or a finer one fits into FINER_SHARE of the time. After
        `_trial_interval` calls in a row in which a finer one might be fast enough that one is tried; then twice as many
        calls have to pass.
        """
        if self._chosen == 1 and seconds > self._time:
            return least_divisor(seconds * (median_low(self._excesses) if self._excesses else 1.0), self._time)
        fitting, easy = least_divisor(seconds, self._time), least_divisor(seconds, self._time * FINER_SHARE)
        better = min(max(self._chosen, fitting), easy)
        possible = least_divisor(seconds, self._time * TRIAL_EXCESS)
        self._candidates = self._candidates + 1 if possible < better == self._chosen else 0
        if self._candidates < self._trial_interval:
            return better
        self._candidates, self._trial_interval = 0, 2 * self._trial_interval
        return possible

    @property
    def _time(self) -> float:
        """Seconds left for rendering: at least half a frame, since coarser pictures do not help a slow screen."""
        display_time = median_low(self.display_times) if self.display_times else 0.0
        return max(FRAME_TIME - display_time, FRAME_TIME / 2)


def least_divisor(seconds: float, time: float) -> int:
    """Return the least divisor that reduces `seconds` to `time`, or the greatest."""
    return next((each for each in DIVISORS if seconds <= time * each * each), DIVISORS[-1])
