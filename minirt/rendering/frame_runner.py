"""Draws packed scenes on all threads: a fixed number of samples, edges alone, or until an error is reached."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from math import inf
from operator import is_
from time import perf_counter

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.machine_code.arguments import words_of
from minirt.kernel.pixels import PACKET_HEIGHT, TILE
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.lights import TOGETHER
from minirt.lanes import width
from minirt.rendering.frame import (
    DRAWN,
    REFERENCES,
    Frame,
    frame_arguments,
    plan_of,
    plan_of_variants,
    thread_memory,
)
from minirt.rendering.kernels import KernelChoice, Kernels
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import STEPS, Crop, Request, has_apertures, packet_rays, with_apertures
from minirt.rendering.sampling.auto import AutoSampler, CancelledError
from minirt.rendering.sampling.packets import EDGE, Packets, contrast_classes
from minirt.rendering.scene_packing import Packing
from minirt.rendering.threads import Job, ThreadPool

BRIEF = 0.05  # seconds for which Ctrl+C may wait
FEW_ROWS = 8  # of tiles for each thread: with fewer, threads take packets in place of rows, to end at the same time


class FrameRunner:
    """Renders frames on its threads until they are done or cancelled."""

    def __init__(self, threads: int, kernels: Kernels) -> None:
        self.threads = threads
        self.kernels = kernels
        self.next_row = np.zeros(1, np.int64)  # counter of the rows that are being rendered
        self.choice: KernelChoice | None = None  # the kernel of the last frame
        self.arrays: SceneArrays | None = None  # of its scene
        self.memories: list[tuple[np.ndarray, np.ndarray]] = []  # of the threads, for that scene, from frame to frame
        self.words: list[bytes] = []  # of each memory and of the form of that scene which the kernel takes
        self.of_rays: tuple[tuple[object, ...], bytes] = (None,) * 3, b""  # rays, plan, errors, and their words
        self.pace = inf  # seconds that a sample of a pixel took in the last frame without a plan of this kernel
        self.cancellations = 0

    @cached_property
    def pool(self) -> ThreadPool:
        return ThreadPool(self.threads)

    def run_on_all(self, job: Job) -> None:
        """Run a brief job as often as there are threads that render, on these and on the caller's."""
        self.pool.run([job] * self.threads, self.cancel, helps=True)

    def reset_counter(self) -> np.ndarray:
        """Return the counter of rows for a frame, which `cancel` ends from now on."""
        self.next_row[0] = 0
        return self.next_row

    def run(self, frame: Frame) -> None:
        """Render a frame on all threads, which share its rows or its packets; an error of any is raised.

        The caller's thread is one of them where the frame is expected to be brief; else it only waits, so that Ctrl+C
        reaches it. The pace of a frame without a plan is kept, and its time is counted for the kernel.
        """
        choice = self.choose(frame)
        work, is_planned = len(frame.rays) * frame.pixels.size, len(frame.plan) > 0  # work: samples of all pixels
        has_one_sample = work == frame.pixels.size
        height, across = frame.pixels.shape
        few_rows = FEW_ROWS * self.threads if len(frame.scene.lights) <= TOGETHER else 0  # more lights need whole tiles
        if is_planned:
            sets = np.where(frame.plan[:, REFERENCES], 3, 1)  # of samples: those that are drawn, and two of references
            work = int(frame.plan[:, DRAWN] @ sets) * width(frame.scene.camera)
        elif has_one_sample and height < TILE * few_rows:
            whole = plan_of_variants((height, across), width(frame.scene.camera), 1, 1, Crop(across, height, 0, 0))
            frame = frame._replace(plan=whole)
        start, rays = perf_counter(), (frame.rays, frame.plan, frame.errors)
        before, _ = self.of_rays
        if not all(map(is_, rays, before)):
            self.of_rays = rays, words_of(rays)
        _, words_of_rays = self.of_rays
        # The words of all arguments, in the order of `Frame`.
        shared = words_of((frame.next_row, frame.pixels, frame.linear)) + words_of_rays
        jobs: list[Job] = [partial(choice.entry.run, shared + each) for each in self.words]
        self.pool.run(jobs, self.cancel, helps=self.pace * work < BRIEF)
        seconds = perf_counter() - start
        if not is_planned and frame.next_row[0] < CANCELLED:
            self.pace = seconds / work
        self.kernels.count(choice, seconds)

    def choose(self, frame: Frame) -> KernelChoice:
        """Return the kernel for a frame: that of the frame before where its scene has the same arrays."""
        before = self.choice
        if before is None or frame.scene is not self.arrays or self.kernels.has_better(before):
            if frame.scene is not self.arrays:
                self.memories = [thread_memory(frame.scene) for _ in range(self.threads)]
            self.choice, self.arrays = self.kernels.choose(frame), frame.scene
            scene = words_of(self.choice.scene)
            self.words = [words_of(each) + scene for each in self.memories]
            if before is None or self.choice.entry is not before.entry:
                self.pace = inf
        assert self.choice
        return self.choice

    def cancel(self) -> None:
        """End the frame that is being rendered, soon and incomplete; callable from any thread."""
        self.cancellations += 1  # for a picture between two frames
        self.next_row[:] = CANCELLED

    def render_samples(
        self, packing: Packing, request: Request, samples: int, is_wanted: Callable[[], bool], edges_only: bool
    ) -> bool:
        """Render a scene that has shapes into the arrays of the request, each pixel with so many samples; return False
        where `cancel` ended it early or `is_wanted` said no.

        `is_wanted` is asked once, when `cancel` can already end the frame. With `edges_only` only packets in which
        neighbouring pixels differ are drawn, unless a lens or a light with a size blurs others, too.
        """
        scene, pixels, light, crop = request
        counter = self.reset_counter()
        if not is_wanted():
            return False
        arrays = packing.pack(scene, pixels.shape[1], pixels.shape[0], crop, samples)
        rays = packing.view.rays if packing.view and samples == 1 else None  # the view keeps those of one sample
        # What the first thread remembers of these very arrays; of others it knows nothing.
        memory = self.memories[0] if arrays is self.arrays else None
        frame = frame_arguments(arrays, pixels, samples, light, counter, crop, rays, memory)
        if edges_only and not has_apertures(arrays):
            classes = contrast_classes(pixels, width(arrays.camera) // PACKET_HEIGHT, self.run_on_all)
            packets = np.flatnonzero(classes >= EDGE)
            all_samples = 0, samples, 0  # from the first one on, none for a reference
            frame = frame._replace(plan=plan_of(packets, classes.shape[1], all_samples))
        self.run(frame)
        return bool(counter[0] < CANCELLED)

    def render_to_error(
        self, packing: Packing, request: Request, error: float, seconds: float, least: float
    ) -> Outcome | None:
        """Render a scene that has shapes into the arrays of the request, until the estimated error is at most `error`,
        or so many seconds have passed, packing included. The first sweep is always completed.

        `error` is the RMSE of light from 0 to 1. `least` is the error below which more samples are useless; see
        `minirt.rendering.sampling.auto`. Return None where `cancel` ended it early.
        """
        scene, pixels, linear, crop = request
        start, cancellations = perf_counter(), self.cancellations
        height, across, _ = pixels.shape
        arrays = packing.pack(scene, across, height, crop)
        frame = frame_arguments(arrays, pixels, linear=linear)
        with_places = has_apertures(arrays)
        lanes = width(arrays.camera)
        packet_width = lanes // PACKET_HEIGHT

        def draw(positions: np.ndarray, plan: np.ndarray, errors: np.ndarray) -> None:
            counter = self.reset_counter()
            if self.cancellations != cancellations:
                raise CancelledError
            rays = packet_rays(arrays.camera[STEPS], positions[..., :2])
            if with_places:
                rays = with_apertures(rays, positions[..., 2:], arrays.lens)
            self.run(frame._replace(next_row=counter, rays=rays, plan=plan, errors=errors))
            if counter[0] >= CANCELLED:
                raise CancelledError

        classify = partial(contrast_classes, pixels, packet_width, self.run_on_all)
        packets = Packets(height, across, packet_width)
        auto = AutoSampler(draw, classify, packets, 3 * height * across, lanes, with_places)
        try:
            outcome = auto.reach(max(error, least), seconds - (perf_counter() - start))
        except CancelledError:
            return None
        return outcome._replace(seconds=perf_counter() - start, goal=error, rounded=error < outcome.error <= least)
