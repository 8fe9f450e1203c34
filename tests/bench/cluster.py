"""`python -m tests.bench.cluster`: what bands and frames cost beyond rendering, on one and on two workers.

Seconds are the least of some tries, in turns, so that a machine with other work is measured, too.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import minirt
from minirt.cluster.parcel import pack
from minirt.formats import tiff
from minirt.viewer.app.replay import turntable

SIZE, SAMPLES = (1920, 1080), 16
TINY, FRAMES = (16, 16), 200
TRIES = 8


def least(clock: Callable[[], float], *jobs: Callable[[], object]) -> list[float]:
    """Return the least seconds of each job, which take turns."""
    found = [float("inf")] * len(jobs)
    for _ in range(TRIES):
        for number, job in enumerate(jobs):
            start = clock()
            job()
            found[number] = min(found[number], clock() - start)
    return found


def main() -> None:
    """Measure, and print a list."""
    scene = minirt.example("demo")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print_bands(scene, folder)
        print_workers(scene, folder)


def print_bands(scene: minirt.Scene, folder: Path) -> None:
    """Print what bands cost in processor time, with one thread."""
    how: dict[str, Any] = {"samples": SAMPLES, "threads": 1}
    image = minirt.render(scene, *SIZE, linear=False, **how)
    whole, bands, compress = least(
        time.process_time,
        lambda: minirt.render(scene, *SIZE, linear=False, **how),
        lambda: minirt.render_to(folder / "a.tif", scene, *SIZE, **how),
        lambda: tiff.strips(image.array),
    )
    print(
        f"{SIZE[0]}x{SIZE[1]}, {SAMPLES} samples: {whole:.2f} s of one core, {whole_rays() / whole / 1e6:.1f} M rays/s"
    )
    print(f"in bands, written as TIFF: {bands:.2f} s, of which compressing {compress:.2f} s")
    print(f"bands cost {100 * ((bands - compress) / whole - 1):+.1f} %")
    print(f"file {(folder / 'a.tif').stat().st_size / 2**20:.1f} MiB, scene {len(pack(scene).data) / 2**10:.0f} KiB")


def whole_rays() -> int:
    """Return the number of primary rays of the picture."""
    return SIZE[0] * SIZE[1] * SAMPLES


def print_workers(scene: minirt.Scene, folder: Path) -> None:
    """Print what one and two workers of a thread each take, and what a task takes that renders next to nothing."""
    frames = list(turntable(scene, FRAMES))

    def picture(executor: Any) -> Callable[[], object]:
        return lambda: minirt.render_to(folder / "a.tif", scene, *SIZE, samples=SAMPLES, threads=1, executor=executor)

    def film(executor: Any) -> Callable[[], object]:
        return lambda: list(minirt.render_all(frames, *TINY, threads=1, executor=executor))

    here = film(None)
    with (
        ProcessPoolExecutor(1, get_context("spawn")) as one,
        ProcessPoolExecutor(2, get_context("spawn")) as two,
    ):
        seconds = least(time.perf_counter, picture(one), picture(two), here, film(one), film(two))
    print(f"one worker {seconds[0]:.2f} s, two {seconds[1]:.2f} s: {seconds[0] / seconds[1]:.2f} times as fast")
    print(f"a frame of {TINY[0]}x{TINY[1]} here: {1e3 * seconds[2] / FRAMES:.2f} ms")
    print(f"by one process {1e3 * seconds[3] / FRAMES:.2f} ms, by two {1e3 * seconds[4] / FRAMES:.2f} ms")
    if "--dask" in sys.argv:
        from distributed import Client, LocalCluster

        how: dict[str, Any] = {"threads_per_worker": 1, "dashboard_address": None}
        with LocalCluster(n_workers=2, **how) as cluster, Client(cluster) as client:
            big, small = least(time.perf_counter, picture(client), film(client))
        print(f"two dask workers {big:.2f} s, a frame of {TINY[0]}x{TINY[1]} {1e3 * small / FRAMES:.2f} ms")


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    main()
