"""The program as a process: what it imports, how fast it answers, how it is interrupted."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.program import PROGRAM, environment, program, start

LOADED = "import sys; print(*sorted({each.split('.')[0] for each in sys.modules}), *sorted(sys.modules))"
QUIETLY = "import contextlib, io\nfrom minirt.cli import main\nwith contextlib.redirect_stdout(io.StringIO()):\n"
HEAVY = {"numba", "llvmlite", "pyglet", "PIL", "minirt.mlx", "minirt.viewer"}


def modules(code: str, folder: Path) -> set[str]:
    """What a process has imported after some code."""
    command = [sys.executable, "-c", f"{code}\n{LOADED}"]
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return set(done.stdout.split())


def test_importing_the_library_imports_nothing_heavy(folder: Path) -> None:
    assert not HEAVY & modules("import minirt; minirt.load('ball.rt')", folder)


def test_checking_a_scene_imports_nothing_heavy(folder: Path) -> None:
    assert not HEAVY & modules(QUIETLY + "    assert main(['ball.rt', '--check']) == 0", folder)


def test_rendering_to_a_file_imports_no_window(folder: Path) -> None:
    loaded = modules(
        "from minirt.cli import main\nassert main(['ball.rt', '-o', 'x.png', '--size', '8x8']) == 0", folder
    )
    assert "numba" in loaded
    assert not {"pyglet", "minirt.mlx", "minirt.viewer"} & loaded


def test_the_module_is_the_program(folder: Path) -> None:
    ended = program(folder)
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\nexpected one scene file, got 0\n")


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_come_at_once(folder: Path, option: str) -> None:
    times = []
    for _ in range(5):  # the best of some: other programs run too
        before = time.perf_counter()
        assert program(folder, option).status == 0
        times.append(time.perf_counter() - before)
    assert min(times) < 0.3


def test_help_imports_nothing_heavy(folder: Path) -> None:
    assert not HEAVY & modules(QUIETLY + "    with contextlib.suppress(SystemExit): main(['--help'])", folder)


def test_an_interrupt_ends_a_long_render_without_a_trace(folder: Path) -> None:
    (folder / "x.png").write_bytes(b"old")
    process = start(folder, "ball.rt", "-o", "x.png", "--size", "640x360", "--samples", "65536")  # some minutes
    time.sleep(2)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    before = time.perf_counter()
    out, err = process.communicate(timeout=30)
    assert time.perf_counter() - before < 2
    assert (process.returncode, out, err) == (130, b"", b"")
    assert (folder / "x.png").read_bytes() == b"old"
    assert {path.name for path in folder.iterdir()} == {"ball.rt", "x.png"}


def test_a_reader_that_leaves_early_is_no_traceback(folder: Path) -> None:
    command = [*PROGRAM, "ball.rt", "-o", "-", "--size", "900x700"]
    process = subprocess.Popen(command, cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    err = process.stderr.read()
    process.stderr.close()
    assert process.wait(60) == 1
    assert b"Traceback" not in err
