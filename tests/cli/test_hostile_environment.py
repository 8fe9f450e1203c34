"""Whatever the environment and the limits of the process are, the picture is right, with one notice at most."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.cli.program import PROGRAM, Result, environment, program
from tests.processes import run

ARGUMENTS = ("ball.rt", "--size", "16x16", "-o")
TEXTURED = "A 0.2 255,255,255\nC 0,0,-5 0,0,1 70\nL -4,3,-3 0.7 255,255,255\nsp 0,0,0 2 10,0,255 texture:x.ppm\n"
ENVIRONMENTS: dict[str, dict[str, str | None]] = {
    "no home": {"HOME": None, "XDG_CACHE_HOME": None},
    "a home that is not there": {"HOME": "/dev/null/home", "XDG_CACHE_HOME": None},
    "an empty cache": {"XDG_CACHE_HOME": ""},
    "a relative cache": {"XDG_CACHE_HOME": "relative"},
    "a file as cache": {"XDG_CACHE_HOME": "/dev/null"},
    "control characters in the cache": {"XDG_CACHE_HOME": "/dev/null/line\nbreak\x1b[31m"},
    "no temporary folder": {"TMPDIR": "/dev/null/tmp"},
}
FEW_FILES = """
import os, resource, sys
resource.setrlimit(resource.RLIMIT_NOFILE, (16, 16))
os.execv(sys.argv[1], sys.argv[1:])
"""

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="another environment and other limits")


@pytest.fixture
def wanted(folder: Path) -> bytes:
    """Return the picture as it should be."""
    (folder / "ball.rt").write_text(TEXTURED)
    (folder / "x.ppm").write_bytes(b"P6 2 1 255\n\xff\x00\x00\x00\xff\x00")
    assert program(folder, *ARGUMENTS, "wanted.png") == (0, b"", "")
    return (folder / "wanted.png").read_bytes()


def rendered(folder: Path, changed: dict[str, str | None], command: Sequence[str] = PROGRAM) -> Result:
    """Render into x.png, with another environment; None removes a variable."""
    variables = {name: value for name, value in (environment() | changed).items() if value is not None}
    ended = run([*command, *ARGUMENTS, "x.png"], cwd=folder, env=variables, stdin=subprocess.DEVNULL)
    return Result(ended.returncode, ended.stdout, ended.stderr.decode())


@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_a_hostile_environment_does_not_change_the_picture(folder: Path, wanted: bytes, name: str) -> None:
    ended = rendered(folder, ENVIRONMENTS[name])
    assert (ended.status, ended.out) == (0, b"")
    assert (folder / "x.png").read_bytes() == wanted
    lines = ended.err.splitlines()
    assert len(lines) <= 1
    assert all(line.startswith("notice: ") and line.isprintable() for line in lines)


def test_few_open_files_are_enough(folder: Path, wanted: bytes) -> None:
    limited = [sys.executable, "-c", FEW_FILES, *PROGRAM]
    assert rendered(folder, {}, limited) == (0, b"", "")
    assert (folder / "x.png").read_bytes() == wanted
