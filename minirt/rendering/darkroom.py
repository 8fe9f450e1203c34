"""Darkroom of a renderer: keeps the light of a picture until its levels are made, where the kernel's own do not serve.

The kernel rounds light in proportion to levels. What other tones and dithering cost is spent here, after it: the kernel
stays as it is, and so does sampling, whose contrast and errors are those of light clamped to [0, 1].
"""

from __future__ import annotations

from collections.abc import Callable
from math import nan, sqrt

import numpy as np

from minirt.rendering.crop import Crop
from minirt.rendering.developing.develop import develop, needs_developing, rounding_error
from minirt.rendering.developing.tone import PLAIN
from minirt.rendering.frame_arguments import NO_LINEAR
from minirt.rendering.running.frame_runner import FrameRunner
from minirt.rendering.sampling.outcome import ROUNDING, Outcome
from minirt.scene import Scene

DITHERING = sqrt(2)  # ratio of the RMSE of dithering to that of rounding, where all fractions of a level are as likely
LARGEST_FLOOR = 0.02  # above any error at which rounding decides: of the widest levels of all tones


class Darkroom:
    """Develops the pictures of one renderer."""

    def __init__(self, runner: FrameRunner, dither: bool) -> None:
        self.runner = runner
        self.dither = dither
        self.scratch = NO_LINEAR  # the light of the last picture for which nobody else kept it

    def needed(self, scene: Scene) -> bool:
        """Whether the pictures of a scene need developing."""
        return needs_developing(scene.camera.tone, self.dither)

    def light_for(
        self, scene: Scene, pixels: np.ndarray, linear: np.ndarray | None, edges_only: bool = False
    ) -> np.ndarray:
        """Return the array for the light of a picture: `linear` if given, one without rows where no one needs it.

        With `edges_only` the light of pixels that are not drawn is NaN, unless it is in `linear`.
        """
        if linear is not None or not self.needed(scene):
            self.scratch = NO_LINEAR
            return NO_LINEAR if linear is None else linear
        shape = (*pixels.shape[:2], 3)
        if self.scratch.shape != shape:
            self.scratch = np.empty(shape)
        if edges_only:
            self.scratch[...] = nan
        return self.scratch

    def develop(self, scene: Scene, pixels: np.ndarray, light: np.ndarray, crop: Crop | None = None) -> None:
        """Write the levels of a picture, or of a crop, from its light, if they are not those of the kernel."""
        if self.needed(scene):
            place = crop[2:] if crop else (0, 0)
            develop(light, pixels, scene.camera.tone, self.dither, self.run, self.runner.threads, *place)

    def run(self, jobs: list[Callable[[], object]]) -> None:
        """Run jobs on the threads that render."""
        self.runner.pool.run(jobs, self.runner.cancel)

    def rounding(self, scene: Scene, pixels: np.ndarray) -> float:
        """Return the RMSE of rounding or dithering a developed picture, in light clamped to [0, 1]."""
        if scene.camera.tone == PLAIN:
            return DITHERING * ROUNDING if self.dither else ROUNDING
        return rounding_error(pixels, scene.camera.tone, self.dither)

    def floor(self, scene: Scene, pixels: np.ndarray, error: float, draw: Callable[[], object]) -> float:
        """Return the error below which rounding decides; `draw` draws a first picture, which tells it for a curve."""
        if scene.camera.tone != PLAIN:
            if error >= LARGEST_FLOOR:
                return 0.0
            draw()
        return self.rounding(scene, pixels) / 2

    def finish(
        self,
        scene: Scene,
        pixels: np.ndarray,
        light: np.ndarray,
        outcome: Outcome | None,
        crop: Crop | None = None,
    ) -> Outcome | None:
        """Develop a picture that was drawn to an error, and return the outcome with the error of its levels."""
        if outcome is None or not self.needed(scene):
            return outcome
        self.develop(scene, pixels, light, crop)
        return outcome._replace(rounding=self.rounding(scene, pixels))
