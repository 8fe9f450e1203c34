"""miniRT as a system of the benchmark, through its library."""

from __future__ import annotations

from functools import lru_cache
from itertools import cycle
from pathlib import Path

import numpy as np

from minirt import load
from minirt.helpers.system import runs
from minirt.rendering import Renderer
from minirt.report.bench import moved
from tests.bench.measure import Setting, System

LEAST_FRAMES = 3
RECENT = 4  # packed scenes that are kept

read = lru_cache(RECENT)(load)


class MiniRT(System):
    """miniRT in a precision, "double" or "single"."""

    how = "Renderer.render while the camera moves: with what each tile shows; the lists of lamps are kept"

    def __init__(self, setting: Setting, precision: str) -> None:
        super().__init__(setting)
        self.name = f"miniRT {precision}"
        self.precision = precision
        self.renderer = lru_cache(RECENT)(self.new_renderer)

    def new_renderer(self, path: Path) -> Renderer:
        """Make a renderer for a scene, with its kernel; a renderer keeps only the last packed scene."""
        renderer = Renderer(self.setting.threads, self.precision)
        renderer.prepare(read(path))
        return renderer

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        scene, renderer = read(path), self.renderer(path)
        frames = cycle((scene, moved(scene)))
        pixels = np.empty((self.setting.height, self.setting.width, 4), np.uint8)
        renderer.render(next(frames), pixels)
        timed = runs(lambda: renderer.render(next(frames), pixels), LEAST_FRAMES, seconds)
        return [run.wall * 1e3 for run in timed]
