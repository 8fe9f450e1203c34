"""Threads that wait for work."""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from threading import Thread
from typing import NamedTuple, TypeAlias
from weakref import finalize

Job: TypeAlias = Callable[[], object]


class Task(NamedTuple):
    """A job, and where its end is told: by an item in the list, an error or None. Errors and the last of the `number`
    of jobs ring the bell: to wake who waits takes time from those that work."""

    job: Job
    ended: list[BaseException | None]
    number: int
    bell: SimpleQueue[None]


class ThreadPool:
    """Threads that do jobs side by side, kept from one time to the next.

    Plain queues: from giving out the jobs to having them back it takes half as long as with futures, 0.04 ms.
    """

    def __init__(self, number: int) -> None:
        self.tasks: SimpleQueue[Task | None] = SimpleQueue()
        for _ in range(number):
            Thread(target=run_tasks, args=(self.tasks,), name="minirt-render", daemon=True).start()
        finalize(self, stop_threads, self.tasks, number)

    def run(self, jobs: list[Job], cancel: Callable[[], None]) -> None:
        """Do as many jobs as there are threads, and wait for all of them; an error of one is raised.

        `cancel` makes jobs end early. It is called when one fails, and when the wait is interrupted, as by Ctrl+C.
        """
        ended: list[BaseException | None] = []
        bell: SimpleQueue[None] = SimpleQueue()
        for job in jobs:
            self.tasks.put(Task(job, ended, len(jobs), bell))
        interrupts: list[BaseException] = []
        while len(ended) < len(jobs):
            try:
                bell.get()
            except BaseException as interrupt:
                interrupts.append(interrupt)
            if interrupts or any(ended):
                cancel()
        for error in (*interrupts, *filter(None, ended)):
            raise error


def run_tasks(tasks: SimpleQueue[Task | None]) -> None:
    """What a thread does: one job after the other, until there is None."""
    while task := tasks.get():
        error = None
        try:
            task.job()
        except BaseException as raised:
            error = raised
        task.ended.append(error)
        if error or len(task.ended) == task.number:
            task.bell.put(None)
        del task, error


def stop_threads(tasks: SimpleQueue[Task | None], number: int) -> None:
    """Let the threads end."""
    for _ in range(number):
        tasks.put(None)
