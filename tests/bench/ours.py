"""This program, by its library."""

from __future__ import annotations

from functools import lru_cache
from inspect import signature
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from minirt import load
from minirt.rendering import Renderer
from tests.bench.system import MissingError, Setting, System

LEAST_FRAMES = 3
RECENT = 3  # scenes that are kept

read = lru_cache(RECENT)(load)


class MiniRT(System):
    """miniRT in a precision, "double" or "single"; `MissingError` where it has but the one."""

    how = "Renderer.render, with what each tile shows; the lists of lamps are kept from the first frame"

    def __init__(self, setting: Setting, precision: str) -> None:
        super().__init__(setting)
        self.name = f"miniRT {precision}"
        self.options: dict[str, Any] = {}
        if "precision" in signature(Renderer).parameters:
            self.options["precision"] = precision
        elif precision != "double":
            raise MissingError(f"{self.name}: this version has double precision only")
        self.renderer = lru_cache(RECENT)(self.new_renderer)

    def new_renderer(self, _: Path) -> Renderer:
        """One for each scene, because it keeps what it works out for the last scene that it rendered."""
        return Renderer(self.setting.threads, **self.options)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        scene, renderer = read(path), self.renderer(path)
        pixels = np.empty((self.setting.height, self.setting.width, 4), np.uint8)
        renderer.render(scene, pixels)
        times: list[float] = []
        while len(times) < LEAST_FRAMES or sum(times) < seconds * 1e3:
            start = perf_counter()
            renderer.render(scene, pixels)
            times.append((perf_counter() - start) * 1e3)
        return times
