"""Compiled kernels: which of them are ready, and compiling of those that are not."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from minirt.kernel import interpreted
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.library import LIBRARY, Call
from minirt.rendering.frame_arguments import Frame, frame_arguments
from minirt.rendering.running.kernel_features import kernel_features, minimal_scene
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene


class Kernels:
    """The kernels that one renderer has used, for scenes in one precision and with one depth of reflection."""

    def __init__(self, precision: str, depth: int) -> None:
        self.precision = precision
        self.depth = depth
        self.ready: set[frozenset[Hashable]] = set()
        self.compile_process = CompileProcess()

    def after_fork(self) -> None:
        """In a child process: leave the compiling process, if there is one, to the parent."""
        self.compile_process = CompileProcess()

    def choose(self, frame: Frame) -> Entry:
        """Return the kernel for a frame, compiled if need be."""
        return LIBRARY.get(functions.frame.call(*frame))

    def is_ready(self, scene: Scene) -> bool:
        """Whether the kernel for a scene was used before; a scene without shapes needs none."""
        return not scene.shapes or kernel_features(scene) in self.ready

    def add(self, scene: Scene) -> None:
        """Note that the kernel for a scene is ready."""
        self.ready.add(kernel_features(scene))

    def compile(self, scene: Scene, pixels: np.ndarray) -> None:
        """Compile the kernels for a scene that are not on disk. RenderError where compiling fails."""
        if scene.shapes:
            LIBRARY.compile(calls_for(scene, pixels, self.precision, self.depth), self.compile_process)


def calls_for(scene: Scene, pixels: np.ndarray, precision: str, depth: int) -> list[Call]:
    """Return calls of the kernels that a scene needs: of those that pack it, and of the one that renders it."""
    recorder = CallRecorder()
    with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
        arrays = Packing(recorder, precision, depth).pack(minimal_scene(scene), 1, 1)
    return [*recorder.calls.values(), functions.frame.call(*frame_arguments(arrays, pixels))]


class CallRecorder:
    """The functions that pack a scene, interpreted; their calls are recorded."""

    def __init__(self) -> None:
        self.calls: dict[str, Call] = {}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        compiled, function = getattr(functions, name), getattr(interpreted, name)

        def run(*arguments: Any) -> Any:
            self.calls[name] = compiled.call(*arguments)
            return function(*arguments)

        return run
