"""Compiler of kernels: complete code for just its scene, by the lean pipeline or numba's own, with IEEE 754's rules."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import struct
import sys
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite import binding
from numba import njit

from minirt.kernel.compiler import pipeline
from minirt.kernel.compiler.object_code import type_of
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.frame import frame
from minirt.kernel.machine_code.arguments import signature_of
from minirt.kernel.machine_code.cache import ObjectCode
from minirt.kernel.machine_code.library import LIBRARY, load
from minirt.lanes.mathematics import ATAN_HALF, PERIOD
from minirt.materials import Checker, Clouds
from minirt.rendering import Renderer
from minirt.rendering.frame import frame_arguments
from minirt.rendering.needed_kernels import calls_for, ray_query
from minirt.rendering.sampling.contrast import classify_call
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.machine_code.small_kernels import call, object_code_of
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES
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


# Object code refers to nothing outside of itself, and a kernel has no code for what its scene lacks.


SYMBOL = struct.Struct("<IBBHQQ")  # of ELF for 64 bits: name, kind, visibility, section, value, size
ELF = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"), reason="the object code is not ELF"
)


def quotients(x: Any, y: Any) -> None:
    for i in range(len(x)):
        y[i] = x[i] / y[i]


def step(x: Any, n: int) -> None:
    for i in range(0, len(x), n):
        x[i] = 1.0


def sine(x: Any) -> None:
    x[0] = np.sin(x[0])


def undefined_symbols(kernel: ObjectCode) -> set[str]:
    """Return the names that object code refers to and does not define."""
    sections = {each.name(): each.data() for each in binding.ObjectFileRef.from_data(kernel.code).sections()}
    names, found = sections[b".strtab"], set()
    for name, _, _, section, _, _ in SYMBOL.iter_unpack(sections[b".symtab"]):
        if name and not section:
            found.add(names[name : names.index(b"\0", name)].decode())
    return found


def code_of(function: Any, *arguments: Any) -> ObjectCode:
    """Return the object code of a small kernel."""
    name, values = call(function, *arguments)
    return object_code_of(name, json.dumps([signature_of(each) for each in values]))


@ELF
@pytest.mark.skipif(LIBRARY.cache is None, reason="kernels cannot be kept here")
def test_kernels_refer_to_nothing_outside_of_themselves() -> None:
    Renderer(1).kernels.compile(ALL)
    calls = [*calls_for(ALL, "double", 8), classify_call(), ray_query()]
    assert len({name for name, _ in calls}) > 3
    for each in calls:
        LIBRARY.get(each)
        kernel = LIBRARY.code(LIBRARY.identity(each))
        assert kernel
        assert undefined_symbols(kernel) == set(), each[0]
    assert undefined_symbols(code_of(quotients, np.zeros(1), np.zeros(1))) == set()


@ELF
def test_references_to_a_library_and_to_the_compiler_are_found() -> None:
    """To the compiler's for an error, as for a step of 0 of `range`."""
    assert "sin" in undefined_symbols(code_of(sine))
    assert "numba_unpickle" in undefined_symbols(code_of(step, np.zeros(9), 3))


def test_a_kernel_divides_as_ieee_754_says_and_keeps_nan() -> None:
    x = np.array([1.0, -1.0, 0.0, np.nan, 6.0])
    load(code_of(quotients, x, np.zeros(5)))(x, y := np.array([0.0, 0.0, 0.0, 1.0, -3.0]))
    assert np.array_equal(y, [np.inf, -np.inf, np.nan, np.nan, -2.0], equal_nan=True)


SQUARE_ROOT = "call <16 x double> @llvm.sqrt.v16f64"


def scene_of(*kinds: type[Any]) -> Scene:
    """Return a scene with all test shapes of some kinds."""
    return Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, kinds))))


@cache
def code(scene: Scene) -> str:
    """Return the LLVM code of the kernel of a scene, compiled anew: a kernel from the cache shows none."""
    arguments = frame_arguments(Packing().pack(scene, 8, 8), np.zeros((8, 8, 4), np.uint8))
    kernel = njit(**FLAGS)(frame)
    signature = tuple(type_of(signature_of(each)) for each in arguments)
    kernel.compile(signature)
    return str(kernel.inspect_llvm(signature))


def test_only_shapes_that_take_square_roots_add_them() -> None:
    planes, spheres, cylinders = (
        code(scene_of(*kinds)).count(SQUARE_ROOT) for kinds in ((Plane,), (Sphere,), (Sphere, Cylinder))
    )
    assert planes < spheres < cylinders


@pytest.mark.parametrize(
    ("material", "number"), [({"checker": Checker(0.5)}, ATAN_HALF), ({"clouds": Clouds(1.0)}, 1.0 / PERIOD)]
)
def test_texture_coordinates_and_noise_are_computed_where_a_scene_needs_them(
    material: dict[str, Any], number: float
) -> None:
    plain = scene_of(Sphere, Cylinder)
    other = Scene((*plain.elements[:-1], plain.elements[-1].replace(**material)))
    constant = f"0x{np.float64(number).view(np.uint64):X}"
    assert [constant in code(each) for each in (plain, other)] == [False, True]


def test_contraction_is_the_only_fast_math_of_instructions() -> None:
    compiled = code(scene_of(Sphere, Cylinder))
    assert " contract " in compiled
    for forbidden in (" fast ", " nnan ", " ninf ", " nsz ", " arcp ", " reassoc ", " afn "):
        assert forbidden not in compiled
