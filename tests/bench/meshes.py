"""Scenes of one mesh, the same at each run: a ball with waves on it, whose triangles fill half of the picture."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from pathlib import Path

from tests.bench.scenes import write

COUNTS = (1_000, 10_000, 100_000, 1_000_000)

SCENE = """\
A 0.2 255,255,255
C 0,2,-14 0,-0.1,1 60
L -40,30,-30 0.7 255,255,255
pl 0,-6,0 0,1,0 200,200,200
ob {}.obj 0,0,0 5 200,140,90
"""


def grid(count: int) -> tuple[int, int]:
    """How many rings of points, and how many points in each, make about so many triangles: two for each but the first
    and the last."""
    rings = max(2, round((count / 4) ** 0.5))
    return rings, 2 * rings


def ball(count: int) -> Iterator[str]:
    """The lines of a closed mesh of about so many triangles, in squares but for its two ends."""
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


def waves(folder: Path, count: int) -> Path:
    """The file of a scene of a mesh of about so many triangles."""
    write(folder / "meshes" / f"{count}.obj", ball(count))
    return write(folder / "meshes" / f"{count}.rt", iter([SCENE.format(count)]))
