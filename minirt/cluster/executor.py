"""Executors of bands: the threads of this process, an executor of `concurrent.futures`, or a dask cluster."""

from __future__ import annotations

import hashlib
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import suppress
from itertools import islice
from math import inf
from time import monotonic
from typing import Any, TypeAlias

from minirt.cluster.job import Band, Made
from minirt.cluster.worker import packed, version, work
from minirt.errors import MiniRTError, RenderError
from minirt.rendering.threads import usable_cores
from minirt.scene import Camera

OF_EACH = 2  # bands of each worker in flight: one is rendered, one waits
PAUSE = 1.0  # seconds from one count of a cluster's workers to the next
DEATHS = 3  # of workers without a result between them, after which their bands are not made again
LARGE = 2**16  # bytes of a packed scene that dask keeps, and hands to each worker once
MOST_PROCESSES = 8  # on this machine; each has its share of the processors

Workers: TypeAlias = Executor | Callable[[], Executor] | Any  # the last is a client of dask.distributed


Arguments: TypeAlias = tuple[str, str, Camera, Band, Any]  # of `work`; for dask the last may be a future


class Dispatcher:
    """Bands in flight to an executor, which is made anew where it breaks."""

    def __init__(self, workers: Workers) -> None:
        self.make = workers if callable(workers) and not hasattr(workers, "submit") else None
        self.is_own = self.make is not None
        self.use(self.make() if self.make else workers)
        self.running: dict[Future[Made], Arguments] = {}
        self.again: deque[Arguments] = deque()  # of workers that died
        self.deaths = 0  # of workers since the last result
        self.last: tuple[object, str, Any] = None, "", b""  # the scene that was packed last, its digest and its bytes

    def use(self, workers: Any) -> None:
        """Send bands to an executor, or to a client of dask, from now on."""
        self.client = workers if hasattr(workers, "get_executor") else getattr(workers, "_client", None)
        self.executor: Executor = workers.get_executor() if hasattr(workers, "get_executor") else workers
        self.is_pool = isinstance(self.executor, ProcessPoolExecutor)
        self.present, self.asked = 1, -inf  # workers of the client, and when they were counted

    @property
    def count(self) -> int:
        """The number of workers; those of a cluster may come and go."""
        if self.client is None:
            return int(getattr(self.executor, "_max_workers", 0)) or usable_cores()
        if monotonic() > self.asked + PAUSE:  # asking takes a millisecond
            self.present, self.asked = max(1, len(self.client.nthreads())), monotonic()
        return self.present

    def results(self, bands: Iterable[Band], in_order: bool) -> Iterator[tuple[int, Made]]:
        """Yield the numbers of bands and what was made of them; RenderError where one fails, or where workers die of it
        again and again."""
        rest = iter(bands)
        turns: deque[int] = deque()
        made: dict[int, Made] = {}  # that wait for their turn
        try:
            while True:
                while self.again:
                    self.send(self.again.popleft())
                for band in islice(rest, max(0, OF_EACH * self.count - len(self.running) - len(made))):
                    turns.append(band.number)
                    self.send(self.arguments(band))
                if not self.running and not self.again:
                    return
                self.collect(made)
                while made and (not in_order or turns[0] in made):
                    number = turns.popleft() if in_order else next(iter(made))
                    yield number, made.pop(number)
        finally:
            self.close()

    def arguments(self, band: Band) -> Arguments:
        """Return what is sent for a band. Scenes that differ in the camera alone are packed once."""
        scene, settings = band.scene, band.settings
        others = scene.file, [each for each in scene.elements if not isinstance(each, Camera)]
        if self.last[0] != others:
            data: Any = packed(scene, with_files=not self.is_pool)
            digest = hashlib.sha256(data).hexdigest()
            if self.client is not None and len(data) > LARGE:
                data = self.client.submit(bytes, data, key=f"minirt-{digest}")
            self.last = others, digest, data
        if settings.threads is None and self.is_pool:
            settings = settings.replace(threads=max(1, usable_cores() // self.count))
        nowhere: Any = None
        _, digest, data = self.last
        return version(), digest, scene.camera, band._replace(scene=nowhere, settings=settings), data

    def send(self, arguments: Arguments) -> None:
        """Send a band."""
        try:
            self.running[self.executor.submit(work, *arguments)] = arguments
        except BrokenExecutor:
            self.again.append(arguments)
            self.renew()
        except RuntimeError as error:
            raise RenderError(f"the executor takes no tasks: {error}") from error

    def collect(self, made: dict[int, Made]) -> None:
        """Wait for some bands, and note what was made of them. Bands of workers that died are made again."""
        done, _ = wait(self.running, return_when=FIRST_COMPLETED)
        for future in done:
            arguments = self.running.pop(future)
            band = arguments[3]
            try:
                made[band.number] = future.result()
                self.deaths = 0
            except (BrokenExecutor, CancelledError):
                self.again.append(arguments)
            except MiniRTError:
                raise
            except Exception as error:
                if type(error).__name__ == "KilledWorker":  # of dask, which has tried several workers
                    raise RenderError(f"{band.what}: workers died, one after the other") from error
                raise RenderError(f"{band.what} failed: {type(error).__name__}: {error}") from error
        if self.again:
            self.again.extend(self.running.values())
            self.running.clear()
            self.renew()

    def renew(self) -> None:
        """Replace a pool of processes that is broken, which it is as a whole when one of them dies; RenderError when
        that happens again and again."""
        self.deaths += 1
        if self.deaths > DEATHS:
            raise RenderError(f"{self.again[0][3].what}: {self.deaths} workers died, one after the other")
        old = self.executor
        if self.make:
            self.use(self.make())
        elif self.is_pool:
            made = vars(old)
            how = made.get("_mp_context"), made.get("_initializer"), made.get("_initargs", ())
            self.use(ProcessPoolExecutor(self.count, *how))
            self.is_own = True
        with suppress(Exception):
            old.shutdown(wait=False)

    def close(self) -> None:
        """Cancel what has not been made, and end the executor if it was made here."""
        unfinished = [each for each in self.running if not each.done()]
        for each in unfinished:
            each.cancel()
        if not self.is_own:
            return
        # An idle process waits with the lock of the queue: where it has been killed, the others never learn of the end.
        for each in list((vars(self.executor).get("_processes") or {}).values()):
            each.terminate()
        self.executor.shutdown(wait=not unfinished, cancel_futures=True)


def local_pool() -> Executor:
    """Return a pool of processes of this machine that leave Ctrl+C to this one, and end with it."""
    from multiprocessing import get_context

    return ProcessPoolExecutor(min(usable_cores(), MOST_PROCESSES), get_context("spawn"), prepare_process)


def prepare_process() -> None:
    """Prepare a process of the pool: it ignores Ctrl+C, which a terminal sends to all, and ends when its parent dies.

    Otherwise the processes of a killed program would wait for work for ever.
    """
    from threading import Thread

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=end_with_parent, daemon=True).start()


def end_with_parent() -> None:
    """Wait until the parent of this process has died, and end it at once."""
    from multiprocessing import parent_process

    if parent := parent_process():
        parent.join()
        os._exit(1)
