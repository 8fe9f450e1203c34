"""Renderers that all callers share: one for each combination of settings."""

from __future__ import annotations

from minirt.helpers.system import ForkSafeLock
from minirt.rendering.renderer import Renderer

Settings = tuple[int | None, str, int | None, bool]

renderers: dict[Settings, Renderer] = {}
lock = ForkSafeLock()  # two threads that ask at once get the same renderer


def shared_renderer(threads: int | None, precision: str, depth: int | None, dither: bool) -> Renderer:
    """Return the renderer with these settings, which keeps its threads and the packed scene for the next picture."""
    settings = threads, precision, depth, dither
    with lock:
        if settings not in renderers:
            renderers[settings] = Renderer(*settings)
        return renderers[settings]
