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
CHANGE = "from numba.core.ccallback import CFunc; CFunc.inspect_llvm = lambda f, inspect=CFunc.inspect_llvm: inspect(f)"
COMPILE = f"{CHANGE}; from minirt.kernel.compiler.process import main; main()"
RENDER = f"""
import sys
from pathlib import Path
from minirt.kernel.machine_code import compile_process, shipped_code
from tests.kernel.compiler.test_documented_pipeline import fingerprints

shipped_code.FOLDER = Path("none")
compile_process.COMMAND = sys.executable, "-c", {COMPILE!r}
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


def rendered(cache: Path, program: str) -> tuple[list[str], str]:
    """Return what a program prints that keeps its kernels in a folder: hashes, and its notices."""
    ended = run([sys.executable, "-c", program], env=os.environ | {"XDG_CACHE_HOME": str(cache)}, text=True)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.split(), ended.stderr


def test_pictures_and_rays_are_the_same_bit_by_bit_and_kernels_are_kept(tmp_path: Path) -> None:
    printed, told = rendered(tmp_path, RENDER)
    assert printed == fingerprints()
    (notice,) = told.splitlines()
    assert notice.startswith("notice: kernels take twice as long to compile")
    assert "(object code)" in notice
    without_a_compiler = RENDER.replace(repr(COMPILE), repr("raise SystemExit('not kept')"))
    assert rendered(tmp_path, without_a_compiler) == (printed, "")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ("import numba.core.codegen; del numba.core.codegen.JITCodeLibrary", "cannot import name 'JITCodeLibrary'"),
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
