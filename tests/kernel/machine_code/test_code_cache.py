"""Cache of machine code: what is in the files on disk, and when the memory of a kernel is freed."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import LIBRARY, Call
from minirt.rendering import Renderer
from minirt.rendering.frame import frame_arguments
from minirt.rendering.scene_packing import Packing
from minirt.scene import parse
from tests.kernel.machine_code.small_kernels import Compiler, call, compiled, double, library

BALL = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\nsp 0,0,0 2 255,60,60\n"


def kernel_call() -> Call:
    """Render a scene and return the call of its kernel."""
    scene, renderer, pixels = parse(BALL).scene, Renderer(threads=1), np.zeros((30, 40, 4), np.uint8)
    renderer.kernels.compile(scene)
    return functions.frame.call(*frame_arguments(Packing().pack(scene, 40, 30), pixels))


@pytest.mark.skipif(LIBRARY.cache is None, reason="kernels cannot be kept here")
def test_files_hold_machine_code_and_hardly_more() -> None:
    identity = LIBRARY.identity(kernel_call())
    assert LIBRARY.cache is not None
    found = LIBRARY.cache.read(identity)
    assert found is not None
    names, machine_code = found
    assert len(machine_code) > 10_000
    assert LIBRARY.cache.file_of(identity).stat().st_size < 1.2 * len(machine_code)
    assert set(names) - {"relocations"} == {"entry", "results"}
    assert names["results"] == 0


def is_freed_with_its_last_reference(kernels: Any) -> bool:
    """Whether the machine code of a kernel lives as long as it may be called, and no longer."""
    entry = compiled(kernels, call(double), Compiler())
    code = weakref.ref(entry.code)
    kernels.entries.clear()
    gc.collect()
    values = np.array([1.5])
    entry(values)
    assert values == [3.0]
    assert code() is not None
    del entry
    gc.collect()
    return code() is None


def test_the_memory_of_a_kernel_is_freed_with_its_last_reference(tmp_path: Path) -> None:
    kernels = library(tmp_path)
    assert is_freed_with_its_last_reference(kernels)
    assert is_freed_with_its_last_reference(kernels), "loaded from disk"


def test_a_library_that_keeps_what_it_should_not_would_be_found_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernels, kept = library(tmp_path), []
    keep = kernels.keep
    monkeypatch.setattr(kernels, "keep", lambda identity, entry: kept.append(entry) or keep(identity, entry))
    assert not is_freed_with_its_last_reference(kernels)
