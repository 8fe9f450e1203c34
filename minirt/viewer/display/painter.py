"""Render jobs and their outcomes, and a painter that renders at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.sampling.contrast import estimated_error
from minirt.scene import Scene

if TYPE_CHECKING:
    from minirt.rendering.renderer import Renderer

Pixels: TypeAlias = NDArray[np.uint8]  # (h, w, 4) BGRA
IsWanted: TypeAlias = Callable[[], bool]  # whether a picture is still wanted

PASS_GROWTH = 4  # ratio of samples from one refinement pass to the next


@dataclass(frozen=True)
class Job:
    """A request for a picture."""

    scene: Scene
    width: int  # of the window
    height: int
    divisor: int = 1  # of width and height, for a coarser picture
    urgent: bool = False  # something moves: finish it although a newer request waits
    samples: int = 1  # per pixel
    goal: int = 1  # samples per pixel of the final picture, when nothing moves any more
    base: Pixels | None = field(default=None, compare=False, repr=False)  # the same picture with fewer samples
    base_samples: int = 1  # samples per pixel of `base`

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of the picture's array, which is smaller than the window if the picture is coarse."""
        return -(-self.height // self.divisor), -(-self.width // self.divisor), 4

    @property
    def pixels(self) -> int:
        """Number of pixels to render."""
        return self.shape[0] * self.shape[1]

    def shows(self, scene: Scene, width: int, height: int) -> bool:
        """Whether this is a picture, however coarse, of that scene at that size."""
        return self.scene is scene and (self.width, self.height) == (width, height)

    @property
    def is_final(self) -> bool:
        """Whether no better picture of the same scene follows."""
        return self.divisor == 1 and self.samples >= self.goal

    def next(self, pixels: Pixels) -> Job:
        """Return the job that follows when this one gave `pixels`: full resolution, or more samples."""
        if self.divisor > 1:
            return replace(self, divisor=1, urgent=False)
        samples = min(PASS_GROWTH * self.samples, self.goal)
        return replace(self, urgent=False, samples=samples, base=pixels, base_samples=self.samples)

    def outlives(self, newer: Job) -> bool:
        """Whether this job is worth finishing although a newer one waits."""
        return self.urgent and (self.width, self.height) == (newer.width, newer.height)


@dataclass(frozen=True, eq=False)
class Outcome:
    """The result of a job: a picture, or an error, or neither if it was cancelled.

    Notes without a picture replace those of the latest picture: the renderer has changed, and the pixels would not.
    """

    job: Job
    pixels: Pixels | None = None
    error: Exception | None = None
    seconds: float = 0.0  # of rendering; 0 in simulated time
    error_estimate: float | None = None  # of a refined picture: see `minirt.rendering.sampling.contrast`
    preview: bool = False  # another picture follows when the kernel is ready
    about: tuple[str, ...] = ()  # notes on how it was rendered


class Painter:
    """A painter that renders before `request` returns: for replays, where time is simulated.

    All pixels get all samples, as in a picture that is rendered without a window.
    """

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        """`notify` is called when there are outcomes to take."""
        self.renderer = renderer
        self.notify = notify
        self.outcomes: list[Outcome] = []

    @property
    def busy(self) -> bool:
        """Whether there are or will be outcomes to take."""
        return bool(self.outcomes)

    def request(self, job: Job) -> None:
        """Request a picture."""
        self.outcomes.append(paint(self.renderer, job))
        self.notify()

    def take(self) -> list[Outcome]:
        """Return the outcomes since the last call, oldest first."""
        taken, self.outcomes = self.outcomes, []
        return taken

    def close(self, patience: float) -> bool:
        """Stop; return whether all threads have ended within `patience` seconds."""
        return True


def paint(renderer: Renderer, job: Job, base: Pixels | None = None, is_wanted: IsWanted = lambda: True) -> Outcome:
    """Render a job: all pixels, or only the edges in a copy of `base`."""
    pixels = np.empty(job.shape, np.uint8) if base is None else base.copy()
    try:
        render = renderer.render if base is None else renderer.refine
        done = render(job.scene, pixels, job.samples, is_wanted=is_wanted)
    except Exception as error:  # of any kind: the session raises it in the main thread
        return Outcome(job, error=error)
    if not done:
        return Outcome(job)
    about = () if job.urgent else tuple(renderer.about)
    if base is None:
        return Outcome(job, pixels, about=about)
    tone = job.scene.camera.tone
    estimate = estimated_error(base, pixels, job.base_samples, job.samples, is_wanted, tone)
    return Outcome(job) if estimate is None else Outcome(job, pixels, error_estimate=estimate, about=about)


def preview(renderer: Renderer, job: Job) -> Outcome:
    """Render the preview of a job whose kernel is not ready."""
    try:
        return Outcome(job, renderer.preview(job.scene, job.width, job.height), preview=True)
    except Exception as error:
        return Outcome(job, error=error)
