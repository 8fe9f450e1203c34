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
from typing import Any, NamedTuple

from minirt.cluster.job import Job, Made, Workers, packed, render_sent_band, version
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


class SentScene(NamedTuple):
    """A scene that workers have, whatever its camera."""

    contents: object  # its file, and its elements without cameras: what tells it from others
    data: bytes  # the packed scene
    at_workers: Any  # what stands for these bytes in a task: they, or dask's name of the copies at its workers


class Sending(NamedTuple):
    """The last sending of a band to a worker."""

    at: float  # seconds
    patience: float  # seconds that it may take


class Dispatcher:
    """Bands in flight to an executor. One that is late is sent to another worker, too, since the first may hang."""

    def __init__(self, workers: Workers) -> None:
        """Take `workers`, or make them where that is a function; those that are made here end with `close`.

        A process of a pool that runs the main script once more, and so comes here, is ended.
        """
        if getattr(current_process(), "_inheriting", False):  # as multiprocessing marks one that imports the script
            os._exit(UNGUARDED)
        self.is_own = callable(workers) and not hasattr(workers, "submit")
        with terminal_signals_blocked():  # which multiprocessing's tracker of resources would get, too
            made = workers() if self.is_own else workers
        self.client: Any = made if hasattr(made, "get_executor") else getattr(made, "_client", None)
        self.executor: Any = made.get_executor() if hasattr(made, "get_executor") else made
        self.is_pool = isinstance(self.executor, ProcessPoolExecutor)
        self.where = "the executor" if self.client is None else f"the scheduler at {self.client.scheduler.address}"
        self.scene = SentScene(None, b"", b"")  # that was sent last
        self.sendings: dict[Future[Made], Sending] = {}  # of the bands in flight, by the futures of their results
        self.tasks: dict[Future[Made], Future[Made]] = {}  # at workers, and the future that gets the result of each
        self.has_late = False  # whether a band was late
        self.longest = 0.0  # seconds from sending a band to its end

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
        """Yield bands and what was made of them, the first that is done first, or `in_order`.

        When the generator ends or is closed, bands that are not made yet are cancelled, as `close` does. `restore` gets
        a band and returns what was made of it before, or None where it has to be rendered. RenderError where a band
        fails, its worker dies or the cluster has ended.
        """
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
                tasks_of_band = [task for task, owner in self.tasks.items() if owner is future]
                for task in tasks_of_band[1:]:  # but not the first: a worker that hangs should get no other band
                    task.cancel()
                self.sendings.pop(future, None)
                band = running.pop(future)
                yield band, self.made_of(band, future)
        finally:
            self.close()

    def first_made(self, running: dict[Future[Made], Job]) -> Future[Made]:
        """Wait until one of some bands is made, and return its future. Bands that are late are sent once more, and have
        twice the time then. RenderError where there have been no workers for too long."""
        workers_seen = perf_counter()
        while not (made := wait(running, WATCH, "FIRST_COMPLETED").done):
            now = perf_counter()
            workers_seen = now if self.count else workers_seen
            if now - workers_seen > DESERTED:
                raise RenderError(f"{self.where} has had no workers for {DESERTED:.0f} s")
            for future, band in running.items():
                sending = self.sendings[future]
                if now - sending.at > max(sending.patience, LONGER * (self.longest or LATE)):
                    self.has_late = True
                    self.send(band, future, 2 * sending.patience)
        return next(iter(made))

    def send(self, band: Job, future: Future[Made], patience: float) -> None:
        """Send a band to a worker, which has `patience` seconds for it.

        The future gets the result, unless another worker with the same band is faster. Scenes that differ in the camera
        alone are packed once. RenderError where the executor takes no tasks.
        """
        scene, settings = band.scene, band.settings
        contents = scene.file, [each for each in scene.elements if not isinstance(each, Camera)]
        if self.scene.contents != contents:
            at_workers: Any = packed(scene, with_files=not self.is_pool)
            data = at_workers
            if self.client is not None and len(data) > LARGE:
                at_workers = self.client.submit(bytes, data, key=f"minirt-{hashlib.sha256(data).hexdigest()}")
            self.scene = SentScene(contents, data, at_workers)
        if settings.threads is None and self.is_pool:
            settings = settings.replace(threads=max(1, usable_cores() // self.count))
        nowhere: Any = None  # in place of the scene of the band, which travels packed
        # A worker that hangs may be the only one that has a large scene.
        arguments = version(), self.scene.data if self.has_late else self.scene.at_workers, scene.camera
        # By default dask takes a band that is sent again for the same task.
        how = {} if self.client is None else {"pure": False}
        try:
            with held_signals(), terminal_signals_blocked():  # the first task starts the processes of a pool
                sent = band._replace(scene=nowhere, settings=settings)
                task = self.executor.submit(render_sent_band, *arguments, sent, **how)
        except RuntimeError as error:
            raise RenderError(f"the executor takes no tasks: {error}") from error
        self.sendings[future] = Sending(perf_counter(), patience)
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
                if processes:  # wait for the thread of the pool that collects their exit statuses
                    self.executor._executor_manager_thread.join(COLLECTING)
                is_unguarded = any(each.exitcode == UNGUARDED for each in processes)
                why = f": {GUARD}" if is_unguarded else ""
                raise RenderError(f"{band.what}: its worker died{why}") from error
            raise RenderError(f"{band.what} failed: {type(error).__name__}: {error}") from error

    def processes(self) -> list[Any]:
        """Return the processes of a pool that has not been shut down."""
        return list((vars(self.executor).get("_processes") or {}).values()) if self.is_pool else []

    def close(self) -> None:
        """Cancel the bands that have not been made, and end the executor if it was made here."""
        with held_signals():
            unfinished = [each for each in self.tasks if not each.done()]
            # A pool whose processes are killed fails with InvalidStateError if some of its tasks are cancelled.
            if not (self.is_own and self.is_pool):
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
