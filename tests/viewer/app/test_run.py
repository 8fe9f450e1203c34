"""The viewer as a program: how it starts and ends, and what it leaves behind."""

from __future__ import annotations

import sys
import threading

import pytest

from minirt.errors import RenderError
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer import run
from minirt.viewer.app import desktop
from tests import processes
from tests.paths import ROOT
from tests.viewer.fake import TEXT, FakeRenderer, scene
from tests.waiting import HANG_LIMIT

STUCK = """
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer import run
from tests.viewer.fake import FakeRenderer, scene
from tests.waiting import HANG_LIMIT

class Stuck(FakeRenderer):
    def is_ready(self, scene):
        return False
    def prepare(self, scene):
        self.started.set()
        ThreadPoolExecutor().submit(Event().wait).result()  # the interpreter would wait for this thread for ever

memory, renderer = Memory(patience=HANG_LIMIT), Stuck()
memory.do(renderer.started.wait)
memory.tap(Key.ESCAPE)
raise SystemExit(run(scene(), path="scene.rt", renderer=renderer, mlx=Mlx(memory)))
"""


@pytest.fixture(autouse=True)
def without_time_limit(monkeypatch) -> None:
    """Give the painter as long as it needs to end; if it does not end, fail the test instead of ending the process."""

    def fail(_status: int) -> None:
        raise AssertionError("the painter did not end")

    monkeypatch.setattr(desktop, "STOP_TIMEOUT", HANG_LIMIT)
    monkeypatch.setattr(desktop, "exit_at_once", fail)


class Script(Memory):
    """The input of a user, after which the program may take as long as it needs to end."""

    def __init__(self, screen: tuple[int, int] = (2560, 1600)) -> None:
        super().__init__(screen, patience=HANG_LIMIT)


def run_program(memory: Memory, path, renderer=None, size=None) -> int:
    """Run the viewer; return its exit status."""
    return run(scene(), path=path, size=size, renderer=renderer or FakeRenderer(), mlx=Mlx(memory))


def test_escape_ends_with_0_and_prints_nothing(tmp_path, capfd):
    memory = Script()
    memory.tap(Key.D)
    memory.tap(Key.ESCAPE)
    assert run_program(memory, tmp_path / "scene.rt") == 0
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []


def test_an_unexpected_exception_becomes_a_render_error(tmp_path):
    renderer = FakeRenderer()
    renderer.error = ValueError("odd")
    with pytest.raises(RenderError, match="ValueError: odd"):
        run_program(Script(), tmp_path / "scene.rt", renderer)


@pytest.mark.parametrize(
    ("requested", "text", "expected"),
    [
        ((40, 30), TEXT, (40, 30)),
        (None, TEXT, (1280, 720)),
        (None, "R 320 200\n" + TEXT, (320, 200)),
        (None, "R 9999 9999\n" + TEXT, (800, 600)),
    ],
)
def test_the_window_has_the_requested_size_or_that_of_the_scene(tmp_path, requested, text, expected):
    memory = Script(screen=(800, 600) if "9999" in text else (2560, 1600))
    seen = []
    memory.do(lambda: seen.append((memory.windows[0].width, memory.windows[0].height, memory.windows[0].title)))
    memory.tap(Key.ESCAPE)
    run(scene(text), path=tmp_path / "a b.rt", size=requested, renderer=FakeRenderer(), mlx=Mlx(memory))
    assert seen == [(*expected, "miniRT - a b.rt")]


def test_escape_ends_the_program_inside_the_compiler():
    done = processes.run([sys.executable, "-c", STUCK], cwd=ROOT)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_no_thread_is_left_after_the_end(tmp_path):
    memory = Script()
    memory.tap(Key.ESCAPE)
    run_program(memory, tmp_path / "scene.rt")
    assert not [thread for thread in threading.enumerate() if thread.name == "minirt-painter"]


def test_importing_the_viewer_loads_neither_window_library_nor_compiler():
    code = "import sys, minirt.viewer; print(*{'numba', 'pyglet', 'PIL'} & {*sys.modules})"
    done = processes.run([sys.executable, "-c", code], cwd=ROOT, text=True)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "", "")
