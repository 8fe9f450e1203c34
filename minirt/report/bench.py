"""Times of runs, and a benchmark of a scene: to load, to compile and to render a frame, at rest and moving."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from itertools import cycle, repeat
from math import isnan, nan
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import NamedTuple

import numpy as np

from minirt.rendering.renderer import Renderer
from minirt.scene import Scene, load, size_of

LEAST_FRAMES, LEAST_SECONDS = 9, 1.0  # of each of both measurements
STEP = 1e-3  # scene units that the eye moves from frame to frame
DISTURBED = 0.15  # waiting time by processor time from which a run counts as disturbed
THREADS = Path("/proc/self/task")  # of this program, on Linux


class Run(NamedTuple):
    """Wall time and processor time of a run in seconds; the latter is the sum over all threads of this program."""

    wall: float
    cpu: float
    waited: float = nan  # time for which threads that could run had no processor, summed; NaN where no system tells


def runs(work: Callable[[], object], least: int, seconds: float) -> list[Run]:
    """Time at least `least` runs of some work, and more until they take `seconds` together."""
    times: list[Run] = []
    while len(times) < least or sum(run.wall for run in times) < seconds:
        wall, cpu, waited = perf_counter(), process_time(), waiting_time()
        work()
        times.append(Run(perf_counter() - wall, process_time() - cpu, waiting_time() - waited))
    return times


def timed(work: Callable[[], object]) -> Run:
    """Time one run of some work."""
    return runs(work, 1, 0.0)[0]


def take_turns(works: Sequence[Callable[[], Run]], least: int, most: int, seconds: float) -> list[tuple[Run, ...]]:
    """Run works in turn, so that a slow moment of the machine affects all: `least` rounds, and up to `most` until they
    have taken `seconds`. Return the runs of each round, in the order of the works; every second round is run backwards.
    """
    rounds: list[tuple[Run, ...]] = []
    spent = 0.0
    while len(rounds) < least or (len(rounds) < most and spent < seconds):
        step = -1 if len(rounds) % 2 else 1
        rounds.append(tuple([work() for work in works[::step]][::step]))
        spent += sum(run.wall for run in rounds[-1])
    return rounds


def waiting_time() -> float:
    """Return the seconds for which threads of this program have waited for a processor so far; NaN but on Linux."""
    total = nan
    with suppress(OSError):
        for name in os.listdir(THREADS):  # noqa: PTH208  (a tenth of the time of `iterdir`)
            with suppress(OSError):  # a thread that has ended
                waited = int((THREADS / name / "schedstat").read_bytes().split()[1]) * 1e-9
                total = waited + (0.0 if isnan(total) else total)
    return total


def is_disturbed(run: Run, threads: int) -> bool:
    """Whether the threads of a run had to wait for a processor. Where no system tells, what they did not use of the
    wall time counts as waiting, too."""
    waited = run.wall * threads - run.cpu if isnan(run.waited) else run.waited
    return waited > DISTURBED * run.cpu


def measure(
    path: str, scene: Scene, size: tuple[int, int] | None, threads: int | None, precision: str
) -> dict[str, str | float]:
    """Measure the time to load the scene file `path`, in seconds, and to render frames, in milliseconds.

    `ms_min` and `ms_median` are of the same frame again and again, which keeps the lists of what each tile shows;
    `ms_min_moving` and `ms_median_moving` are of an eye that moves, whose every frame needs new lists.
    `compile_s` is the time until the kernel is ready: to compile it, or to load it if it was compiled before.
    """
    start = perf_counter()
    load(path, lenient=True)
    load_s = perf_counter() - start
    width, height = size or size_of(scene)
    renderer, pixels = Renderer(threads, precision), np.empty((height, width, 4), np.uint8)
    start = perf_counter()
    renderer.specialise(scene)
    compile_s = perf_counter() - start

    def frame_times(steps: Iterator[Scene]) -> list[float]:
        """Return the milliseconds of each frame; the first one, which is not counted, warms up."""
        renderer.render(next(steps), pixels)
        timed = runs(lambda: renderer.render(next(steps), pixels), LEAST_FRAMES, LEAST_SECONDS)
        return [run.wall * 1e3 for run in timed]

    kept, moving = frame_times(repeat(scene)), frame_times(cycle((moved(scene), scene)))
    return {
        "scene": path,
        "size": f"{width}x{height}",
        "threads": renderer.threads,
        "precision": precision,
        "frames": len(kept),
        "ms_min": round(min(kept), 3),
        "ms_median": round(median(kept), 3),
        "ms_min_moving": round(min(moving), 3),
        "ms_median_moving": round(median(moving), 3),
        "compile_s": round(compile_s, 3),
        "load_s": round(load_s, 4),
    }


def moved(scene: Scene) -> Scene:
    """Return the scene seen by an eye that made one step."""
    x, y, z = scene.camera.position
    return scene.replace(scene.camera, position=(x + STEP, y, z))
