"""Draws packed scenes on all threads: a fixed number of samples, edges alone, or until an error is reached."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from time import perf_counter
from typing import Any

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.machine_code.arguments import words_of
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.frame import Frame, frame_arguments, plan_of, sum_buffer, thread_memory
from minirt.rendering.kernels import Choice, Kernels
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Request, has_apertures, packet_rays, with_apertures
from minirt.rendering.sampling.auto import AutoSampler, CancelledError
from minirt.rendering.sampling.packets import EDGE, Packets, contrast_classes
from minirt.rendering.scene_packing import Packing
from minirt.rendering.threads import Job, ThreadPool

Kernel = tuple[Choice, list[Any]]  # a kernel, and the scene in the words that it takes


class FrameRunner:
    """Renders frames on its threads until they are done or cancelled."""

    def __init__(self, threads: int, kernels: Kernels) -> None:
        self.threads = threads
        self.kernels = kernels
        self.next_row = np.zeros(1, np.int64)  # counters of the frames that are being rendered
        self.choice: Choice | None = None  # the kernel of the last frame
        self.cancellations = 0
        self.not_finite = 0  # rays since it was last set to 0 whose light was infinite or NaN, and is 0 in the picture

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

    def run(self, frames: list[Frame], threads: int, kernel: Kernel | None = None) -> Kernel:
        """Render frames of one scene, one after the other, on so many threads, which share the rows of each; an error
        of any thread is raised. Return the kernel, for further frames of the scene.

        A thread that finds no more rows of a frame goes on with the next one. The caller's thread only waits, so that
        Ctrl+C reaches it.
        """
        if kernel is None:
            self.choice = self.kernels.choose(frames[0])
            kernel = self.choice, words_of(self.choice.scene)  # which holds for all frames
        choice, scene = kernel
        memories = [(thread_memory(frames[0].scene), sum_buffer(frames[0].scene)) for _ in range(threads)]
        start = perf_counter()
        jobs: list[Job] = []
        for memory, sums in memories:
            arguments = [words_of(each._replace(memory=memory, sums=sums)[:-1]) + scene for each in frames]
            jobs.append(partial(list, map(choice.entry.run, arguments)))
        self.run_jobs(jobs)
        self.kernels.count(choice, perf_counter() - start)
        self.not_finite += int(sum(memory[-1, 1] for memory, _ in memories))
        return kernel

    def cancel(self) -> None:
        """End the frames that are being rendered, soon and incomplete; callable from any thread."""
        self.cancellations += 1  # for a picture between two frames
        self.next_row[:] = CANCELLED

    def render_samples(
        self, packing: Packing, request: Request, samples: int, is_wanted: Callable[[], bool], edges_only: bool
    ) -> bool:
        """Render a scene that has shapes; with `edges_only` only packets in which neighbouring pixels differ, unless a
        lens or a light with a size blurs others, too. False where it was cancelled or `is_wanted` said no."""
        scene, pixels, light, crop = request
        counter = self.new_counters(1)
        if not is_wanted():
            return False
        arrays = packing.pack(scene, pixels.shape[1], pixels.shape[0], crop)
        frame = frame_arguments(arrays, pixels, samples, light, counter, crop)
        if edges_only and not has_apertures(arrays):
            classes = contrast_classes(pixels, width(arrays.camera) // PACKET_HEIGHT, self.run_jobs, self.threads)
            packets = np.flatnonzero(classes >= EDGE)
            drawn = np.tile(np.array([0, samples, 0], np.int32), (len(packets), 1))
            frame = frame._replace(plan=plan_of(packets, classes.shape[1], drawn))
        self.run([frame], self.threads)
        return bool(counter[0] < CANCELLED)

    def render_to_error(
        self, packing: Packing, request: Request, error: float, seconds: float, least: float
    ) -> Outcome | None:
        """Render a scene that has shapes, see `minirt.rendering.sampling.auto`; None where `cancel` ended it early.
        `least` is the error below which more samples are useless."""
        scene, pixels, light, crop = request
        start, cancellations = perf_counter(), self.cancellations
        height, across, _ = pixels.shape
        arrays = packing.pack(scene, across, height, crop)
        frame = frame_arguments(arrays, pixels, linear=light)
        with_places = has_apertures(arrays)
        lanes = width(arrays.camera)
        packet_width = lanes // PACKET_HEIGHT
        kernel: Kernel | None = None

        def draw(positions: np.ndarray, plan: np.ndarray, errors: np.ndarray) -> None:
            nonlocal kernel
            counter = self.new_counters(1)
            if self.cancellations != cancellations:
                raise CancelledError
            rays = packet_rays(arrays.camera, positions[..., :2])
            if with_places:
                rays = with_apertures(rays, positions[..., 2:], arrays.lens)
            planned = frame._replace(next_row=counter, rays=rays, plan=plan, errors=errors)
            kernel = self.run([planned], self.threads, kernel)
            if counter[0] >= CANCELLED:
                raise CancelledError

        classify = partial(contrast_classes, pixels, packet_width, self.run_jobs, self.threads)
        packets = Packets(height, across, packet_width)
        auto = AutoSampler(draw, classify, packets, 3 * height * across, lanes, with_places)
        try:
            outcome = auto.reach(max(error, least), seconds - (perf_counter() - start))
        except CancelledError:
            return None
        return outcome._replace(seconds=perf_counter() - start, goal=error, rounded=error < outcome.error <= least)
