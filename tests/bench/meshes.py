"""Benchmark scenes of one mesh, the same at each run: a wavy ball that fills half of the picture."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from pathlib import Path

from tests.bench.scenes import write

COUNTS = (1_000, 10_000, 100_000, 1_000_000)
COMPARED = 100_000  # triangles

SCENE = """\
A 0.2 255,255,255
C 0,2,-14 0,-0.1,1 60
L -40,30,-30 0.7 255,255,255
pl 0,-6,0 0,1,0 200,200,200
ob {}.obj 0,0,0 5 200,140,90
"""


def grid(count: int) -> tuple[int, int]:
    """Return how many rings of points, and points per ring, give about `count` triangles: two per point, except at both
    poles."""
    rings = max(2, round((count / 4) ** 0.5))
    return rings, 2 * rings


def ball(count: int) -> Iterator[str]:
    """Yield the lines of a closed .obj mesh of about `count` triangles, in quads except at its poles."""
    rings, around = grid(count)
    yield "v 0 1 0\n"
    for ring in range(1, rings + 1):
        down = pi * ring / (rings + 1)
        for step in range(around):
            turn = 2 * pi * step / around
            radius = 1 + 0.06 * sin(9 * down) * sin(11 * turn)
            x, y, z = radius * sin(down) * cos(turn), radius * cos(down), radius * sin(down) * sin(turn)
            yield f"v {x:.7g} {y:.7g} {z:.7g}\n"
    yield "v 0 -1 0\n"
    last = 2 + rings * around
    for step in range(around):
        here, beside = 2 + step, 2 + (step + 1) % around
        yield f"f 1 {beside} {here}\n"
        for ring in range(rings - 1):
            above, below = ring * around, (ring + 1) * around
            yield f"f {above + here} {above + beside} {below + beside} {below + here}\n"
        yield f"f {last} {last - around + step} {last - around + (step + 1) % around}\n"


def compared(folder: Path) -> Path:
    """Write the scene of a mesh on which the systems are compared; return its file."""
    waves(folder, COMPARED)
    return write(folder / "mesh.rt", iter([SCENE.format(f"meshes/{COMPARED}")]))


def waves(folder: Path, count: int) -> Path:
    """Write the scene of a mesh of about `count` triangles; return its file."""
    write(folder / "meshes" / f"{count}.obj", ball(count))
    return write(folder / "meshes" / f"{count}.rt", iter([SCENE.format(count)]))
