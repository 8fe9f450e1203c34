"""Pictures on request: what is wanted, what makes it, what became of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Scene

Pixels: TypeAlias = NDArray[np.uint8]  # (h, w, 4) BGRA


class Renderer(Protocol):
    """What makes pictures."""

    def prepare(self, scene: Scene) -> None:
        """Compile or load what the scene needs; may take seconds."""

    def stop(self) -> None:
        """From any thread: nobody waits for `prepare` any more; it ends soon if it can."""

    def preview(self, scene: Scene, width: int, height: int) -> Pixels | None:
        """A coarse picture, of at most that size, of what nothing is prepared for; None where that would take long."""

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
    def shape(self) -> tuple[int, int, int]:
        """Of the array of the picture, which is smaller than the window where it is coarser."""
        return -(-self.height // self.divisor), -(-self.width // self.divisor), 4

    @property
    def pixels(self) -> int:
        return self.shape[0] * self.shape[1]

    def shows(self, scene: Scene, width: int, height: int) -> bool:
        """Whether that is what it is a picture of, however coarse."""
        return self.scene is scene and (self.width, self.height) == (width, height)

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
    preview: bool = False  # another picture follows when the kernel is there


class Painter:
    """Renders before `request` returns: for replays, where time is simulated."""

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


def paint(renderer: Renderer, job: Job) -> Outcome:
    """Do a job."""
    pixels = np.empty(job.shape, np.uint8)
    try:
        if not renderer.is_ready(job.scene):
            renderer.prepare(job.scene)
        done = renderer.render(job.scene, pixels)
    except Exception as error:  # whatever it is, it is raised where the program is run, not here
        return Outcome(job, error=error)
    return Outcome(job, pixels if done else None)


def preview(renderer: Renderer, job: Job) -> Outcome:
    """Do what can be done of a job before the renderer is ready for it."""
    try:
        return Outcome(job, renderer.preview(job.scene, job.width, job.height), preview=True)
    except Exception as error:
        return Outcome(job, error=error)
