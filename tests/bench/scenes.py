"""Benchmark scenes of many spheres, of many lamps, and of one mesh (a wavy ball), the same at each run.

`tenthousand` fills a box with small balls. `growth` keeps the picture equally full for any count: all spheres are in
view, and their radius goes with 1 / sqrt(count), so that they would cover the picture once if none overlapped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos, pi, radians, sin, sqrt, tan
from pathlib import Path
from random import Random

HERE = Path(__file__).parent
TRIANGLES = {"mesh": 100_000, "mesh-1M": 1_000_000}  # of the meshes on which all systems are compared
MESHES = {"mesh-10k": 10_000}
COUNTS = (10, 100, 1_000, 10_000, 100_000, 1_000_000)

FOV, ASPECT = 70.0, 16 / 9
WIDE = tan(radians(FOV) / 2)  # half the width of the picture at distance 1
HIGH = WIDE / ASPECT
NEAREST, FARTHEST = 50.0, 150.0  # depth of the centres

TEN_THOUSAND = """\
A 0.2 255,255,255
C -50,40,0 1,-0.15,0 70
L -60,90,40 0.7 255,255,255
pl 0,-10,0 0,1,0 200,200,200
"""
GROWTH = """\
A 0.2 255,255,255
C 0,0,0 0,0,1 70
L -60,120,-20 0.7 255,255,255
pl 0,-80,0 0,1,0 200,200,200
"""
STAGE = """\
A 0.2 255,255,255
C 0,7,-11 0,-0.4,1 60
L -20,30,-20 0.7 255,255,255
pl 0,0,0 0,1,0 200,200,200
"""


def sphere(random: Random, centre: tuple[float, float, float], diameter: float, material: str = "") -> str:
    """Return the line of a sphere of a random light colour."""
    red, green, blue = (60 + int(random.random() * 196) for _ in range(3))
    x, y, z = centre
    return f"sp {x:.5g},{y:.5g},{z:.5g} {diameter:.5g} {red},{green},{blue}{material}\n"


def tenthousand(material: str = "") -> Iterator[str]:
    """Yield the lines of a scene of 10,000 spheres in a box of 100 x 60 x 100, with diameters from 1 to 2."""
    random = Random(42)
    yield TEN_THOUSAND
    for _ in range(10_000):
        centre = random.random() * 100, random.random() * 60, random.random() * 100 - 50
        yield sphere(random, centre, 1 + random.random(), material)


def glass() -> Iterator[str]:
    """Yield the lines of a scene of 49 balls of glass above a floor, in 7 rows."""
    random = Random(49)
    yield STAGE
    for number in range(49):
        yield sphere(random, (number % 7 * 2.2 - 6.6, 1.0, number // 7 * 2.2), 2.0, " glass:1.5,0.9")


def lights() -> Iterator[str]:
    """Yield the lines of a scene of 100 lamps above 100 balls."""
    random = Random(100)
    yield STAGE.replace("L ", "# L ")
    for number in range(100):
        x, z = number % 10 * 1.6 - 7.2, number // 10 * 1.6
        yield f"{'Ll'[number > 0]} {x + 0.7:.5g},{3 + random.random():.5g},{z + 0.7:.5g} 0.01 255,240,220\n"
        yield sphere(random, (x, 0.6, z), 1.2)


def radius(count: int) -> float:
    """Return the radius of `count` spheres whose discs together are as large as the picture, at their mean depth."""
    mean_inverse_square = 3 * (FARTHEST - NEAREST) / (FARTHEST**3 - NEAREST**3)  # of the depth
    return sqrt(4 * WIDE * HIGH / (count * pi * mean_inverse_square))


def growth(count: int) -> Iterator[str]:
    """Yield the lines of a scene of `count` spheres whose centres fill the camera's frustum evenly."""
    random = Random(count)
    yield GROWTH
    for _ in range(count):
        z = (NEAREST**3 + random.random() * (FARTHEST**3 - NEAREST**3)) ** (1 / 3)
        x, y = ((2 * random.random() - 1) * half * z for half in (WIDE, HIGH))
        yield sphere(random, (x, y, z), 2 * radius(count))


def write(path: Path, lines: Iterator[str]) -> Path:
    """Write a scene unless its file exists."""
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".part")
        with unfinished.open("w", encoding="ascii") as file:
            file.writelines(lines)
        unfinished.rename(path)
    return path


def compared(folder: Path, meshes: Mapping[str, int] = TRIANGLES) -> list[Path]:
    """Return the scenes on which all systems are compared; generated ones are written into the folder."""
    many = write(folder / "tenthousand.rt", tenthousand())
    return [HERE / "one.rt", HERE / "fifty.rt", many, *(waves(folder, count, name) for name, count in meshes.items())]


def harder(folder: Path, meshes: Mapping[str, int] = MESHES) -> list[Path]:
    """Return scenes of meshes of so many triangles, of mirrors, glass and many lights, written into the folder."""
    made = {"mirrors": tenthousand(" mirror:0.5"), "glass": glass(), "lights": lights()}
    written = [waves(folder, count, name) for name, count in meshes.items()]
    return written + [write(folder / f"{name}.rt", lines) for name, lines in made.items()]


def grown(folder: Path, count: int) -> Path:
    """Write a scene of the growth curve; return its file."""
    return write(folder / "growth" / f"{count}.rt", growth(count))


MESH = """\
A 0.2 255,255,255
C 0,2,-14 0,-0.1,1 60
L -40,30,-30 0.7 255,255,255
pl 0,-6,0 0,1,0 200,200,200
ob {name}.obj 0,0,0 5 200,140,90
"""


def ball(count: int) -> Iterator[str]:
    """Yield the lines of a closed .obj mesh of about `count` triangles, in quads except at its poles."""
    rings = round((count / 4) ** 0.5)  # two triangles per point, except at both poles
    around = 2 * rings
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


def waves(folder: Path, count: int, name: str = "mesh") -> Path:
    """Write the scene of a mesh of about `count` triangles; return its file."""
    write(folder / f"{name}.obj", ball(count))
    return write(folder / f"{name}.rt", iter([MESH.format(name=name)]))
