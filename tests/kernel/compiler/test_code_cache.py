"""Cache of machine code: the files on disk, the memory of kernels, and two processes that write at once."""

from __future__ import annotations

import gc
import pickle
import sys
import threading
import weakref
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import float64, int64
from numba.core.caching import IndexDataCacheFile

from minirt.kernel.compiler import cache_folder, code_cache, jit, numba_internals
from minirt.kernel.compiler.compilation import compiled
from minirt.kernel.compiler.numba_internals import cache_of
from minirt.rendering import Renderer
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse
from tests.waiting import HANG_LIMIT

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
    folder = Path(cache_of(jit.kernel_for(arguments[-1])).cache_path)
    for file in folder.glob("frame.frame*.nbc"):
        (_, kind, (machine_code, names)), *_ = pickle.loads(file.read_bytes())
        assert kind == "object"
        assert len(machine_code) > 10_000
        assert len(names) < 0.2 * len(machine_code)


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


def double(x: Any) -> Any:
    return x + x


@pytest.mark.skipif(sys.platform == "win32", reason="folders cannot be locked there")
def test_two_writers_of_an_index_wait_for_each_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The second writer starts after the first has read the index and before it has written it."""
    doubled = compiled(double, None, (float64,), (int64,))
    with cache_folder.numba_cache(tmp_path):
        caches = [code_cache.CodeCache(double), code_cache.CodeCache(double)]
    jobs = [
        partial(cache.save_overload, signature, doubled.overloads[signature])
        for cache, signature in zip(caches, doubled.signatures, strict=True)
    ]
    events: list[str] = []
    second, second_started = threading.Thread(target=jobs[1], name="second", daemon=True), threading.Event()
    lock, write = cache_folder.fcntl.flock, IndexDataCacheFile._save_index

    def watched_lock(*arguments: Any) -> None:
        if threading.current_thread() is second:
            second_started.set()
        lock(*arguments)

    def watched_write(index: Any, overloads: Any) -> None:
        if threading.current_thread() is second:
            second_started.set()
        else:
            second.start()
            assert second_started.wait(HANG_LIMIT)
        write(index, overloads)
        events.append(threading.current_thread().name)

    monkeypatch.setattr(cache_folder.fcntl, "flock", watched_lock)
    monkeypatch.setattr(IndexDataCacheFile, "_save_index", watched_write)
    jobs[0]()
    second.join(HANG_LIMIT)
    assert events == [threading.current_thread().name, "second"]
    monkeypatch.undo()
    again = compiled(double, tmp_path, (float64,), (int64,))
    assert sum(again.stats.cache_hits.values()) == 2
