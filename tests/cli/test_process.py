"""The program as a process: its imports, signals, and hostile environments."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.helpers.signals import ENDING
from tests.cli.announcing import RENDERING
from tests.cli.program import ANNOUNCING, PROGRAM, environment, program, start
from tests.cli.test_output import pixels
from tests.processes import next_line, run
from tests.waiting import HANG_LIMIT

LOADED = "import sys; print(*sorted({each.split('.')[0] for each in sys.modules}), *sorted(sys.modules))"
QUIETLY = "import contextlib, io\nfrom minirt.cli import main\nwith contextlib.redirect_stdout(io.StringIO()):\n"
HEAVY = {"numba", "llvmlite", "pyglet", "PIL", "minirt.mlx", "minirt.viewer"}
OTHER_WORK = {"PIL", "minirt.movie", "minirt.report", "minirt.meshes.obj"}  # other formats, reports, meshes
OTHER_WORK |= {"minirt.materials.radiance", "minirt.formats.xpm"}  # textures
OTHER_WORK |= {"minirt.rendering.culling.hidden_planes"}  # thousands of planes
OTHER_WORK |= {"minirt.rendering.queries.pick"}  # clicks
FOR_MISTAKES = {"difflib"}  # needed to report a mistake
RENDER = "from minirt.cli import main\nassert main(['ball.rt', '-o', '{}', '--size', '8x8']) == 0"


def printed(code: str, folder: Path) -> list[str]:
    """Run code in a Python process; return the words that it prints."""
    done = run([sys.executable, "-c", code], cwd=folder, env=environment(), text=True)
    assert (done.returncode, done.stderr) == (0, "")
    words: list[str] = done.stdout.split()
    return words


def modules(code: str, folder: Path) -> set[str]:
    """Run code in a Python process; return the modules that it has imported."""
    return set(printed(f"{code}\n{LOADED}", folder))


def test_importing_the_library_imports_nothing_heavy(folder: Path) -> None:
    assert not HEAVY & modules("import minirt; minirt.load('ball.rt')", folder)


def test_checking_a_scene_imports_nothing_heavy(folder: Path) -> None:
    loaded = modules(QUIETLY + "    assert main(['ball.rt', '--check']) == 0", folder)
    assert not (HEAVY | OTHER_WORK | FOR_MISTAKES) & loaded


def test_rendering_to_png_imports_nothing_that_other_work_needs(folder: Path) -> None:
    loaded = modules(RENDER.format("x.png"), folder)
    assert "minirt.formats.png" in loaded
    assert not OTHER_WORK & loaded
    loaded = modules(RENDER.format("x.bmp"), folder)
    assert OTHER_WORK & loaded == {"PIL"}
    assert not {"pyglet", "minirt.mlx", "minirt.viewer"} & loaded


NO_MEMORY = "lambda *_, **__: (_ for _ in ()).throw(MemoryError())"
VERSION = "from minirt.cli import main\nimport sys\nsys.argv = ['miniRT', '--version']\nmain()\n"


@pytest.mark.parametrize(("asked", "found"), [("", "1"), ("os.environ['OPENBLAS_NUM_THREADS'] = '3'\n", "3")])
def test_numpy_starts_no_threads_of_its_own_unless_asked(folder: Path, asked: str, found: str) -> None:
    start = f"import os\nos.environ.pop('OPENBLAS_NUM_THREADS', None)\n{asked}{VERSION}"
    program = f"{start}print(os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    assert printed(program, folder)[-2:] == [found, "False"]


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_start_fast(folder: Path, option: str) -> None:
    """Only the standard library and a few modules of the program are imported."""
    allowed = {"minirt", "minirt.cli", "minirt.cli.arguments", "minirt.errors"}
    allowed |= {"minirt.helpers", "minirt.helpers.package"}  # which reads the list of options
    loaded = modules(f"{QUIETLY}    with contextlib.suppress(SystemExit): main(['{option}'])", folder)
    loaded -= modules("import contextlib, io", folder)
    assert {each for each in loaded if each.split(".")[0] not in sys.stdlib_module_names} == allowed


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP", "SIGKILL"])
def test_a_signal_ends_a_long_render_with_its_status_and_without_a_trace(folder: Path, name: str) -> None:
    number = getattr(signal, name, None) or pytest.skip(f"{name} is of Unix")
    (folder / "x.png").write_bytes(b"old")
    with (folder / "ball.rt").open("a") as scene:
        scene.write("pl 0,0,900 0,0,1 9,9,9\n")  # a wall: nothing but sky is drawn at once
    arguments = "ball.rt", "-o", "x.png", "--size", "1920x1080", "--samples", "65536", "--threads", "2"  # hours
    with start(folder, *arguments, command=ANNOUNCING) as process:
        assert next_line(process, errors=True) == RENDERING.decode()
        process.send_signal(number)
        out, err = process.communicate(timeout=HANG_LIMIT)
    status = 128 + number if name != "SIGKILL" else -number
    assert (process.returncode, out, err) == (status, b"", b"")
    assert (folder / "x.png").read_bytes() == b"old"
    assert {path.name for path in folder.iterdir()} == {"ball.rt", "x.png"}


DROPPED = """
import signal, sys
from minirt import __main__ as program
from minirt.cli import render
from minirt.viewer.app import desktop

def drop(*_, **__):
    try:
        signal.raise_signal({number})
    except BaseException:
        return 0

def change(*_):
    try:
        signal.raise_signal({number})
    except BaseException as error:
        raise RuntimeError("an error of a library") from error

desktop.open_session, render.render_output = drop, change
sys.exit(program.main())
"""


@pytest.mark.parametrize("number", ENDING)
@pytest.mark.parametrize("arguments", [["ball.rt"], ["ball.rt", "-o", "x.png"]], ids=["dropped", "changed"])
def test_a_signal_counts_though_a_library_drops_or_changes_its_exception(
    folder: Path, arguments: list[str], number: int
) -> None:
    """As a bare `except` does, and a class whose making is interrupted. Where a window opens none is raised."""
    command = [sys.executable, "-c", DROPPED.format(number=int(number)), *arguments]
    ended = run(command, cwd=folder, env=environment(), text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (128 + number, "", "")


def test_a_lack_of_memory_is_a_sentence(folder: Path) -> None:
    imports = "from minirt import cli\nfrom minirt.rendering.image import Image\n"
    code = f"{imports}Image.encode = {NO_MEMORY}\nraise SystemExit(cli.main())"
    ended = run([sys.executable, "-c", code, "ball.rt", "-o", "x.png"], cwd=folder, env=environment(), text=True)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr.startswith("Error\nnot enough memory; ")
    assert ended.stderr.count("\n") == 2


def test_no_message_has_control_characters(folder: Path) -> None:
    (folder / "b\x1b[31m\x07.rt").write_text((folder / "ball.rt").read_text())
    ended = program(folder, "b\x1b[31m\x07.rt", "-o", "missing/{name}.png", "--size", "8x8")
    assert (ended.status, ended.err) == (1, "Error\nmissing/b [31m .png: cannot write: there is no such folder\n")


def test_a_closed_pipe_gives_no_traceback(folder: Path) -> None:
    with start(folder, "ball.rt", "-o", "-", "--size", "900x700") as process:
        assert process.stdout is not None
        process.stdout.close()
        _, err = process.communicate(timeout=HANG_LIMIT)
    assert process.returncode == 1
    assert b"Traceback" not in err


ENVIRONMENTS: dict[str, dict[str, str | None]] = {
    "no home": {"HOME": None, "XDG_CACHE_HOME": None},
    "a home that is not there": {"HOME": "/dev/null/home", "XDG_CACHE_HOME": None},
    "a file as cache": {"XDG_CACHE_HOME": "/dev/null"},
    "control characters in the cache": {"XDG_CACHE_HOME": "/dev/null/line\nbreak\x1b[31m"},
    "no temporary folder": {"TMPDIR": "/dev/null/tmp"},
}


@pytest.mark.skipif(sys.platform == "win32", reason="another environment")
@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_a_hostile_environment_does_not_change_the_picture(folder: Path, name: str) -> None:
    """None removes a variable."""
    variables = {key: value for key, value in (environment() | ENVIRONMENTS[name]).items() if value is not None}
    ended = run([*PROGRAM, "ball.rt", "--size", "16x16", "-o", "x.png"], cwd=folder, env=variables, text=True)
    assert (ended.returncode, ended.stdout) == (0, "")
    assert np.array_equal(pixels(folder / "x.png"), minirt.render(minirt.load("ball.rt"), 16, 16).array)
    lines = ended.stderr.splitlines()
    assert len(lines) <= 1
    assert all(line.startswith("notice: ") and line.isprintable() for line in lines)
