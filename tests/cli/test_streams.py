"""Whatever the standard streams are, the program gives its output or one error, and never a traceback."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.cli.program import PROGRAM, SCENE, Result, environment
from tests.processes import run

FULL = Path("/dev/full")
ASKED = {  # what goes to standard output
    "picture": ("ball.rt", "-o", "-", "--size", "8x8"),
    "check": ("ball.rt", "--check"),
    "version": ("--version",),
    "help": ("--help",),
    "keys": ("--list-keys",),
    "completion": ("--completion", "bash"),
}
CANNOT_WRITE = "Error\nstandard output: cannot write: "


pytestmark = pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")


def program(folder: Path, redirections: str, *arguments: str, command: Sequence[str] = PROGRAM, **more: str) -> Result:
    """Run the program in a folder with redirections of a shell, and with `more` environment variables.

    Standard error has no traceback, whatever becomes of standard output.
    """
    shell = ["sh", "-c", f'exec "$@" {redirections}', "sh", *command, *arguments]
    ended = run(shell, cwd=folder, env=environment() | more, stdin=subprocess.DEVNULL)
    result = Result(ended.returncode, ended.stdout, ended.stderr.decode())
    assert not has_traces(result)
    return result


def has_traces(result: Result) -> bool:
    """Whether the output shows errors that only a programmer understands."""
    return any(each in result.err + result.out.decode("latin-1") for each in ("Traceback", "Exception ignored"))


def test_the_check_notices_a_traceback(folder: Path) -> None:
    for code in ("print('x')", "import sys; sys.stdout.write('x')"):  # the second fails at the end of Python
        with pytest.raises(AssertionError):
            program(folder, ">/dev/full", "-c", code, command=PROGRAM[:1], PYTHONUNBUFFERED="")


@pytest.mark.parametrize("buffering", ["", "1"])
@pytest.mark.parametrize("what", ASKED)
def test_a_full_standard_output_is_an_error(folder: Path, what: str, buffering: str) -> None:
    ended = program(folder, ">/dev/full", *ASKED[what], PYTHONUNBUFFERED=buffering)
    assert (ended.status, ended.err) == (1, CANNOT_WRITE + "No space left on device\n")


@pytest.mark.parametrize("what", ASKED)
def test_a_closed_standard_output_is_an_error(folder: Path, what: str) -> None:
    ended = program(folder, ">&-", *ASKED[what])
    assert (ended.status, ended.err) == (1, CANNOT_WRITE + "Bad file descriptor\n")


@pytest.mark.parametrize("error", ["2>/dev/full", "2>&-"])
def test_without_standard_error_the_picture_is_written_and_standard_output_is_clean(folder: Path, error: str) -> None:
    ended = program(folder, error, *ASKED["picture"], "-v")
    assert (ended.status, ended.err) == (0, "")
    assert ended.out.startswith(b"\x89PNG")
    ended = program(folder, error, "missing.rt", "--check")
    assert ended == (1, b"", "")
    ended = program(folder, error, "--nonsense")
    assert ended == (2, b"", "")


def test_all_streams_may_be_closed(folder: Path) -> None:
    assert program(folder, "<&- >&- 2>&-", "ball.rt", "-o", "x.png", "--size", "8x8") == (0, b"", "")
    assert (folder / "x.png").read_bytes().startswith(b"\x89PNG")
    assert program(folder, "<&- >&- 2>&-", "ball.rt", "--turntable", "2", "-o", "x.gif", "--size", "8x8").status == 0


@pytest.mark.parametrize("name", ["é", "\udcff"], ids=ascii)  # the second is no UTF-8
def test_names_may_have_characters_that_the_terminal_lacks(folder: Path, name: str) -> None:
    inside = folder / name
    inside.mkdir()
    (inside / "ball.rt").write_text(SCENE)
    (inside / "bad.rt").write_text(SCENE + "sp 0,0,0 -2 é\n", encoding="utf-8")
    for encoding in ("ascii", "utf-8"):
        settings = {"PYTHONIOENCODING": encoding, "LC_ALL": "C.UTF-8"}
        ended = program(folder, "", f"{name}/ball.rt", "--check", **settings)
        assert (ended.status, ended.err) == (0, "")
        assert ended.out.endswith(b"ball.rt: no errors, 2 shapes, 1 light\n")
        ended = program(folder, "", f"{name}/bad.rt", "--check", **settings)
        assert (ended.status, ended.out) == (1, b"")
        assert ended.err.startswith("Error\n")
        arguments = f"{name}/ball.rt", "--fallback", f"{name}/x.png", "--size", "8x8"
        ended = program(folder, "", *arguments, **settings)
        assert (ended.status, ended.err) == (0, "")
        os.remove(f"{name}/x.png")  # noqa: PTH107
