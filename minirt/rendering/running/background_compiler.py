"""Compiles specialised kernels in the background, by a process of the lowest priority, while a generic kernel draws."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from contextlib import suppress
from threading import Lock, Thread

from minirt.errors import RenderError
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY


class BackgroundCompiler:
    """Compiles one kernel at a time; of those that are wanted meanwhile, the last one is next."""

    def __init__(self) -> None:
        self.process = CompileProcess(patient=True)
        self.lock = Lock()
        self.wanted: str | None = None
        self.later: list[str] = []  # when nothing else is wanted
        self.asked: set[str] = set()  # identities that were compiled, or failed
        self.thread: Thread | None = None
        self.notify: Callable[[], object] = lambda: None  # called when nothing is being compiled any more

    @property
    def busy(self) -> bool:
        """Whether a kernel is being compiled."""
        return self.thread is not None

    def compile(self, identity: str) -> None:
        """Ask for a kernel, unless that was done before; callable from any thread."""
        with self.lock:
            if identity not in self.asked:
                self.wanted = identity
                self.start()

    def compile_later(self, identities: Iterable[str]) -> None:
        """Ask for kernels that are compiled when nothing else is wanted; callable from any thread."""
        with self.lock:
            self.later = [each for each in identities if each not in self.asked]
            if self.later:
                self.start()

    def start(self) -> None:
        """Start the thread, unless it runs or the system allows no more threads. The caller holds the lock."""
        if not self.thread:
            thread = Thread(target=self.work, name="minirt-compiler", daemon=True)
            with suppress(RuntimeError):
                thread.start()
                self.thread = thread

    def work(self) -> None:
        """Compile what is wanted until nothing is: the body of the thread."""
        while identity := self.next():
            try:
                LIBRARY.compile([identity], self.process)
            except RenderError as error:
                logging.getLogger(__name__).info("a generic kernel stays in use: %s", error)
        self.notify()

    def next(self) -> str | None:
        """Return the identity of the next kernel; None, which ends the thread, where there is none."""
        with self.lock:
            identity, self.wanted = self.wanted or (self.later.pop(0) if self.later else None), None
            if identity is None:
                self.thread = None
            else:
                self.asked.add(identity)
            return identity

    def stop(self) -> None:
        """End compiling; callable from any thread."""
        with self.lock:
            self.wanted, self.later = None, []
        self.process.stop()
