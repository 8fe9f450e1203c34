"""Benchmark of a scene: time to load, to compile and to render a frame."""

from __future__ import annotations

import json
from statistics import median
from time import perf_counter

import numpy as np

import minirt
from minirt.rendering import Renderer
from minirt.scene import Scene, load
from minirt.timing import runs

LEAST_FRAMES, LEAST_SECONDS = 9, 1.0


def measure(
    path: str, scene: Scene, size: tuple[int, int] | None, threads: int | None, precision: str
) -> dict[str, str | float]:
    """Measure the time to load a scene, in seconds, and to render frames, in milliseconds.

    `compile_s` is the time until the kernel is ready: to compile it, or to load it if it was compiled before.
    """
    start = perf_counter()
    load(path, lenient=True)
    load_s = perf_counter() - start
    width, height = size or minirt.size_of(scene)
    renderer = Renderer(threads, precision)
    start = perf_counter()
    renderer.specialise(scene)
    compile_s = perf_counter() - start
    pixels = np.empty((height, width, 4), np.uint8)
    renderer.render(scene, pixels)
    times = [run.wall for run in runs(lambda: renderer.render(scene, pixels), LEAST_FRAMES, LEAST_SECONDS)]
    return {
        "scene": path,
        "size": f"{width}x{height}",
        "threads": renderer.threads,
        "precision": precision,
        "frames": len(times),
        "ms_min": round(min(times) * 1e3, 3),
        "ms_median": round(median(times) * 1e3, 3),
        "compile_s": round(compile_s, 3),
        "load_s": round(load_s, 4),
    }


def report(measured: dict[str, str | float], as_json: bool) -> str:
    """Format measurements as a JSON object or as a line of text."""
    return json.dumps(measured) if as_json else ", ".join(f"{name} {value}" for name, value in measured.items())
