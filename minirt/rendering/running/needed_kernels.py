"""Finds out which kernels a scene needs, without rendering it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from minirt.kernel import interpreted
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.packing.widening import WideKernel, empty_arrays
from minirt.rendering.running.kernel_features import minimal_scene
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

PIXEL = np.zeros((1, 1, 4), np.uint8)


def calls_for(scene: Scene, precision: str, depth: int) -> list[Call]:
    """Return calls of the kernels for a scene: of those that pack it, and of the narrow one that draws it."""
    recorder = CallRecorder()
    with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
        arrays = Packing(recorder, precision, depth).pack(minimal_scene(scene), 1, 1)
    return [*recorder.calls.values(), functions.frame.call(*frame_arguments(arrays, PIXEL))]


def wide_call(wide: WideKernel) -> Call:
    """Return a call of a wide kernel."""
    return functions.frame.call(*frame_arguments(empty_arrays(wide), PIXEL))


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
