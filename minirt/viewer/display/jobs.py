"""Jobs of painters: requests for pictures, and the pictures that answer them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Scene

Pixels: TypeAlias = NDArray[np.uint8]  # (h, w, 4) BGRA
PASS_GROWTH = 4  # ratio of samples from one refinement pass to the next


@dataclass(frozen=True)
class PaintJob:
    """A request for a picture."""

    scene: Scene
    width: int  # at which it is shown
    height: int
    divisor: int = 1  # of width and height, for a coarser picture
    urgent: bool = False  # something moves: finish it although a newer request waits
    samples: int = 1  # per pixel
    goal: int = 1  # samples per pixel of the final picture, when nothing moves any more
    view: str = ""  # what it shows in place of colours: one of `minirt.viewer.display.views`
    base: Pixels | None = field(default=None, compare=False, repr=False)  # the same picture with fewer samples
    base_samples: int = 1  # samples per pixel of `base`

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of the picture's array, which is smaller than the window if the picture is coarse."""
        return -(-self.height // self.divisor), -(-self.width // self.divisor), 4

    @property
    def size(self) -> tuple[int, int]:
        """Width and height at which the picture is shown."""
        return self.width, self.height

    def shows(self, scene: Scene, size: tuple[int, int]) -> bool:
        """Whether this is a picture, however coarse, of that scene at that size."""
        return self.scene is scene and self.size == size


@dataclass(frozen=True, eq=False)
class Painted:
    """The result of a job: a picture, or an error, or neither if it was cancelled."""

    job: PaintJob
    pixels: Pixels | None = None
    error: Exception | None = None
    seconds: float = 0.0  # of rendering; 0 in simulated time
    error_estimate: float | None = None  # of a refined picture: see `minirt.rendering.sampling.packets`
    preview: bool = False  # another picture follows when the kernel is ready
    single: bool = False  # in single precision, as something moves
    about: tuple[str, ...] = ()  # notes on how it was rendered

    @property
    def is_final(self) -> bool:
        """Whether no better picture of the same scene follows."""
        return self.job.divisor == 1 and self.job.samples >= self.job.goal and not self.single

    def next(self) -> PaintJob:
        """Return the job that follows this picture: full resolution in double precision, or more samples."""
        job = self.job
        if job.divisor > 1 or self.single:
            return replace(job, divisor=1, urgent=False)
        samples = min(PASS_GROWTH * job.samples, job.goal)
        return replace(job, urgent=False, samples=samples, base=self.pixels, base_samples=job.samples)
