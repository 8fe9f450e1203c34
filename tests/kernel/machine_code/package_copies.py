"""Copies of the package that tests may edit, with a kernel that compiles in a tenth of the time."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.paths import PACKAGE

FRAME = """
from minirt.kernel.shading.shade import tint
from minirt.kernel.pixels import argb

def frame(
    next_row: Any, pixels: Any, linear: Any, rays: Any, plan: Any, errors: Any, memory: Any, sums: Any,
    scene: SceneArrays,
) -> None:
    light = tint(Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(10.0, 20.0, 30.0))
    for y in range(pixels.shape[0]):
        for x in range(pixels.shape[1]):
            pixels[y, x] = argb(light.x, light.y, light.z)
"""
PROJECT_ALL = """
def project_all(
    origin: Any, grid: Grid, balls: Any, slack: float, first: Any, places: Any, rectangles: Any, used: int, views: Any,
    counts: Any,
) -> int:
    return 0
"""


def copy_package(folder: Path) -> Path:
    """Copy the package into a folder. Its pictures show nothing but the ambient light on the colour 10,20,30."""
    package = folder / "minirt"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__", "ahead_of_time", "viewer", "mlx"))
    for name, function, stub in (("frame", "frame", FRAME), ("binning", "project_all", PROJECT_ALL)):
        file = package / "kernel" / f"{name}.py"
        replace_once(file, f"def {function}(", f"def real_{function}(")
        file.write_text(file.read_text() + stub)
    return package


def replace_once(path: Path, old: str, new: str) -> None:
    """Replace a text that occurs once in a file."""
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))
