"""The facade of the renderer: arguments, pictures without shapes or pixels, several threads."""

from __future__ import annotations

import sys
from pathlib import Path
from random import Random

import pytest

from minirt.formats.table import FORMATS, memory_of
from minirt.rendering.notes import kernel_notes
from minirt.rendering.packing.features import WORDS
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import ALL_KINDS, Plane, Sphere
from tests.cli.program import SCENE, environment
from tests.processes import run
from tests.seeds import seed_of

# The notes of a packing describe its decisions for a scene.


GREY = (128, 128, 128)
CAMERA = Camera((0, 0, -9), (0, 0, 1), 60)


def notes_of(*balls: Sphere) -> list[str]:
    lights = Light((0, 5, 0), 1), FurtherLight((0, 5, 0), 0), FurtherLight((0, -5, 0), 1)
    black = FurtherLight((0, 0, 9), 1, (0, 0, 0))
    planes = Plane((0, -9, 0), (0, 1, 0), GREY), Plane((0, -1, 0), (0, -1, 0), GREY)
    scene = Scene((Ambient(0.1, GREY), Camera((0, 0, -9), (0, 0, 1), 60), *lights, black, *planes, *balls))
    packing = Packing()
    assert packing.notes == []
    packing.pack(scene, 64, 48)
    return packing.notes


def test_kinds_and_features_that_a_kernel_lacks_are_named() -> None:
    scene = Scene((CAMERA, Sphere((0, 0, 0), 1, GREY), Plane((0, -9, 0), (0, 1, 0), GREY)))
    kernel, without, plain = kernel_notes(scene, generic=None, compiling=True)
    others = [kind.element.plural for kind in ALL_KINDS if kind.element not in (Sphere, Plane)]
    assert (kernel, without) == ("kernel for spheres, planes", f"kernel without {', '.join(others)}")
    assert plain == f"kernel without {', '.join(WORDS.values())}"


def test_a_generic_kernel_is_named_with_what_it_waits_for() -> None:
    scene = Scene((CAMERA, Sphere((0, 0, 0), 1, GREY)))
    for generic in GENERIC_KERNELS:
        features = "all" if generic.name == "full" else "no"
        note = f"generic kernel for all kinds of shapes and {features} features"
        assert list(kernel_notes(scene, generic, compiling=False)) == [note]
        assert list(kernel_notes(scene, generic, compiling=True)) == [
            note,
            "the kernel for spheres alone is being compiled",
        ]


def test_shapes_and_lights_that_are_left_out_are_named_with_the_reason() -> None:
    tiles, buffer, *rest = notes_of(Sphere((0, 0, 0), 1, GREY))
    assert tiles.startswith("tiles: 12, ")
    assert buffer == "light buffer: none, every shape is tried (3 shapes)"
    assert rest == [
        "plane 1 hides nothing from light 1",
        "plane 2 hides nothing from light 1",
        "light 2 has brightness 0",
        "plane 1 hides nothing from light 3",
        "light 4 is black",
    ]


def test_a_fallback_to_double_precision_is_noted() -> None:
    packing = Packing(precision="single")
    for mirror in (None, 0.5):
        packing.pack(Scene((Camera((0, 0, -9), (0, 0, 1), 60), Sphere((0, 0, 0), 1, GREY, mirror=mirror))), 64, 48)
        assert packing.computed_in.startswith("double" if mirror else "single")


def test_the_size_of_the_light_buffer_is_noted() -> None:
    *_, buffer, _, _, _, _, _ = notes_of(*(Sphere((i, 0, 0), 1, GREY) for i in range(48)))
    assert buffer == "light buffer: 6 x 32 x 32 cells per light (50 shapes)"


# Memory that a picture takes, measured in a process of its own.


STATUS = Path("/proc/self/status")
ON_LINUX = pytest.mark.skipif(not STATUS.exists(), reason="Linux tells the peak of a process's own memory")

SIDE = 2500  # pixels
MOST = 12  # bytes a pixel of a plain picture: four of the frame buffer, three each of levels and file, and other memory
PLAIN = ["png", "jpg", "tif", "bmp", "ppm", "tga", "pcx"]
CHANCE = Random(seed_of("memory"))
OTHER = 2.5  # bytes a pixel of this size, of other memory
PEAK = """
import sys
from minirt import cli

def peak():  # that of the resource module would include the parent's
    return next(int(line.split()[1]) * 1024 for line in open("/proc/self/status") if line.startswith("VmHWM"))

for size in ("64x64", "{side}x{side}"):
    before = peak()
    assert cli.main(["ball.rt", "-o", *sys.argv[1:], "--size", size]) == 0
print((peak() - before) / {side}**2)
"""


def taken_by(folder: Path, *arguments: str) -> float:
    """Return the bytes a pixel that a picture takes while it is rendered and written to a file."""
    (folder / "ball.rt").write_text(SCENE)
    code = PEAK.replace("{side}", str(SIDE))
    done = run([sys.executable, "-c", code, *arguments], cwd=folder, env=environment(), text=True)
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


@ON_LINUX
@pytest.mark.parametrize("suffix", CHANCE.sample(PLAIN, 2))  # others each run
def test_a_picture_takes_little_more_than_its_frame_buffer(suffix: str, tmp_path: Path) -> None:
    assert 3.5 < taken_by(tmp_path, f"a.{suffix}") < MOST


@ON_LINUX
def test_the_table_of_formats_says_how_little_plain_pictures_take() -> None:
    assert {memory_of(name, None) for name, each in FORMATS.items() if each.suffixes[0][1:] in PLAIN} == {MOST}


@ON_LINUX
def test_a_picture_in_bands_takes_little_more_than_its_frame_buffer(tmp_path: Path) -> None:
    assert 3.5 < taken_by(tmp_path, "a.jpg", "--samples", "4") < MOST  # so much work is kept in a journal


@ON_LINUX
@pytest.mark.parametrize(
    "arguments", CHANCE.sample([["a.qoi"], ["a.sgi"], ["a.hdr"], ["a.png", "--bits", "16"]], 2), ids=" ".join
)
def test_pictures_take_what_the_table_of_formats_says(arguments: list[str], tmp_path: Path) -> None:
    name = next(name for name, each in FORMATS.items() if arguments[0][1:] in each.suffixes)
    told = memory_of(name, 16 if "--bits" in arguments else None)
    taken = taken_by(tmp_path, *arguments)
    assert taken < told + OTHER
    assert told / 2 < taken  # twice the memory in the table would be found
