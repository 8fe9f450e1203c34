"""Executors of bands: the threads of this process, an executor of `concurrent.futures`, or a dask cluster."""

from __future__ import annotations

import hashlib
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from itertools import islice
from multiprocessing import get_context, parent_process
from threading import Thread
from typing import Any, TypeAlias

from minirt.cluster.job import Job, Made
from minirt.cluster.worker import packed, version, work
from minirt.errors import MiniRTError, RenderError
from minirt.rendering.threads import usable_cores
from minirt.scene import Camera

OF_EACH = 2  # bands of each worker in flight: one is rendered, one waits
LARGE = 2**16  # bytes of a packed scene that dask keeps, and hands to each worker once
MOST_PROCESSES = 8  # on this machine; each has its share of the processors

Workers: TypeAlias = Executor | Callable[[], Executor] | Any  # the last is a client of dask.distributed


class Dispatcher:
    """Bands in flight to an executor."""

    def __init__(self, workers: Any) -> None:
        self.is_own = callable(workers) and not hasattr(workers, "submit")
        made = workers() if self.is_own else workers
        self.client: Any = made if hasattr(made, "get_executor") else getattr(made, "_client", None)
        self.executor: Executor = made.get_executor() if hasattr(made, "get_executor") else made
        self.is_pool = isinstance(self.executor, ProcessPoolExecutor)
        self.last: tuple[object, Any] = None, b""  # the scene that was packed last, and its bytes

    @property
    def count(self) -> int:
        """The number of workers; those of a cluster may come and go."""
        if self.client is not None:
            return max(1, len(self.client.nthreads()))
        return int(getattr(self.executor, "_max_workers", 0)) or usable_cores()

    def results(
        self, bands: Iterable[Job], restore: Callable[[Job], Made | None], in_order: bool
    ) -> Iterator[tuple[Job, Made]]:
        """Yield bands and what was made of them, here or before; RenderError where one fails or its worker dies."""
        rest = iter(bands)
        running: dict[Future[Made], Job] = {}
        try:
            while True:
                for band in islice(rest, max(0, OF_EACH * self.count - len(running))):
                    running[self.future(band, restore(band))] = band
                if not running:
                    return
                ready = running if in_order else wait(running, return_when=FIRST_COMPLETED).done
                future = next(iter(ready))
                band = running.pop(future)
                yield band, made_of(band, future)
        finally:
            self.close(running)

    def future(self, band: Job, kept: Made | None) -> Future[Made]:
        """Send a band to a worker, unless it is kept. Scenes that differ in the camera alone are packed once."""
        if kept:
            done: Future[Made] = Future()
            done.set_result(kept)
            return done
        scene, settings = band.scene, band.settings
        others = scene.file, [each for each in scene.elements if not isinstance(each, Camera)]
        if self.last[0] != others:
            data: Any = packed(scene, with_files=not self.is_pool)
            if self.client is not None and len(data) > LARGE:
                data = self.client.submit(bytes, data, key=f"minirt-{hashlib.sha256(data).hexdigest()}")
            self.last = others, data
        if settings.threads is None and self.is_pool:
            settings = settings.replace(threads=max(1, usable_cores() // self.count))
        nowhere: Any = None
        sent = band._replace(scene=nowhere, settings=settings)
        try:
            return self.executor.submit(work, version(), self.last[1], scene.camera, sent)
        except RuntimeError as error:
            raise RenderError(f"the executor takes no tasks: {error}") from error

    def close(self, running: Iterable[Future[Made]]) -> None:
        """Cancel what has not been made, and end the executor if it was made here."""
        unfinished = [each for each in running if not each.done()]
        for each in unfinished:
            each.cancel()
        if not self.is_own:
            return
        # An idle process waits with the lock of the queue: where it has been killed, the others never learn of the end.
        for each in list((vars(self.executor).get("_processes") or {}).values()):
            each.terminate()
        self.executor.shutdown(wait=not unfinished, cancel_futures=True)


def made_of(band: Job, future: Future[Made]) -> Made:
    """Wait for what is made of a band; RenderError where that fails."""
    try:
        return future.result()
    except MiniRTError:
        raise
    except Exception as error:
        if isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker":  # the latter of dask
            raise RenderError(f"{band.what}: its worker died") from error
        raise RenderError(f"{band.what} failed: {type(error).__name__}: {error}") from error


def local_pool() -> Executor:
    """Return a pool of processes of this machine that leave Ctrl+C to this one, and end with it."""
    return ProcessPoolExecutor(min(usable_cores(), MOST_PROCESSES), get_context("spawn"), prepare_process)


def prepare_process() -> None:
    """Let a process of the pool ignore Ctrl+C, which a terminal sends to all, and not wait for ever for the work of a
    killed program."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=end_with_parent, daemon=True).start()


def end_with_parent() -> None:
    """Wait until the parent of this process has died, and end it at once."""
    if parent := parent_process():
        parent.join()
        os._exit(1)
