"""Fallback to numba's documented pipeline: the same pictures bit by bit, and one notice."""

from __future__ import annotations

import hashlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.rendering import Renderer
from minirt.scene import parse
from tests.processes import run

BALL = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\nsp 0,0,0 2 255,60,60\n"
CHANGE = "import numba.core.compiler; del numba.core.compiler.CompileResult._rebuild"
RENDER = """
from minirt.rendering.running.compile_process import CompileProcess
from tests.kernel.compiler.test_documented_pipeline import fingerprints
del CompileProcess.compile
print(*fingerprints())
"""


def fingerprints() -> list[str]:
    """Return hashes of a picture, of its light, and of traced rays."""
    scene, renderer = parse(BALL).scene, Renderer(threads=1)
    pixels, light = np.zeros((60, 80, 4), np.uint8), np.zeros((60, 80, 3))
    renderer.prepare(scene)
    renderer.render(scene, pixels, samples=2, linear=light)
    origins = np.tile((0.0, 0.0, -4.0), (100, 1))
    hits = minirt.trace(scene, origins, np.random.default_rng(1).normal((0, 0, 2), 1, (100, 3)), threads=1)
    assert 0 < np.count_nonzero(hits.owner == 0) < 100
    return [hashlib.sha256(np.ascontiguousarray(each).tobytes()).hexdigest() for each in (pixels, light, *hits)]


def test_pictures_and_rays_are_the_same_bit_by_bit(tmp_path: Path) -> None:
    program = run(
        [sys.executable, "-c", CHANGE + RENDER], env=os.environ | {"XDG_CACHE_HOME": str(tmp_path)}, text=True
    )
    assert program.returncode == 0, program.stderr
    assert program.stdout.split() == fingerprints()
    (notice,) = program.stderr.splitlines()
    assert notice.startswith("notice: every run compiles anew")
    assert "(loading of object code)" in notice
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ("import numba.core.codegen; del numba.core.codegen.JITCPUCodegen", "cannot import name 'JITCPUCodegen'"),
        ("import numba, sys; sys.modules['numba._dynfunc'] = None; del numba._dynfunc", "_dynfunc"),
    ],
)
def test_an_interface_that_is_gone_is_told_by_its_name(change: str, reason: str) -> None:
    show = "from minirt.kernel.compiler.options import FAILED, INLINED; print(INLINED['pipeline_class'].__module__)"
    program = run([sys.executable, "-c", f"{change}; {show}"], text=True)
    assert program.returncode == 0, program.stderr
    assert program.stdout.strip() == "minirt.kernel.compiler.documented_pipeline"
    (notice,) = program.stderr.splitlines()
    assert reason in notice
