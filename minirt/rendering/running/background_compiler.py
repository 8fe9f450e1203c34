"""Compiles narrow kernels in the background, by a process of the lowest priority, while a wide kernel draws."""

from __future__ import annotations

import logging
from threading import Lock, Thread

from minirt.errors import RenderError
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY


class BackgroundCompiler:
    """Compiles one kernel at a time; of those that are asked for meanwhile, the last one is next."""

    def __init__(self) -> None:
        self.process = CompileProcess(patient=True)
        self.lock = Lock()
        self.wanted: str | None = None
        self.asked: set[str] = set()  # identities that were compiled, or failed
        self.thread: Thread | None = None

    @property
    def busy(self) -> bool:
        """Whether a kernel is being compiled."""
        return self.thread is not None

    def compile(self, identity: str) -> None:
        """Ask for a kernel, unless that was done before; callable from any thread."""
        with self.lock:
            if identity in self.asked:
                return
            self.wanted = identity
            if not self.thread:
                self.thread = Thread(target=self.work, name="minirt-compiler", daemon=True)
                self.thread.start()

    def work(self) -> None:
        """Compile what is wanted until nothing is: the body of the thread."""
        while identity := self.next():
            try:
                LIBRARY.compile([identity], self.process)
            except RenderError as error:
                logging.getLogger(__name__).info("a wide kernel stays in use: %s", error)

    def next(self) -> str | None:
        """Return the identity of the next kernel; None, which ends the thread, where there is none."""
        with self.lock:
            identity, self.wanted = self.wanted, None
            if identity is None:
                self.thread = None
            else:
                self.asked.add(identity)
            return identity

    def stop(self) -> None:
        """End compiling; callable from any thread."""
        with self.lock:
            self.wanted = None
        self.process.stop()
