"""Compiled forms of the functions that Python calls, under their own names."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from minirt.kernel import binning, bvh_build, bvh_traversal, mesh_triangles, pixels, scene_arrays
from minirt.kernel.frame import frame as interpreted_frame
from minirt.kernel.machine_code.arguments import words_of
from minirt.kernel.machine_code.library import LIBRARY, Call


class CompiledFunction:
    """A function that is loaded or compiled, for the types of its arguments, when it is called."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.name = f"{function.__module__}:{function.__qualname__}"

    def __call__(self, *arguments: Any) -> None:
        """Call the compiled form. RenderError where it cannot be compiled."""
        LIBRARY.get((self.name, arguments))(*arguments)

    def bound(self, *arguments: Any) -> Callable[[], None]:
        """Return the call with some arguments, whose arrays may change but not move. RenderError likewise."""
        entry, words = LIBRARY.get((self.name, arguments)), words_of(arguments)

        def call(kept: Any = arguments) -> None:
            entry.run(words)

        return call

    def call(self, *arguments: Any) -> Call:
        """Return the call with some arguments, to look for its kernel."""
        return self.name, arguments


def bound(function: Callable[..., None], *arguments: Any) -> Callable[[], None]:
    """Return the call of a function, compiled or interpreted, with some arguments; compiled, it takes 2 us."""
    return function.bound(*arguments) if isinstance(function, CompiledFunction) else partial(function, *arguments)


project_shapes, fill_bins = CompiledFunction(binning.project_shapes), CompiledFunction(binning.fill_bins)
move_shape = CompiledFunction(binning.move_shape)
to_single = CompiledFunction(scene_arrays.to_single)
place_triangles = CompiledFunction(mesh_triangles.place_triangles)
divide, collapse = CompiledFunction(bvh_build.divide), CompiledFunction(bvh_build.collapse)
trace_rays = CompiledFunction(bvh_traversal.trace_rays)
frame = CompiledFunction(interpreted_frame)
classify, copy_levels = CompiledFunction(pixels.classify), CompiledFunction(pixels.copy_levels)
