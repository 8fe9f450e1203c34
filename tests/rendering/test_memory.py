"""Memory that a picture takes, measured in a process of its own."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from minirt.formats.table import FORMATS, memory_of
from tests.cli.program import SCENE, environment
from tests.processes import run

STATUS = Path("/proc/self/status")
pytestmark = pytest.mark.skipif(not STATUS.exists(), reason="Linux tells the peak of a process's own memory")

SIDE = 2500  # pixels
MOST = 6  # bytes a pixel of a plain picture: four of the frame buffer, and other memory
PLAIN = ["png", "jpg", "tif", "bmp", "ppm", "tga", "pcx", "qoi"]
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


@pytest.mark.parametrize("suffix", PLAIN)
def test_a_picture_takes_little_more_than_its_frame_buffer(suffix: str, tmp_path: Path) -> None:
    assert 3.5 < taken_by(tmp_path, f"a.{suffix}") < MOST


def test_the_table_of_formats_says_how_little_plain_pictures_take() -> None:
    assert {memory_of(name, None) for name, each in FORMATS.items() if each.suffixes[0][1:] in PLAIN} == {MOST}


def test_a_picture_in_strips_takes_little_more_than_its_frame_buffer(tmp_path: Path) -> None:
    assert 3.5 < taken_by(tmp_path, "a.jpg", "--samples", "4") < MOST  # so much work is kept in a part file


@pytest.mark.parametrize("arguments", [["a.sgi"], ["a.hdr"], ["a.png", "--bits", "16"]], ids=["sgi", "hdr", "deep"])
def test_pictures_take_what_the_table_of_formats_says(arguments: list[str], tmp_path: Path) -> None:
    name = next(name for name, each in FORMATS.items() if arguments[0][1:] in each.suffixes)
    told = memory_of(name, 16 if "--bits" in arguments else None)
    taken = taken_by(tmp_path, *arguments)
    assert taken < told + OTHER
    assert told / 2 < taken  # twice the memory in the table would be found
