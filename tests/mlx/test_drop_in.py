"""`python -m minirt.mlx`: unchanged programs for the official wrapper, without a screen and in a window."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from minirt.mlx.headless import Headless
from minirt.mlx.recording import COMMANDS, RecordedLine, add_recording
from tests import processes
from tests.paths import PACKAGE, ROOT
from tests.processes import next_line
from tests.waiting import HANG_LIMIT, until

if TYPE_CHECKING:
    import subprocess

    from numpy.typing import NDArray

    from tests.windows import Desktop

NO_SCREEN = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")} | {
    "PYTHONPATH": str(ROOT)
}
MAZE = Path(__file__).with_name("maze.py")
COMMAND = [sys.executable, "-W", "error", "-m", "minirt.mlx"]
FLOOR, RIM, DISC, RED = [0xD0] * 3, [0x8B, 0x45, 0x13], [255, 215, 0], [255, 0, 0]


def run(
    folder: Path, *arguments: str, events: str = "", program: str | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a program, by default the maze, without a screen; files are relative to the folder."""
    (folder / "events.txt").write_text(events, encoding="utf-8")
    if program is not None:
        (folder / "program.py").write_text(program, encoding="utf-8")
    file = str(MAZE if program is None else folder / "program.py")
    options = ["--headless", "--events", "events.txt", "--picture", "end.png"]
    return processes.run(
        [*COMMAND, *options, *arguments[:-1], file, *arguments[-1:]], cwd=folder, env=NO_SCREEN, text=True
    )


def picture(file: Path) -> NDArray[np.uint8]:
    """Read a picture: (h, w, 3), red first."""
    return np.asarray(Image.open(file).convert("RGB"))


def test_a_scripted_user_plays_the_maze(tmp_path: Path) -> None:
    done = run(
        tmp_path, events="picture start.png\npress Right\npress Right # a wall follows\npress Up\nhold Down 1.2\n"
    )
    presses = [line for line in done.stdout.splitlines() if line == "key 65364"]
    assert done.stderr == ""
    assert done.returncode == 0
    assert done.stdout.startswith("key 65363\nkey 65363\nkey 65362\nkey 65364\n")
    assert len(presses) > 10, "a held key repeats"
    assert done.stdout.endswith("closed\nmoves 4\n")
    start, end = picture(tmp_path / "start.png"), picture(tmp_path / "end.png")
    assert start[29, 29].tolist() == DISC
    assert [start[29, 22].tolist(), start[21, 21].tolist()] == [RIM, FLOOR], "the sprite has no black box"
    assert end[69, 69].tolist() == DISC
    assert end[99, 139].tolist() == RED, "simulated time has passed"
    text = start[:20, 5:75].reshape(-1, 3).astype(int)
    assert (text[:, :2].min(axis=1) > 150).sum() > 20
    assert text[:, 2].max() == 0x60, "no blue but that of the wall"


def test_a_program_that_leaves_by_force_leaves_its_picture(tmp_path: Path) -> None:
    done = run(tmp_path, events="press Right\npress Escape\npress Right\n")
    assert (done.returncode, done.stderr) == (7, "")
    assert done.stdout.count("65363") == 1
    assert picture(tmp_path / "end.png")[29, 49].tolist() == DISC


def test_an_exception_of_a_hook_is_printed_and_the_program_goes_on(tmp_path: Path) -> None:
    done = run(tmp_path, events="press Shift+1\npress Right\n")
    assert done.returncode == 0
    assert done.stderr.count("ValueError: one") == 1
    assert "Game.move" in done.stderr
    assert done.stdout.endswith("closed\nmoves 1\n")


def test_strict_ends_at_the_first_exception(tmp_path: Path) -> None:
    done = run(tmp_path, "--strict", "title", events="press 1\npress Right\n")
    assert done.returncode == 1
    assert done.stderr.rstrip().endswith("ValueError: one")
    assert "65363" not in done.stdout


def test_the_process_is_that_of_the_program(tmp_path: Path) -> None:
    """Modules, arguments, clocks, several windows and the exit are as `python program.py` has them."""
    (tmp_path / "helper.py").write_text("VALUE = 5\n")
    program = MAZE.with_name("two_windows.py").read_text(encoding="utf-8")
    done = run(
        tmp_path, "--screen", "640x480", "one", program=program,
        events="click 3,4\nwindow 2\nclick 5,6 right\nwheel down 2 7,8\nclose\n",
    )  # fmt: skip
    assert done.stdout.splitlines() == [
        "(0, 640, 480) ['one'] 5",
        "1000.0 1",
        "(1, 3, 4, 0)",
        "(3, 5, 6, 1)",
        "(5, 7, 8, 1)",
        "(5, 7, 8, 1)",
    ]
    assert (done.returncode, done.stderr) == (1, "done\n")
    assert picture(tmp_path / "end.png")[4, 3].tolist() == [0, 255, 0]


def test_a_picture_that_does_not_exist_is_an_error(tmp_path: Path) -> None:
    done = run(tmp_path, program="from mlx import Mlx\n")
    assert (done.returncode, done.stderr) == (1, "mlx: there is no picture: no window was opened\n")


@pytest.mark.parametrize("arguments", [("--picture", "a.png", "x.py"), ("--headless", "none.py")])
def test_wrong_arguments_are_errors(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    done = processes.run([*COMMAND, *arguments], cwd=tmp_path, env=NO_SCREEN, text=True)
    assert done.returncode in (1, 2)
    assert "--headless" in done.stderr or done.stderr == "mlx: there is no program none.py\n"


def codes(key: str) -> list[int] | str:
    return RecordedLine("events", 1, f"press {key}", types=False).keys(1)


def test_keys_have_names_characters_and_numbers() -> None:
    keys = ["a", "A", "1", "+", "Escape", "PageUp", "KeypadLeft", "Digit1", "65307", "Ctrl+Shift+z", "Super++"]
    assert [codes(key) for key in keys] == [
        [97], [97], [49], [43], [65307], [65365], [65430], [49], [65307], [65507, 65505, 122], [65515, 43],
    ]  # fmt: skip


def test_a_wrong_line_of_a_script_is_named(tmp_path: Path) -> None:
    done = run(tmp_path, events="# a comment\n\npress Escap\n")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("mlx: events.txt:3:7: unknown key 'Escap', did you mean 'Escape'?")


@pytest.mark.window
def test_the_maze_runs_in_a_window(desktop: Desktop) -> None:
    """Key repeat, codes and blending are those of the wrapper on the screen, too."""
    with desktop.program(*COMMAND, str(MAZE), "labyrinth") as process:
        window = desktop.find("labyrinth")
        until(lambda: desktop.screenshot(window)[29, 29].tolist() == DISC, "the player")
        shown = desktop.screenshot(window)
        assert [shown[29, 22].tolist(), shown[21, 21].tolist()] == [RIM, FLOOR]
        desktop.key(window, "Right")
        assert next_line(process) == "key 65363"
        until(lambda: desktop.screenshot(window)[29, 49].tolist() == DISC, "the player one step further")
        desktop.close_button(window)
        output, errors = process.communicate(timeout=HANG_LIMIT)
        assert (process.returncode, output, errors) == (0, "closed\nmoves 1\n", "")


def test_a_program_without_a_display_gets_none(tmp_path: Path) -> None:
    """Without --headless and without a display, `mlx_init` returns None, and the reason is printed."""
    program = "from mlx import Mlx\nprint(Mlx().mlx_init())\n"
    (tmp_path / "program.py").write_text(program)
    done = processes.run([*COMMAND, "program.py"], cwd=tmp_path, env=NO_SCREEN, text=True)
    if sys.platform == "linux":
        assert (done.returncode, done.stdout) == (0, "None\n")
        assert "there is no display); --headless runs without one" in done.stderr


def test_the_script_in_the_readme_is_right() -> None:
    readme = (PACKAGE / "mlx/README.md").read_text(encoding="utf-8")
    lines = readme.split("```\n# events.txt\n")[1].split("```")[0].splitlines()
    add_recording(lines, "events", Headless(None, (100, 100)), types=False)
    assert {line.split()[0] for line in lines} | {"up", "show"} == set(COMMANDS)


# A machine without a screen: imports work, and errors say what to do.


def run_without_screen(program: str) -> str:
    """Run a program without a screen and return its output."""
    command = [sys.executable, "-W", "error", "-c", program]
    done = processes.run(command, env=NO_SCREEN, text=True)
    assert done.stderr == ""
    return str(done.stdout)


def test_the_import_loads_no_window_library() -> None:
    program = (
        "import sys, minirt.mlx, minirt.mlx.memory; print([n for n in ('pyglet', 'PIL', 'numba') if n in sys.modules])"
    )
    assert run_without_screen(program) == "[]\n"


def test_no_display_is_an_error_each_time() -> None:
    program = """
from minirt.mlx import Mlx, MlxError
for _ in range(2):
    try:
        Mlx(strict=True).mlx_init()
    except MlxError as error:
        print(error)
"""
    if sys.platform == "linux":
        assert run_without_screen(program) == "no window can be opened (there is no display)\n" * 2
