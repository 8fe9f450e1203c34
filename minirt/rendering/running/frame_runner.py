"""Runs the kernel on all threads, which share the rows of a frame."""

from __future__ import annotations

from functools import cached_property, partial
from time import perf_counter

import numpy as np

from minirt.kernel.frame import CANCELLED
from minirt.kernel.machine_code.argument_block import words_of
from minirt.kernel.machine_code.entry import Entry
from minirt.rendering.frame_arguments import Frame, sum_buffer, thread_memory
from minirt.rendering.running.kernels import Choice, Kernels
from minirt.rendering.running.thread_pool import Job, ThreadPool


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
            jobs.append(partial(run_all, choice.entry, arguments))
        self.pool.run(jobs, self.cancel)
        self.kernels.count(choice, perf_counter() - start)
        self.not_finite += int(sum(memory[-1, 1] for memory, _ in memories))

    def cancel(self) -> None:
        """End the frames that are being rendered, soon and incomplete; callable from any thread."""
        self.cancellations += 1  # for a picture between two frames
        self.next_row[:] = CANCELLED


def run_all(entry: Entry, arguments: list[list[int]]) -> None:
    """Run a kernel with the words of its arguments, once for each frame."""
    for words in arguments:
        entry.run(words)
