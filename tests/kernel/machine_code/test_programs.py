"""Kernels on disk as programs use them: the next one finds them, and those of other sources are never used.

The programs run a copy of the package with kernels that compile in a tenth of the time.
"""

from __future__ import annotations

import compileall
import os
import shutil
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.paths import PACKAGE
from tests.processes import run

FRAME = """
from minirt.kernel.pixels import argb
from minirt.kernel.shading.shade import tint

def frame(
    next_row: Any, pixels: Any, linear: Any, rays: Any, plan: Any, errors: Any, memory: Any, sums: Any,
    scene: SceneArrays,
) -> None:
    light = tint(Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(10.0, 20.0, 30.0))
    for y in range(pixels.shape[0]):
        for x in range(pixels.shape[1]):
            pixels[y, x] = argb(light.x, light.y, light.z)
"""
STUBS = (  # of functions that these pictures do not need: the file, the name and the parameters
    ("rectangles", "project_shapes", "next_chunk: Any, seen: BinningArrays"),
    ("binning", "move_shape", "shape: int, seen: BinningArrays, starts: Any, members: Any"),
    ("pixels", "classify", "next_row: Any, lines: Any, seen: Any, words: Any, class_of: Any, classes: Any"),
)
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"
RENDER = """
import minirt
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY

compiled = []

def count(process, requests, compile=CompileProcess.compile):
    compiled.extend(requests)
    return compile(process, requests)

CompileProcess.compile = count
scene = minirt.load("ball.rt")
minirt.renderer(None).prepare(scene)  # compiles all kernels in one process
image = minirt.render(scene, 8, 8)
print(LIBRARY.cache and LIBRARY.cache.folder.name, len(LIBRARY.entries) - len(compiled), len(compiled),
      image.array[4, 4].tolist())
"""
FOLDER = "from minirt.kernel.machine_code import cache; print(cache.folder().name)"
KERNELS = "7"  # compiled: that of the frame, four functions that pack it, and those of contrast and of levels
LOADED = "4"  # those but that of contrast and those of a shape that moves and of threads, which a plain picture lacks
PIXEL, EDITED = "[10, 20, 30]", "[10, 40, 30]"


def replace_once(path: Path, old: str, new: str) -> None:
    """Replace a text that occurs once in a file."""
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))


def edit(package: Path) -> None:
    """Let a package draw `EDITED`."""
    replace_once(package / "kernel" / "shading" / "surfaces.py", "light.y * colour.y", "2.0 * light.y * colour.y")


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Folder with a copy of the package. Its pictures show nothing but the ambient light on the colour of the ball."""
    package = tmp_path / "minirt"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__", "ahead_of_time", "viewer", "mlx"))
    stubs = [(file, name, f"\n\ndef {name}({parameters}) -> None:\n    pass\n") for file, name, parameters in STUBS]
    for name, function, stub in (("frame", "frame", FRAME), *stubs):
        file = package / "kernel" / f"{name}.py"
        replace_once(file, f"def {function}(", f"def real_{function}(")
        file.write_text(file.read_text() + stub)
    (tmp_path / "ball.rt").write_text(SCENE)
    return tmp_path


def rendered(
    folder: Path, notice: str = "", cache: str = "cache", program: str = RENDER, package: str = ""
) -> list[str]:
    """Render by the package in a folder, or in a file of it, with kernels in its `cache`. Standard error must begin
    with `notice`.

    Return the name of the folder of kernels, how many kernels were loaded and compiled, and a pixel.
    """
    variables = {"XDG_CACHE_HOME": str(folder / cache), "PYTHONPATH": str(folder / package)}
    variables["PYTHONDONTWRITEBYTECODE"] = "1"
    command = [sys.executable, "-P", "-W", "error", "-c", program]
    ended = run(command, cwd=folder, env=os.environ | variables, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr.startswith(notice)
    assert len(ended.stderr.splitlines()) == bool(notice)
    fields: list[str] = ended.stdout.strip().split(" ", 3)
    return fields


def without_sources(copy: Path, folder: str) -> None:
    """Copy the package as bytecode alone."""
    shutil.copytree(copy / "minirt", copy / folder / "minirt")
    assert compileall.compile_dir(copy / folder, quiet=1, legacy=True)
    for source in (copy / folder).rglob("*.py"):
        source.unlink()


def in_zip_file(copy: Path, file: str) -> None:
    """Copy the package into a zip file."""
    shutil.make_archive(str(copy / file), "zip", copy, "minirt")
    (copy / f"{file}.zip").rename(copy / file)


def modification_times(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


def test_the_next_program_loads_the_kernels_and_edited_sources_compile_them_anew(copy: Path) -> None:
    with ThreadPoolExecutor(3) as pool:  # one of them compiles, and the others wait
        printed = list(pool.map(rendered, [copy] * 3))
    (name,) = {each[0] for each in printed}
    assert {each[3] for each in printed} == {PIXEL}
    assert sum(int(compiled) for _, _, compiled, _ in printed) == int(KERNELS)
    kept = modification_times(copy)
    assert [path.suffix for path in kept if "cache" in path.parts].count(".kernel") == int(KERNELS)
    assert rendered(copy) == [name, LOADED, "0", PIXEL]
    assert modification_times(copy) == kept
    edit(copy / "minirt")
    edited, *counts = rendered(copy)
    assert edited != name
    assert counts == ["0", KERNELS, EDITED]


@pytest.mark.parametrize("pack", [without_sources, in_zip_file])
def test_a_package_without_sources_or_in_a_zip_file_keeps_its_own_kernels(
    copy: Path, pack: Callable[[Path, str], None]
) -> None:
    pack(copy, "first")
    name, *counts = rendered(copy, package="first")
    assert counts == ["0", KERNELS, PIXEL]
    assert rendered(copy, package="first") == [name, LOADED, "0", PIXEL]
    edit(copy / "minirt")
    pack(copy, "second")
    (edited,) = rendered(copy, program=FOLDER, package="second")
    assert edited.startswith("kernels-")
    assert edited != name
