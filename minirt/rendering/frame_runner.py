"""Draws packed scenes on all threads: a fixed number of samples, edges alone, or until an error is reached."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from time import perf_counter

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.machine_code.arguments import words_of
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.frame import Frame, frame_arguments, sum_buffer, thread_memory
from minirt.rendering.kernels import Choice, Kernels
from minirt.rendering.outcome import ROUNDING_DECIDES, Outcome
from minirt.rendering.packing.camera import Request, has_apertures, packet_pixels, with_apertures
from minirt.rendering.sampling.auto import AutoSampler, Sweep
from minirt.rendering.sampling.contrast import EDGE, contrast_classes
from minirt.rendering.sampling.packets import Packets
from minirt.rendering.sampling.sample_table import table_rays
from minirt.rendering.scene_packing import Packing
from minirt.rendering.threads import Job, ThreadPool


class FrameRunner:
    """Renders frames on its threads until they are done or cancelled."""

    def __init__(self, threads: int, kernels: Kernels) -> None:
        self.threads = threads
        self.kernels = kernels
        self.next_row = np.zeros(1, np.int64)  # counters of the frames that are being rendered
        self.choice: Choice | None = None  # the kernel of the last frame
        self.scene_words: list[int] = []  # of its argument block
        self.cancellations = 0
        self.not_finite = 0  # rays since it was last set to 0 whose light was infinite or NaN, and is 0 in the picture

    def after_fork(self) -> None:
        """In a child process: drop the pool, whose threads are the parent's. The next picture starts new ones."""
        self.__dict__.pop("pool", None)

    @cached_property
    def pool(self) -> ThreadPool:
        """The threads that render."""
        return ThreadPool(self.threads)

    def run_jobs(self, jobs: list[Job]) -> None:
        """Run jobs on the threads that render."""
        self.pool.run(jobs, self.cancel)

    def new_counters(self, frames: int) -> np.ndarray:
        """Return a counter of rows for each of some frames; `cancel` ends these frames from now on."""
        self.next_row = np.zeros(frames, np.int64)
        return self.next_row

    def run(self, frames: list[Frame], threads: int) -> None:
        """Render frames of one scene, one after the other, on so many threads, which share the rows of each; an error
        of any thread is raised.

        A thread that finds no more rows of a frame goes on with the next one. The caller's thread only waits, so that
        Ctrl+C reaches it.
        """
        choice = self.kernels.choose(frames[0])
        if not self.choice or self.choice.scene is not choice.scene:
            self.scene_words = words_of(choice.scene)  # which holds for all frames of a scene
        self.choice, scene = choice, self.scene_words
        memories = [(thread_memory(frames[0].scene), sum_buffer(frames[0].scene)) for _ in range(threads)]
        start = perf_counter()
        jobs: list[Job] = []
        for memory, sums in memories:
            arguments = [words_of(each._replace(memory=memory, sums=sums)[:-1]) + scene for each in frames]
            jobs.append(partial(list, map(choice.entry.run, arguments)))
        self.run_jobs(jobs)
        self.kernels.count(choice, perf_counter() - start)
        self.not_finite += int(sum(memory[-1, 1] for memory, _ in memories))

    def cancel(self) -> None:
        """End the frames that are being rendered, soon and incomplete; callable from any thread."""
        self.cancellations += 1  # for a picture between two frames
        self.next_row[:] = CANCELLED


def render_samples(
    runner: FrameRunner,
    packing: Packing,
    request: Request,
    light: np.ndarray,
    samples: int,
    is_wanted: Callable[[], bool],
    edges_only: bool,
) -> bool:
    """Render a scene that has shapes, and its light into `light`, if it has rows; with `edges_only` only packets in
    which neighbouring pixels differ, unless a lens or a light with a size blurs others, too. False where it was
    cancelled or `is_wanted` said no."""
    scene, pixels, _, crop = request
    counter = runner.new_counters(1)
    if not is_wanted():
        return False
    arrays = packing.pack(scene, pixels.shape[1], pixels.shape[0], crop)
    frame = frame_arguments(arrays, pixels, samples, light, counter, crop)
    if edges_only and not has_apertures(arrays):
        classes, _ = contrast_classes(pixels, width(arrays.camera) // PACKET_HEIGHT, runner.run_jobs, runner.threads)
        frame = frame.with_samples_where(classes >= EDGE)
    runner.run([frame], runner.threads)
    return bool(counter[0] < CANCELLED)


def render_to_error(
    runner: FrameRunner,
    packing: Packing,
    request: Request,
    light: np.ndarray,
    error: float,
    seconds: float,
    least: float | None = None,
) -> Outcome | None:
    """Render a scene that has shapes, as `minirt.rendering.sampling.auto` tells, and its light, if `light` has rows.

    Both are incomplete where `cancel` ended it early, which returns None. `least` is the error below which more samples
    are useless: where it is not given, that at which rounding to 8 bits decides, and 0 with light.
    """
    scene, pixels, _, crop = request
    start, cancellations = perf_counter(), runner.cancellations
    height, across, _ = pixels.shape
    arrays = packing.pack(scene, across, height, crop)
    frame = frame_arguments(arrays, pixels, linear=light)
    with_places = has_apertures(arrays)
    packet_width = width(arrays.camera) // PACKET_HEIGHT
    offsets = packet_pixels(width(arrays.camera))

    def draw(sweep: Sweep) -> bool:
        counters = runner.new_counters(1 + sweep.is_first)
        if runner.cancellations != cancellations:
            return False
        rays = table_rays(arrays.camera, sweep.positions, offsets)
        if with_places:
            rays = with_apertures(rays, sweep.positions[..., 2:], arrays.lens)
        planned = frame._replace(next_row=counters[-1:], rays=rays, plan=sweep.plan, errors=sweep.errors)
        whole = [frame._replace(next_row=counters[:1], rays=rays[:1])] if sweep.is_first else []
        runner.run([*whole, planned], runner.threads)
        return bool((counters < CANCELLED).all())

    def classify() -> tuple[np.ndarray, np.ndarray]:
        return contrast_classes(pixels, packet_width, runner.run_jobs, runner.threads)

    if least is None:  # rounding to 8 bits, where nobody wants the light itself, makes less error useless
        least = 0.0 if len(light) else ROUNDING_DECIDES
    packets = Packets(height, across, packet_width)
    auto = AutoSampler(draw, classify, packets, 3 * height * across, len(offsets[0]), with_places)
    outcome = auto.reach(max(error, least), seconds - (perf_counter() - start))
    return outcome and outcome._replace(
        seconds=perf_counter() - start, goal=error, rounded=error < outcome.error <= least
    )
