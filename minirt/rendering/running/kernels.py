"""Compiled kernels: which of them are ready, and compiling of those that are not."""

from __future__ import annotations

from collections.abc import Hashable
from functools import cached_property
from typing import Any

import numpy as np

from minirt.kernel.culling import binning
from minirt.rendering.compiler_modules import compiler_module
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.running.compile_process import CompileProcess
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

    @cached_property
    def jit(self) -> Any:
        """The module of the compiled kernels. Importing it imports the compiler."""
        return compiler_module("jit")

    def is_ready(self, scene: Scene) -> bool:
        """Whether the kernel for a scene was used before; a scene without shapes needs none."""
        return not scene.shapes or kernel_features(scene) in self.ready

    def add(self, scene: Scene) -> None:
        """Note that the kernel for a scene is ready."""
        self.ready.add(kernel_features(scene))

    def compile(self, scene: Scene, pixels: np.ndarray) -> None:
        """Compile the kernel for a scene in another process, unless the cache on disk has it.

        Without such a cache do nothing: the first picture compiles. RenderError where compiling fails.
        """
        if scene.shapes and self.jit.CACHE:
            packing = Packing(binning, self.precision, self.depth)
            with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
                arguments = frame_arguments(packing.pack(minimal_scene(scene), 1, 1), pixels)
            if not self.jit.is_compiled(arguments):
                self.compile_process.compile(arguments)
