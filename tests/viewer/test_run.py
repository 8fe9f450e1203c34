"""The program around the session: how it ends."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from minirt.errors import RenderError
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer import run
from tests.viewer.fake import TEXT, FakeRenderer, scene
from tests.windows import ROOT


def end(memory: Memory, path, renderer=None, size=None) -> int:
    return run(scene(), path=path, size=size, renderer=renderer or FakeRenderer(), mlx=Mlx(memory))


def test_escape_ends_with_0_and_says_nothing(tmp_path, capfd):
    memory = Memory()
    memory.tap(Key.D)
    memory.tap(Key.ESCAPE)
    assert end(memory, tmp_path / "scene.rt") == 0
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []


def test_the_close_button_ends_with_0(tmp_path):
    memory = Memory()
    memory.close_button()
    assert end(memory, tmp_path / "scene.rt") == 0


def test_unsaved_changes_are_kept_and_named(tmp_path, capfd):
    memory = Memory()
    for key in (Key.TAB, Key.D, Key.ESCAPE):
        memory.tap(key)
    assert end(memory, tmp_path / "scene.rt") == 0
    copy = tmp_path / "scene.recovered.rt"
    assert str(copy) in capfd.readouterr().out
    assert copy.read_text() != TEXT


def test_ctrl_c_ends_with_130_and_keeps_changes(tmp_path, capfd):
    def interrupt() -> None:
        raise KeyboardInterrupt

    memory = Memory()
    memory.tap(Key.TAB)
    memory.tap(Key.D)
    memory.do(interrupt)
    assert end(memory, tmp_path / "scene.rt") == 130
    assert (tmp_path / "scene.recovered.rt").exists()
    assert capfd.readouterr().err == ""


def test_an_error_that_nobody_expects_is_a_render_error_and_no_hang(tmp_path):
    renderer = FakeRenderer()
    renderer.error = ValueError("odd")
    with pytest.raises(RenderError, match="ValueError: odd"):
        end(Memory(), tmp_path / "scene.rt", renderer)


@pytest.mark.parametrize(
    ("asked", "text", "opened"),
    [
        ((40, 30), TEXT, (40, 30)),
        (None, TEXT, (1280, 720)),
        (None, "R 320 200\n" + TEXT, (320, 200)),
        (None, "R 9999 9999\n" + TEXT, (800, 600)),
    ],
)
def test_the_size_of_the_window(tmp_path, asked, text, opened):
    memory = Memory(screen=(800, 600) if "9999" in text else (2560, 1600))
    seen = []
    memory.do(lambda: seen.append((memory.windows[0].width, memory.windows[0].height, memory.windows[0].title)))
    memory.tap(Key.ESCAPE)
    run(scene(text), path=tmp_path / "a b.rt", size=asked, renderer=FakeRenderer(), mlx=Mlx(memory))
    assert seen == [(*opened, "miniRT - a b.rt")]


STUCK = """
import time
from concurrent.futures import ThreadPoolExecutor
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer import run
from tests.viewer.fake import FakeRenderer, scene

class Stuck(FakeRenderer):
    def is_ready(self, scene):
        return False
    def prepare(self, scene):
        self.started.set()
        ThreadPoolExecutor().submit(time.sleep, 60).result()  # the interpreter would wait for this thread

memory, renderer = Memory(), Stuck()
memory.do(renderer.started.wait)
memory.tap(Key.ESCAPE)
raise SystemExit(run(scene(), path="scene.rt", renderer=renderer, mlx=Mlx(memory)))
"""


def test_escape_ends_the_program_inside_the_compiler():
    done = subprocess.run([sys.executable, "-c", STUCK], cwd=ROOT, capture_output=True, timeout=20, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_no_thread_is_left(tmp_path):
    memory = Memory()
    memory.tap(Key.ESCAPE)
    end(memory, tmp_path / "scene.rt")
    assert not [thread for thread in threading.enumerate() if thread.name == "minirt-painter"]


def test_importing_the_viewer_loads_neither_window_library_nor_compiler():
    code = "import sys, minirt.viewer; print(*{'numba', 'pyglet', 'PIL'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
