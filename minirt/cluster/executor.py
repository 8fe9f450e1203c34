"""Executors of bands: the threads of this process, an executor of `concurrent.futures`, or a dask cluster."""

from __future__ import annotations

import hashlib
import os
import signal
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, InvalidStateError, ProcessPoolExecutor, wait
from contextlib import contextmanager, suppress
from functools import partial
from itertools import islice
from multiprocessing import current_process, get_context, parent_process
from threading import Thread
from time import perf_counter
from typing import Any

from minirt.cluster.job import Job, Made, Workers, packed, version, work
from minirt.errors import MiniRTError, RenderError
from minirt.helpers.signals import held_signals
from minirt.rendering.threads import usable_cores
from minirt.scene import Camera

OF_EACH = 2  # bands of each worker in flight: one is rendered, one waits
LARGE = 2**16  # bytes of a packed scene that dask keeps, and hands to each worker once
MOST_PROCESSES = 8  # on this machine; each has its share of the processors
LATE, LONGER = 60.0, 10  # seconds, and times the longest band so far, after which one is late; without any, both
SILENT, DESERTED = 60.0, 300.0  # seconds without an answer of the scheduler, and without workers, that end the work
WATCH = 1.0  # seconds between two looks at what is late
COLLECTING = 1.0  # seconds for the exit statuses of processes
UNGUARDED = 87  # exit status of a process of a pool that runs the script which has started it
GUARD = "it ran this script once more: put the call below \"if __name__ == '__main__':\""


class Dispatcher:
    """Bands in flight to an executor. One that is late is sent to another worker, too, since the first may hang."""

    def __init__(self, workers: Workers) -> None:
        if getattr(current_process(), "_inheriting", False):  # as multiprocessing marks one that imports the script
            os._exit(UNGUARDED)
        self.is_own = callable(workers) and not hasattr(workers, "submit")
        with terminal_signals_blocked():  # which multiprocessing's tracker of resources would get, too
            made = workers() if self.is_own else workers
        self.client: Any = made if hasattr(made, "get_executor") else getattr(made, "_client", None)
        self.executor: Any = made.get_executor() if hasattr(made, "get_executor") else made
        self.is_pool = isinstance(self.executor, ProcessPoolExecutor)
        self.where = "the executor" if self.client is None else f"the scheduler at {self.client.scheduler.address}"
        self.last: tuple[object, bytes, Any] = None, b"", b""  # a scene, its bytes, and what stands for them at workers
        self.sent: dict[Future[Made], tuple[float, float]] = {}  # seconds: when it was sent, how long that may take
        self.tasks: dict[Future[Made], Future[Made]] = {}  # at workers, and whose result is theirs
        self.has_late, self.longest = False, 0.0  # seconds from sending a band to its end

    @property
    def count(self) -> int:
        """The number of workers; those of a cluster may come and go. RenderError where the scheduler is silent."""
        if self.client is None:
            return int(getattr(self.executor, "_max_workers", 0)) or usable_cores()
        try:
            return len(self.client.sync(self.client.scheduler.ncores, workers=None, callback_timeout=SILENT))
        except OSError as error:
            raise RenderError(f"{self.where} has ended, or does not answer") from error

    def results(
        self, bands: Iterable[Job], restore: Callable[[Job], Made | None], in_order: bool
    ) -> Generator[tuple[Job, Made], None, None]:
        """Yield bands and what was made of them, here or before; RenderError where one fails, its worker dies or the
        cluster has ended."""
        rest = iter(bands)
        running: dict[Future[Made], Job] = {}
        try:
            while True:
                for band in islice(rest, max(0, OF_EACH * max(1, self.count) - len(running))):
                    future: Future[Made] = Future()
                    running[future] = band
                    if kept := restore(band):
                        future.set_result(kept)
                    else:
                        self.send(band, future, LATE)
                if not running:
                    return
                future = self.first_made(dict(islice(running.items(), 1)) if in_order else running)
                for task in [task for task, owner in self.tasks.items() if owner is future][1:]:
                    task.cancel()  # but not the first: a worker that hangs should not get another
                self.sent.pop(future, None)
                band = running.pop(future)
                yield band, self.made_of(band, future)
        finally:
            self.close()

    def first_made(self, running: dict[Future[Made], Job]) -> Future[Made]:
        """Wait until one of some bands is made, and send those that are late once more; RenderError where there have
        been no workers for too long."""
        seen = perf_counter()
        while not (made := wait(running, WATCH, "FIRST_COMPLETED").done):
            now = perf_counter()
            seen = now if self.count else seen
            if now - seen > DESERTED:
                raise RenderError(f"{self.where} has had no workers for {DESERTED:.0f} s")
            for future, band in running.items():
                sent, patience = self.sent[future]
                if now - sent > max(patience, LONGER * (self.longest or LATE)):
                    self.has_late = True
                    self.send(band, future, 2 * patience)
        return next(iter(made))

    def send(self, band: Job, future: Future[Made], patience: float) -> None:
        """Send a band to a worker, whose result will be that of a future unless another one's is first. Scenes that
        differ in the camera alone are packed once."""
        scene, settings = band.scene, band.settings
        others = scene.file, [each for each in scene.elements if not isinstance(each, Camera)]
        if self.last[0] != others:
            there: Any = packed(scene, with_files=not self.is_pool)
            data = there
            if self.client is not None and len(data) > LARGE:
                there = self.client.submit(bytes, data, key=f"minirt-{hashlib.sha256(data).hexdigest()}")
            self.last = others, data, there
        if settings.threads is None and self.is_pool:
            settings = settings.replace(threads=max(1, usable_cores() // self.count))
        nowhere: Any = None
        # A worker that hangs may be the only one that has a large scene.
        arguments = version(), self.last[1 if self.has_late else 2], scene.camera
        how = {} if self.client is None else {"pure": False}  # dask makes the same again
        try:
            with held_signals(), terminal_signals_blocked():  # the first task starts the processes of a pool
                task = self.executor.submit(work, *arguments, band._replace(scene=nowhere, settings=settings), **how)
        except RuntimeError as error:
            raise RenderError(f"the executor takes no tasks: {error}") from error
        self.sent[future] = perf_counter(), patience
        self.tasks = {each: owner for each, owner in self.tasks.items() if not each.done()} | {task: future}
        task.add_done_callback(partial(self.hand_over, future, perf_counter()))

    def hand_over(self, future: Future[Made], sent: float, task: Future[Made]) -> None:
        """Give a future the result of a task, unless it has that of another one."""
        with suppress(InvalidStateError):
            if task.cancelled():
                future.set_exception(RenderError(f"{self.where} has ended, or has cancelled the work"))
            elif error := task.exception():
                future.set_exception(error)
            else:
                future.set_result(task.result())
                self.longest = max(self.longest, perf_counter() - sent)

    def made_of(self, band: Job, future: Future[Made]) -> Made:
        """Return what is made of a band; RenderError where that has failed."""
        try:
            return future.result()
        except MiniRTError:
            raise
        except Exception as error:
            if isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker":  # the latter of dask
                processes = self.processes()
                if processes:  # whose exit statuses a thread of the pool collects
                    self.executor._executor_manager_thread.join(COLLECTING)
                is_unguarded = any(each.exitcode == UNGUARDED for each in processes)
                raise RenderError(f"{band.what}: its worker died" + f": {GUARD}" * is_unguarded) from error
            raise RenderError(f"{band.what} failed: {type(error).__name__}: {error}") from error

    def processes(self) -> list[Any]:
        """Return the processes of a pool that has not been shut down."""
        return list((vars(self.executor).get("_processes") or {}).values()) if self.is_pool else []

    def close(self) -> None:
        """Cancel what has not been made, and end the executor if it was made here."""
        with held_signals():
            unfinished = [each for each in self.tasks if not each.done()]
            if not (self.is_own and self.is_pool):  # which fails with InvalidStateError, if it breaks with such tasks
                for each in unfinished:
                    each.cancel()
            if self.is_own:
                # An idle process waits with the lock of the queue: where it has been killed, the others never learn of
                # the end. So all are killed, also those that are stopped.
                for process in self.processes():
                    process.kill()
                # The thread of the pool would wait for ever for the rest of a result, or for somebody to read a task.
                for queue, end in ("_result_queue", "_writer"), ("_call_queue", "_reader"):
                    with suppress(AttributeError):  # not a pool of processes
                        getattr(getattr(self.executor, queue), end).close()
                self.executor.shutdown(wait=not unfinished, cancel_futures=True)


def local_pool() -> Executor:
    """Return a pool of processes of this machine that leave Ctrl+C to this one, and end with it."""
    return ProcessPoolExecutor(min(usable_cores(), MOST_PROCESSES), get_context("spawn"), prepare_process)


@contextmanager
def terminal_signals_blocked() -> Iterator[None]:
    """Let processes that the block starts never get Ctrl+C, nor SIGHUP: a terminal sends them to all, and this process
    ends the others."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGHUP])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def prepare_process() -> None:
    """Let a process of the pool ignore Ctrl+C, also on Windows, and end at once with a killed parent."""

    def end_with_parent(parent: Any) -> None:
        parent.join()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=end_with_parent, args=[parent_process()], daemon=True).start()
