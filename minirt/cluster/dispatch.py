"""Sends tasks to workers, a few at a time, sends again what was lost, and sends contents that workers lack."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from itertools import islice
from typing import NamedTuple

import minirt
from minirt.cluster import files
from minirt.cluster.parcel import Parcel
from minirt.cluster.task import Answer, Made, Missing, Task
from minirt.cluster.workers import WorkerPool
from minirt.errors import MiniRTError, RenderError

DEATHS = 3  # of workers with one task, after which it is no longer made again
SMALL = 2**16  # bytes of a scene that is sent with each task, without being asked for


class Job(NamedTuple):
    """A task, its number, and its scene."""

    number: int
    task: Task
    parcel: Parcel


class Dispatcher:
    """Tasks in flight."""

    def __init__(self, pool: WorkerPool, in_order: bool = False) -> None:
        self.pool = pool
        self.in_order = in_order
        self.again: deque[Job] = deque()  # jobs to send anew
        self.running: dict[Future[Answer], Job] = {}
        self.deaths: dict[int, int] = {}  # of workers, by the number of the task that they had
        self.made: dict[int, Made] = {}  # results that wait for their turn

    def results(self, jobs: Iterable[Job]) -> Iterator[tuple[int, Made]]:
        """Yield the numbers and the results of jobs: as they come, or in the order of the jobs.

        RenderError where a task fails, or where workers die of it again and again.
        """
        rest = iter(jobs)
        turns: deque[int] = deque()
        try:
            while True:
                free = self.pool.in_flight - len(self.running) - len(self.made)
                while self.again:
                    self.send(self.again.popleft())
                for job in islice(rest, max(0, free)):
                    turns.append(job.number)
                    self.send(job)
                if not self.running and not self.again:
                    return
                self.collect()
                while self.made and (not self.in_order or turns[0] in self.made):
                    number = turns.popleft() if self.in_order else next(iter(self.made))
                    yield number, self.made.pop(number)
        finally:
            self.pool.close({each for each in self.running if not each.done()}, self.cancel_here)

    def send(self, job: Job) -> None:
        """Send a task, with its scene if that is small."""
        task = job.task
        if len(job.parcel.data) <= SMALL and task.scene not in task.sent:
            task = task._replace(sent={**task.sent, task.scene: job.parcel.data})
        try:
            self.running[self.pool.submit(task)] = job
        except (BrokenExecutor, RuntimeError) as error:
            if not isinstance(error, BrokenExecutor):
                raise RenderError(f"the executor takes no tasks: {error}") from error
            self.died(job)
            self.pool.renew()

    def collect(self) -> None:
        """Wait for some tasks, and note their results."""
        done, _ = wait(self.running, return_when=FIRST_COMPLETED)
        is_broken = False
        for future in done:
            job = self.running.pop(future)
            try:
                answer = future.result()
            except (BrokenExecutor, CancelledError):
                is_broken = True
                self.died(job)
                continue
            except MiniRTError:
                raise
            except Exception as error:
                if type(error).__name__ == "KilledWorker":  # of dask, which has tried several workers
                    raise RenderError(f"{job.task.what}: workers died, one after the other") from error
                raise RenderError(f"{job.task.what} failed: {type(error).__name__}: {error}") from error
            if isinstance(answer, Missing):
                self.again.append(with_contents(job, answer))
            else:
                self.made[job.number] = answer
        if is_broken:
            for job in self.running.values():
                self.died(job)
            self.running.clear()
            self.pool.renew()

    def died(self, job: Job) -> None:
        """Have a task made again whose worker died; RenderError when that has happened too often."""
        deaths = self.deaths[job.number] = self.deaths.get(job.number, 0) + 1
        if deaths > DEATHS:
            raise RenderError(f"{job.task.what}: {deaths} workers died, one after the other")
        self.again.append(job)

    def cancel_here(self) -> None:
        """Cancel the pictures of tasks that this process renders."""
        for job in self.running.values():
            how = job.task.settings
            minirt.renderer(self.pool.threads, how.precision, how.depth, how.dither).cancel()


def with_contents(job: Job, missing: Missing) -> Job:
    """Return a job with the contents that a worker lacks."""
    contents = {each: files.read(each) for each in missing.digests if each != job.task.scene}
    return job._replace(task=job.task._replace(sent={**contents, job.task.scene: job.parcel.data}))
