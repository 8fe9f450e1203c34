"""Threads that are kept from picture to picture, and run jobs side by side; how many processors may be used."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import NamedTuple, TypeAlias
from weakref import finalize

Job: TypeAlias = Callable[[], object]

# Of threads that give way. The event loop composes frames sooner: the longest pause of a drag falls from 34 ms to 30.
# With 10 it falls to 28, but that of a held key grows from 26 ms to 34.
NICENESS = 4
LONGEST_WAIT = 0.2  # seconds: Python does not see a signal that comes just before it waits until the wait ends


class Task(NamedTuple):
    """A job in the queue, and the means to report that it has ended.

    Each job appends its error or None to `results`. Only errors and the last of the `total` jobs put something into
    `wake_up`: waking the waiting thread takes time from the threads that work.
    """

    job: Job
    results: list[BaseException | None]
    total: int
    wake_up: SimpleQueue[None]


class ThreadPool:
    """A fixed number of threads that run jobs, or as many as the system allows.

    It uses plain queues: handing out the jobs and collecting the results takes half as long as with futures, 0.04 ms.
    """

    def __init__(self, number: int) -> None:
        self.tasks: SimpleQueue[Task | None] = SimpleQueue()
        self.threads: list[Thread] = []
        with suppress(RuntimeError):  # the system allows no more threads
            for _ in range(number):
                thread = Thread(target=run_tasks, args=(self.tasks,), name="minirt-render", daemon=True)
                thread.start()
                self.threads.append(thread)
        finalize(self, stop_threads, self.tasks, len(self.threads))

    def give_way(self) -> None:
        """Let the other threads of the process go first from now on. Only Linux has priorities of threads."""
        if sys.platform == "linux":
            niceness = os.getpriority(os.PRIO_PROCESS, os.getpid()) + NICENESS
            for thread in self.threads:
                with suppress(OSError):  # where a sandbox forbids it
                    os.setpriority(os.PRIO_PROCESS, thread.native_id or 0, niceness)

    def run(self, jobs: list[Job], cancel: Callable[[], None]) -> None:
        """Run jobs on the threads, or on the caller's without any, and wait for all of them; an error of one is raised.

        `cancel` makes the jobs end early. It is called when a job fails, and when Ctrl+C interrupts the wait.
        """
        if not self.threads:
            for job in jobs:
                job()
            return
        results: list[BaseException | None] = []
        wake_up: SimpleQueue[None] = SimpleQueue()
        for job in jobs:
            self.tasks.put(Task(job, results, len(jobs), wake_up))
        interrupts: list[BaseException] = []
        while len(results) < len(jobs):
            try:
                with suppress(Empty):
                    wake_up.get(timeout=LONGEST_WAIT)
            except BaseException as interrupt:
                interrupts.append(interrupt)
            if interrupts or any(results):
                cancel()
        for error in (*interrupts, *filter(None, results)):
            raise error


def run_tasks(tasks: SimpleQueue[Task | None]) -> None:
    """Run one task after the other, in a thread of the pool, until the queue holds None."""
    while task := tasks.get():
        error = None
        try:
            task.job()
        except BaseException as raised:
            error = raised
        task.results.append(error)
        if error or len(task.results) == task.total:
            task.wake_up.put(None)
        del task, error


def stop_threads(tasks: SimpleQueue[Task | None], number: int) -> None:
    """End the threads of a pool, once they have run the tasks in the queue."""
    for _ in range(number):
        tasks.put(None)


QUOTA = Path(
    "/sys/fs/cgroup/cpu.max"
)  # of a container: microseconds of processor time per period, and the period in microseconds


def usable_cores() -> int:
    """Count the processors that the affinity of the process and the limit of its container allow; at least 1."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        quota, period = QUOTA.read_text().split()
        return max(1, min(cores, round(int(quota) / int(period))))
    except (OSError, ValueError):  # no container, or one without limit ("max 100000")
        return cores
