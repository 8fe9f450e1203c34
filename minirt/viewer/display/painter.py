"""Pictures on request: what is wanted, what makes it, what became of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.sampling.error_estimate import estimated_error
from minirt.scene import Scene
from minirt.shapes import Shape

Pixels: TypeAlias = NDArray[np.uint8]  # (h, w, 4) BGRA
Wanted: TypeAlias = Callable[[], bool]  # whether somebody still waits for a picture

MORE = 4  # times the samples of one pass are those of the next


class Renderer(Protocol):
    """What makes pictures."""

    def prepare(self, scene: Scene) -> None:
        """Compile or load what the scene needs; may take seconds."""

    def stop(self) -> None:
        """From any thread: nobody waits for `prepare` any more; it ends soon if it can."""

    def preview(self, scene: Scene, width: int, height: int) -> Pixels | None:
        """A coarse picture, of at most that size, of what nothing is prepared for; None where that would take long."""

    def pick(self, scene: Scene, width: int, height: int, x: int, y: int) -> Shape | None:
        """What is seen in a pixel of a picture of that size."""

    @property
    def about(self) -> Sequence[str]:
        """How the last picture was made, in words."""

    def is_ready(self, scene: Scene) -> bool:
        """Whether `render` would begin at once."""

    def render(self, scene: Scene, pixels: Pixels, samples: int = 1, *, is_wanted: Wanted = ...) -> bool:
        """Fill `pixels`; False when cancelled, or where `is_wanted` says so once `cancel` has an effect."""

    def refine(self, scene: Scene, pixels: Pixels, samples: int, *, is_wanted: Wanted = ...) -> bool:
        """Render the edges in `pixels` with more samples; False as above."""

    def cancel(self) -> None:
        """From any thread: a running `render` or `refine` returns False soon."""


@dataclass(frozen=True)
class Job:
    """A picture that is wanted."""

    scene: Scene
    width: int  # of the window
    height: int
    divisor: int = 1  # of both, for a coarser picture
    urgent: bool = False  # worth finishing when another is wanted already: something moves
    samples: int = 1  # of a pixel
    goal: int = 1  # samples of the last picture, when nothing moves any more
    base: Pixels | None = field(default=None, compare=False, repr=False)  # the same picture with fewer samples
    fewer: int = 1  # samples of that

    @property
    def shape(self) -> tuple[int, int, int]:
        """Of the array of the picture, which is smaller than the window where it is coarser."""
        return -(-self.height // self.divisor), -(-self.width // self.divisor), 4

    @property
    def pixels(self) -> int:
        return self.shape[0] * self.shape[1]

    def shows(self, scene: Scene, width: int, height: int) -> bool:
        """Whether that is what it is a picture of, however coarse."""
        return self.scene is scene and (self.width, self.height) == (width, height)

    @property
    def is_last(self) -> bool:
        """Whether no picture of the same is better."""
        return self.divisor == 1 and self.samples >= self.goal

    def next(self, pixels: Pixels) -> Job:
        """The next better one, where that became `pixels`: in full resolution, or with more samples."""
        if self.divisor > 1:
            return replace(self, divisor=1, urgent=False)
        samples = min(MORE * self.samples, self.goal)
        return replace(self, urgent=False, samples=samples, base=pixels, fewer=self.samples)

    def outlives(self, newer: Job) -> bool:
        """Whether it should be finished although a newer one waits."""
        return self.urgent and (self.width, self.height) == (newer.width, newer.height)


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of a job: a picture, or the reason why there is none, or neither when it was cancelled."""

    job: Job
    pixels: Pixels | None = None
    error: Exception | None = None
    seconds: float = 0.0  # of rendering; 0 where time is not real
    estimate: float | None = (
        None  # of the error, where a picture was refined: see `minirt.rendering.sampling.error_estimate`
    )
    preview: bool = False  # another picture follows when the kernel is there
    about: tuple[str, ...] = ()  # how it was made, in words


class Painter:
    """Renders before `request` returns: for replays, where time is simulated. All pixels get all samples, as in a
    picture that is made without a window."""

    compiling = False  # the first picture waits for the kernel

    def __init__(self, renderer: Renderer, notify: Callable[[], object]) -> None:
        """`notify` is called when there is something to `take`."""
        self.renderer = renderer
        self.notify = notify
        self.outcomes: list[Outcome] = []

    @property
    def busy(self) -> bool:
        """Whether there is or will be something to take."""
        return bool(self.outcomes)

    def request(self, job: Job) -> None:
        """Ask for a picture."""
        self.outcomes.append(paint(self.renderer, job))
        self.notify()

    def take(self) -> list[Outcome]:
        """What came to an end since the last call, oldest first."""
        taken, self.outcomes = self.outcomes, []
        return taken

    def close(self, patience: float) -> bool:
        """Stop; whether nothing runs any more after at most `patience` seconds."""
        return True


def paint(renderer: Renderer, job: Job, base: Pixels | None = None, is_wanted: Wanted = lambda: True) -> Outcome:
    """Do a job; on `base`, which stays as it is, only where it has edges."""
    pixels = np.empty(job.shape, np.uint8) if base is None else base.copy()
    try:
        if not renderer.is_ready(job.scene):
            renderer.prepare(job.scene)
        make = renderer.render if base is None else renderer.refine
        done = make(job.scene, pixels, job.samples, is_wanted=is_wanted)
    except Exception as error:  # whatever it is, it is raised where the program is run, not here
        return Outcome(job, error=error)
    if not done:
        return Outcome(job)
    about = () if job.urgent else tuple(renderer.about)
    estimate = None if base is None else estimated_error(base, pixels, job.fewer, job.samples)
    return Outcome(job, pixels, estimate=estimate, about=about)


def preview(renderer: Renderer, job: Job) -> Outcome:
    """Do what can be done of a job before the renderer is ready for it."""
    try:
        return Outcome(job, renderer.preview(job.scene, job.width, job.height), preview=True)
    except Exception as error:
        return Outcome(job, error=error)
