"""Cache of machine code: the files on disk, and the memory of kernels."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from numba import typeof

from minirt.kernel.compiler import jit, numba_internals
from minirt.kernel.compiler.numba_internals import cache_of
from minirt.rendering import Renderer
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse

BALL = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\nsp 0,0,0 2 255,60,60\n"
FLOOR = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\npl 0,-1,0 0,1,0 9,9,99\n"

pytestmark = pytest.mark.skipif(jit.CACHE is None, reason="kernels cannot be kept here")


def picture(scene: Scene) -> bytes:
    """Render a scene into the bytes of its pixels."""
    renderer, pixels = Renderer(threads=1), np.zeros((30, 40, 4), np.uint8)
    renderer.prepare(scene)
    renderer.render(scene, pixels)
    return pixels.tobytes()


def kernel(scene: Scene) -> object:
    """Return the kernel for a scene."""
    return jit.kernel_for(Packing().pack(scene, 40, 30))


def test_files_hold_machine_code_and_hardly_more() -> None:
    scene = parse(BALL).scene
    picture(scene)
    arguments = frame_arguments(Packing().pack(scene, 40, 30), np.zeros((30, 40, 4), np.uint8))
    assert jit.is_compiled(arguments)
    dispatcher = jit.kernel_for(arguments[-1])
    cache = cache_of(dispatcher)
    identity = cache.identity(tuple(map(typeof, arguments)), dispatcher.targetctx)
    names, machine_code = cache.read(identity)
    assert len(machine_code) > 10_000
    assert cache.file_of(identity).stat().st_size < 1.2 * len(machine_code)
    assert names["function"] in names["defined"]


def test_the_memory_of_a_kernel_is_freed_with_its_last_reference(monkeypatch: pytest.MonkeyPatch) -> None:
    ball, floor = parse(BALL).scene, parse(FLOOR).scene
    picture(ball)  # objects of the first kernel that stay, such as the binning, are out of the count
    engines = []

    class Codegen(numba_internals.JITCPUCodegen):  # type: ignore[misc]
        def __init__(self, name: str) -> None:
            super().__init__(name)
            engines.append(weakref.ref(self._engine._ee))

    monkeypatch.setattr(numba_internals, "JITCPUCodegen", Codegen)
    jit.kernel_of.cache_clear()
    before = picture(floor)
    assert len(engines) == 1
    gc.collect()
    assert engines[0]() is not None, "as long as it may be called"
    jit.kernel_of.cache_clear()
    gc.collect()
    assert engines[0]() is None
    assert picture(floor) == before
    assert len(engines) == 2


def test_the_kernels_in_memory_are_limited() -> None:
    assert jit.kernel_of.cache_info().maxsize == jit.KERNELS_IN_MEMORY
    first = kernel(parse(BALL).scene)
    assert kernel(parse(BALL).scene) is first
