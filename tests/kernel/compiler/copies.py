"""Copies of the package, which tests may edit, with a kernel that is compiled in a tenth of the time."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.paths import PACKAGE

FRAME = """
from minirt.kernel.shading.shade import coloured

def frame(
    next_row: Any, pixels: Any, linear: Any, rays: Any, wanted: Any, memory: Any, sums: Any, scene: Traced
) -> None:
    light = coloured(Vec(scene.ambient[0], scene.ambient[1], scene.ambient[2]), Vec(10.0, 20.0, 30.0))
    for y in range(pixels.shape[0]):
        for x in range(pixels.shape[1]):
            pixels[y, x] = colour(light.x, light.y, light.z)
"""
LISTS = """
def project_all(
    origin: Any, grid: Grid, balls: Any, slack: float, first: Any, places: Any, rectangles: Any, used: int, views: Any,
    counts: Any,
) -> int:
    return 0
"""


def copied(folder: Path) -> Path:
    """A copy of the package in a folder. Its pictures show nothing but the ambient light on the colour 10,20,30."""
    package = folder / "minirt"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__", "viewer", "mlx"))
    for name, function, short in (("frame", "frame", FRAME), ("culling/binning", "project_all", LISTS)):
        file = package / "kernel" / f"{name}.py"
        replace(file, f"def {function}(", f"def long_{function}(")
        file.write_text(file.read_text() + short)
    return package


def replace(path: Path, old: str, new: str) -> None:
    """Replace what is once in a file."""
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))
