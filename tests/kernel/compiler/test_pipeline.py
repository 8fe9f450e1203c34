"""Compiler of kernels: its flags, its lean pipeline, and numba's own where a private interface is missing."""

from __future__ import annotations

import hashlib
import os
import sys
import tomllib
from pathlib import Path

import numba
import numpy as np
import pytest

from minirt.kernel.compiler import pipeline
from minirt.rendering import Renderer
from minirt.scene import parse
from tests.paths import ROOT
from tests.processes import run

BALL = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\nsp 0,0,0 2 255,60,60\n"
CHANGE = "from numba.core.codegen import CodeLibrary; del CodeLibrary._get_compiled_object"
COMPILE = f"{CHANGE}; from minirt.kernel.compiler import main; main()"
RENDER = f"""
import sys
from pathlib import Path
from minirt.kernel.machine_code import cache, compile_process
from tests.kernel.compiler.test_pipeline import fingerprints

cache.SHIPPED = Path("none")
compile_process.COMMAND = sys.executable, "-c", {COMPILE!r}
print(*fingerprints())
"""


def test_the_flags_let_kernels_divide_as_ieee_754_says_and_keep_nan() -> None:
    assert pipeline.FLAGS["error_model"] == "numpy"
    assert pipeline.FLAGS["fastmath"] == {"contract"}
    # Inlined functions are compiled with the flags of their caller.
    assert not {"error_model", "fastmath"} & set(pipeline.INLINED)


def test_the_lean_pipeline_is_used_with_all_versions_that_the_project_allows() -> None:
    dependencies = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert pipeline.TESTED in dependencies
    limit = pipeline.TESTED.rpartition("<")[2]
    is_tested = tuple(map(int, numba.__version__.split(".")[:2])) < tuple(map(int, limit.split(".")))
    assert not is_tested or not pipeline.FAILED


def fingerprints() -> list[str]:
    """Return hashes of a picture and of its light."""
    scene, renderer = parse(BALL).scene, Renderer(threads=1)
    pixels, light = np.zeros((60, 80, 4), np.uint8), np.zeros((60, 80, 3))
    renderer.prepare(scene)
    renderer.render(scene, pixels, samples=2, linear=light)
    return [hashlib.sha256(each.tobytes()).hexdigest() for each in (pixels, light)]


def test_numbas_own_pipeline_draws_the_same_bits_with_a_notice(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    ended = run([sys.executable, "-c", RENDER], env=environment, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.split() == fingerprints()
    (notice,) = ended.stderr.splitlines()
    assert notice.startswith("notice: kernels take twice as long to compile")
    assert "_get_compiled_object" in notice


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ("import numba.core.codegen; del numba.core.codegen.JITCodeLibrary", "cannot import name 'JITCodeLibrary'"),
        ("import numba, sys; sys.modules['numba._dynfunc'] = None; del numba._dynfunc", "_dynfunc"),
        ("from numba.core.base import BaseContext; del BaseContext.insert_user_function", "insert_user_function"),
        (
            "from numba.core.codegen import CPUCodeLibrary; del CPUCodeLibrary._get_module_for_linking",
            "module_for_linking",
        ),
        ("from numba.core.compiler import Flags; del Flags.no_compile", "no_compile"),
    ],
)
def test_an_interface_that_is_gone_is_told_by_its_name(change: str, reason: str) -> None:
    program = run([sys.executable, "-c", f"{change}; import minirt.kernel.compiler.pipeline"], text=True)
    assert program.returncode == 0, program.stderr
    (notice,) = program.stderr.splitlines()
    assert reason in notice
