"""The executor that tasks go to: one of `concurrent.futures`, a dask client, or the threads of this process."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from contextlib import suppress
from math import inf
from time import monotonic
from typing import Any, TypeAlias

from minirt.cluster.task import Answer, Task
from minirt.cluster.worker import carry_out
from minirt.rendering.threads import usable_cores

HERE = 2  # threads of this process: one renders, the other compresses
OF_EACH = 2  # tasks of each worker: one is rendered, one waits
PAUSE = 1.0  # seconds from one count of a cluster's workers to the next
POLL = 0.05  # seconds from one cancellation to the next

Workers: TypeAlias = Executor | Callable[[], Executor] | Any  # the last is a dask client


class WorkerPool:
    """Workers behind an executor, which is made anew where it breaks."""

    def __init__(self, workers: Workers | None, threads: int | None = None) -> None:
        """`workers` is an executor, a function that makes one, a dask client, or None; `threads` of each task are the
        worker's share of its machine where they are not given."""
        self.asked_threads = threads
        self.make = workers if callable(workers) and not hasattr(workers, "submit") else None
        self.is_own = workers is None or self.make is not None
        self.use(self.make() if self.make else ThreadPoolExecutor(HERE) if workers is None else workers)

    def use(self, workers: Any) -> None:
        """Send tasks to an executor or a dask client from now on."""
        self.client = workers if hasattr(workers, "get_executor") else getattr(workers, "_client", None)
        self.executor: Executor = workers.get_executor() if hasattr(workers, "get_executor") else workers
        self.present, self.asked = 1, -inf  # workers of the client, and when they were counted

    @property
    def count(self) -> int:
        """The number of workers; those of a cluster may come and go."""
        if self.client is not None:
            if monotonic() > self.asked + PAUSE:  # asking takes a millisecond
                self.present, self.asked = max(1, len(self.client.nthreads())), monotonic()
            return self.present
        if isinstance(self.executor, ThreadPoolExecutor):  # whose threads share one renderer
            return 1
        return int(getattr(self.executor, "_max_workers", 0)) or usable_cores()

    @property
    def in_flight(self) -> int:
        """The number of tasks to send before the first result."""
        return OF_EACH * self.count

    @property
    def threads(self) -> int | None:
        """The threads of a task; None where the worker knows better."""
        if self.asked_threads is None and isinstance(self.executor, ProcessPoolExecutor):
            return max(1, usable_cores() // self.count)
        return self.asked_threads

    def submit(self, task: Task) -> Future[Answer]:
        """Send a task."""
        return self.executor.submit(carry_out, task._replace(threads=self.threads))

    def renew(self) -> None:
        """Replace an executor that is broken: a pool of processes is, as a whole, when one of them dies."""
        old = self.executor
        if self.make:
            self.use(self.make())
        elif isinstance(old, ProcessPoolExecutor):
            values = vars(old)
            self.use(
                ProcessPoolExecutor(
                    self.count, values.get("_mp_context"), values.get("_initializer"), values.get("_initargs", ())
                )
            )
            self.is_own = True
        with suppress(Exception):
            old.shutdown(wait=False)

    def close(self, running: set[Future[Answer]], cancel: Callable[[], object]) -> None:
        """End the executor if it was made here; what still runs of its tasks is cancelled."""
        for each in running:
            each.cancel()
        if isinstance(self.executor, ThreadPoolExecutor):
            end_threads(running, cancel)
        if self.is_own:
            self.executor.shutdown(wait=not running, cancel_futures=True)


def end_threads(running: set[Future[Answer]], cancel: Callable[[], object]) -> None:
    """Cancel pictures of threads of this process until all have ended: one may begin after another was cancelled."""
    left = running
    while left:
        cancel()
        left = wait(left, POLL).not_done
