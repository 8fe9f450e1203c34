"""Kernels of one renderer: chooses the one that draws a frame, and has narrow ones compiled."""

from __future__ import annotations

from collections.abc import Hashable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property
from typing import NamedTuple

from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.library import LIBRARY, REMEMBERED
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering.frame_arguments import Frame
from minirt.rendering.packing.widening import WIDE_KERNELS, WideKernel, fitting, widened
from minirt.rendering.running.background_compiler import BackgroundCompiler
from minirt.rendering.running.kernel_features import kernel_features
from minirt.rendering.running.needed_kernels import calls_for, packing_calls, wide_call
from minirt.scene import Scene

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
