"""Kernels of one renderer: chooses the one that draws a frame, and has missing ones compiled.

A process of the lowest priority compiles specialised kernels in the background while a generic one draws.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Hashable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import cache, cached_property
from threading import Lock, Thread
from typing import NamedTuple

from minirt.errors import RenderError
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.library import LIBRARY, REMEMBERED
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering.frame import Frame
from minirt.rendering.needed_kernels import calls_for, kernel_features, packing_calls, wide_call
from minirt.rendering.packing.generic import WIDE_KERNELS, WideKernel, fitting, widened
from minirt.scene import Scene


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
                logging.getLogger(__name__).info("a wide kernel stays in use: %s", error)
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


NARROW_AFTER = 0.5  # seconds of rendering with a wide kernel, after which a narrow one is worth compiling


class Choice(NamedTuple):
    """A kernel and the form of the scene that it takes."""

    entry: Entry
    scene: SceneArrays
    wide: WideKernel | None  # None for the narrow kernel
    narrow: str  # the identity of the narrow kernel


class Kernels:
    """The kernels for scenes in one precision and with one depth of reflection.

    The narrow kernel of a scene has code for the scene's kinds of shapes and features alone. Where it is missing a wide
    kernel draws the same picture, and the narrow one is compiled in the background once that is worth its time.
    """

    def __init__(self, precision: str, depth: int) -> None:
        self.precision = precision
        self.depth = depth
        self.narrow_after = NARROW_AFTER
        self.wants_wide = True
        self.narrow_kernels: dict[frozenset[Hashable], list[str]] = {}  # their identities, for each set of features
        self.wide_seconds: dict[str, float] = {}  # of rendering with a wide kernel, by the identity of the narrow one
        self.start_anew()

    def start_anew(self) -> None:
        """Forget compiling processes."""
        self.compile_process, self.packing_process = CompileProcess(), CompileProcess()
        self.background = BackgroundCompiler()

    def after_fork(self) -> None:
        """In a child process: leave the compiling processes, if there are any, to the parent."""
        self.start_anew()

    def choose(self, frame: Frame) -> Choice:
        """Return the narrowest kernel that is there for a frame; where there is none the narrow one is compiled."""
        call = functions.frame.call(*frame)
        narrow = LIBRARY.identity(call)
        entry = LIBRARY.find(narrow)
        if entry:
            return Choice(entry, frame.scene, None, narrow)
        for wide in fitting(frame.scene):
            entry = LIBRARY.find(wide_identity(wide))
            if entry:
                return Choice(entry, widened(frame.scene, wide), wide, narrow)
        return Choice(LIBRARY.get(call), frame.scene, None, narrow)

    def count(self, choice: Choice, seconds: float) -> None:
        """Count the time of rendering with a kernel; where a wide one took long have the narrow one compiled."""
        if choice.wide:
            if len(self.wide_seconds) >= REMEMBERED:
                self.wide_seconds.clear()
            total = self.wide_seconds[choice.narrow] = self.wide_seconds.get(choice.narrow, 0.0) + seconds
            if total >= self.narrow_after:
                self.background.compile(choice.narrow)
        elif self.wants_wide and not self.narrow_after:
            self.compile_wide()

    def compile_wide(self) -> None:
        """Compile the wide kernels that are missing, in the background, so that edits need not wait for narrow ones."""
        self.wants_wide = False
        self.background.compile_later([each for each in self.for_all_scenes if not LIBRARY.has(each)])

    @property
    def is_wide_kernel_there(self) -> bool:
        """Whether a kernel that was compiled ahead of time can draw all scenes of this precision."""
        return LIBRARY.has(self.for_all_scenes[-1])

    def is_ready(self, scene: Scene) -> bool:
        """Whether there are kernels that can draw a scene; a scene without shapes needs none."""
        return (
            not scene.shapes or all(map(LIBRARY.has, self.for_all_scenes)) or all(map(LIBRARY.has, self.narrow(scene)))
        )

    def make_ready(self, scene: Scene) -> None:
        """Compile the narrow kernels for a scene where no kernel can draw it. RenderError where compiling fails."""
        if not self.is_ready(scene):
            self.compile(scene)

    @cached_property
    def for_all_scenes(self) -> list[str]:
        """The identities of kernels that are enough for all scenes, some of which single precision cannot draw."""
        wide = [each for each in WIDE_KERNELS if each.name == "full" and each.precision in ("double", self.precision)]
        return [*map(LIBRARY.identity, packing_calls()), *map(wide_identity, wide)]

    def narrow(self, scene: Scene) -> list[str]:
        """Return the identities of the narrow kernels for a scene."""
        features = kernel_features(scene)
        if features not in self.narrow_kernels:
            calls = calls_for(scene, self.precision, self.depth)
            if len(self.narrow_kernels) >= REMEMBERED:
                self.narrow_kernels.clear()
            self.narrow_kernels[features] = list(map(LIBRARY.identity, calls))
        return self.narrow_kernels[features]

    def compile(self, scene: Scene) -> None:
        """Compile those narrow kernels for a scene that are missing, in two processes. RenderError where that fails."""
        if not scene.shapes:
            return
        *packing, drawing = self.narrow(scene)
        with ThreadPoolExecutor(1) as pool:
            first = pool.submit(LIBRARY.compile, packing, self.packing_process)
            LIBRARY.compile([drawing], self.compile_process)
            first.result()

    def stop(self) -> None:
        """Stop compiling; callable from any thread."""
        self.compile_process.stop()
        self.packing_process.stop()
        self.background.stop()


@cache
def wide_identity(wide: WideKernel) -> str:
    """Return the identity of a wide kernel."""
    return LIBRARY.identity(wide_call(wide))
