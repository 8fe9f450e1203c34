"""The viewer as a program: how it starts and ends, what it leaves behind, and how it replays recorded keys."""

from __future__ import annotations

import sys
import threading

import numpy as np
import pytest

from minirt.errors import RenderError, ReplayError
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.scene import parse
from minirt.viewer.app import desktop
from minirt.viewer.app.desktop import run
from minirt.viewer.app.judging import PictureJudge
from minirt.viewer.app.replay import replay
from minirt.viewer.editing.editor import RATE
from tests import processes
from tests.paths import ROOT
from tests.viewer.fake import TEXT, FakeRenderer, colour_of, played, scene
from tests.waiting import HANG_LIMIT, until

STUCK = """
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer.app.desktop import run
from minirt.viewer.app.judging import PictureJudge
from tests.viewer.fake import FakeRenderer, scene
from tests.waiting import HANG_LIMIT

class Stuck(FakeRenderer):
    def is_ready(self, scene, samples):
        return False
    def prepare(self, scene, samples):
        self.started.set()
        ThreadPoolExecutor().submit(Event().wait).result()  # the interpreter would wait for this thread for ever

memory, renderer = Memory(patience=HANG_LIMIT), Stuck()
memory.do(renderer.started.wait)
memory.tap(Key.ESCAPE)
raise SystemExit(run(scene(), path="scene.rt", renderer=renderer, mlx=Mlx(memory)))
"""


@pytest.fixture(autouse=True)
def without_time_limit(monkeypatch) -> None:
    """Give the painter as long as it needs to end, or fail the test; judge no picture, which would take longest."""
    monkeypatch.setattr(PictureJudge, "judge", lambda _: None)

    def fail(_status: int) -> None:
        raise AssertionError("the painter did not end")

    monkeypatch.setattr(desktop, "STOP_TIMEOUT", HANG_LIMIT)
    monkeypatch.setattr(desktop.os, "_exit", fail)


def script(screen: tuple[int, int] = (2560, 1600)) -> Memory:
    """The input of a user, after which the program may take as long as it needs to end."""
    return Memory(screen, patience=HANG_LIMIT)


def run_program(memory: Memory, path, renderer=None, size=None) -> int:
    """Run the viewer; return its exit status."""
    return run(scene(), path=path, size=size, renderer=renderer or FakeRenderer(), mlx=Mlx(memory))


def test_escape_ends_with_0_and_prints_nothing(tmp_path, capfd):
    memory = script()
    memory.tap(Key.D)
    memory.tap(Key.ESCAPE)
    assert run_program(memory, tmp_path / "scene.rt") == 0
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []
    assert not [thread for thread in threading.enumerate() if thread.name == "minirt-painter"]


def test_an_unexpected_exception_is_shown_and_raised_when_the_window_is_closed(tmp_path, defects):
    """So nothing is lost: unsaved changes are kept, and the user can save them."""
    renderer, memory, path = FakeRenderer(), script(), tmp_path / "scene.rt"
    renderer.error = ValueError("odd")
    memory.tap(Key.D)
    memory.do(lambda: until(lambda: (memory.turn(tick=False), defects)[1], "the error"))
    memory.tap(Key.CONTROL_L, Key.S)
    memory.tap(Key.ESCAPE)
    with pytest.raises(RenderError, match="miniRT has an error, please report it: ValueError: odd") as raised:
        run_program(memory, path, renderer)
    assert raised.value.__cause__ is renderer.error
    assert parse(path.read_bytes(), path).scene != scene()
    assert {id(each) for each in defects} == {id(renderer.error)}
    defects.clear()


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
    memory = script(screen=(800, 600) if "9999" in text else (2560, 1600))
    seen = []
    memory.do(lambda: seen.append((memory.windows[0].width, memory.windows[0].height, memory.windows[0].title)))
    memory.tap(Key.ESCAPE)
    run(scene(text), path=tmp_path / "a b.rt", size=requested, renderer=FakeRenderer(), mlx=Mlx(memory))
    assert seen == [(*expected, "miniRT - a b.rt (new)")]


def test_escape_ends_the_program_inside_the_compiler():
    done = processes.run([sys.executable, "-c", STUCK], cwd=ROOT)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_importing_the_viewer_loads_neither_window_library_nor_compiler():
    imports = "import sys; from minirt.viewer.app import desktop, replay"
    code = f"{imports}; print(*{{'numba', 'pyglet', 'PIL'}} & {{*sys.modules}})"
    done = processes.run([sys.executable, "-c", code], cwd=ROOT, text=True)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "", "")


# Replay: recorded keys and mouse events on the whole viewer, in simulated time.


SELECT_SPHERE = ("press Tab", "press Tab")


def frame(*lines: str, hud: bool = True):
    """Replay lines and return the last frame."""
    return replay(scene(), lines, renderer=FakeRenderer(), size=(300, 200), path="scene.rt", hud=hud)


def test_the_same_keys_give_the_same_frame():
    lines = ("hold d 0.3", "press Tab", "hold Shift+Right 0.7", "wheel up 3", "resize 320x100", "press H")
    assert np.array_equal(frame(*lines), frame(*lines))


def test_a_still_picture_has_all_samples_in_all_pixels():
    renderer = FakeRenderer()
    replay(scene(), ["hold d 0.3"], renderer=renderer, size=(64, 48), path="scene.rt", samples=9)
    assert renderer.samples[:3] == [1, 4, 9]  # before the key
    assert renderer.samples[-3:] == [1, 4, 9]  # and after it
    assert set(renderer.samples[3:-3]) == {1}
    assert renderer.refined == []
    session = played("hold d 0.3")
    assert set(session.refinement.painter.renderer.samples) == {1}


def test_the_hud_is_in_the_frame_but_not_in_the_picture():
    bare = frame(hud=False)
    assert (bare == colour_of(scene())).all()
    assert not np.array_equal(frame(), bare)
    assert np.array_equal(frame("press I", "press I"), bare)
    assert np.array_equal(frame("press I", "press I", "press I"), frame("press K", "press K"))
    assert not np.array_equal(frame("press I"), frame())


@pytest.mark.parametrize(
    ("keys", "steps"),
    [
        (["down Shift", "wheel up 2", "up Shift"], 2),
        (["down Shift", "wheel down", "up Shift"], -1),
        (["wheel up 2", "wheel down"], 0),
        (["text +++"], 3),
        (["down Shift", "text +", "up Shift"], 1),  # many keyboards need Shift to type "+"
    ],
)
def test_the_wheel_with_shift_and_typed_characters_resize(keys, steps):
    (sphere,) = played(*SELECT_SPHERE, *keys).state.scene.spheres
    assert sphere.diameter == pytest.approx(2 * 1.05**steps, abs=5e-5)


@pytest.mark.parametrize("shift", [(), ("down Shift",)])
def test_a_held_plus_goes_on_and_grows(shift):
    """A window reports the press of the key before the character that it types."""
    key = ("down F3", "text +", "wait 2", "text +", "up F3")  # the platform's own repeat is ignored
    (sphere,) = played(*SELECT_SPHERE, *shift, *key).state.scene.spheres
    assert sphere.diameter == pytest.approx(2 * 1.05 ** (RATE * (2 + 1)), rel=1e-3)
    (tapped,) = played(*SELECT_SPHERE, *shift, "down F3", "text +", "up F3", "text +").state.scene.spheres
    assert tapped.diameter == pytest.approx(2 * 1.05**2, abs=5e-5)


def test_clicks_select_elements_on_nothing_the_camera_and_comments_are_skipped():
    assert played("", "   ", "# press Tab", "press Tab  # twice").state.element.title == "light"
    assert played("click 32,24").state.element.title == "sphere"
    assert played("click 32,40").state.element.title == "plane"
    nothing = played("press Tab", "click 1,1").state
    assert (nothing.element.title, nothing.message) == ("camera", "nothing is there: the camera is selected")


def test_quitting_the_session_ends_the_replay():
    for end in ("press Escape", "press Ctrl+q", "close", "press Ctrl+Shift+Escape"):
        session = played("press d", end, "press d", "resize 10x10")
        assert len(session.state.undo_stack) == 1
        assert session.screen.frame.shape == (48, 64, 4)


def test_a_hidden_window_loses_no_input():
    assert np.array_equal(frame("hide", "press d", "wait 1", "show"), frame("press d", "wait 1"))


@pytest.mark.parametrize(
    ("line", "column", "expected"),
    [
        ("pres a", 1, "unknown command 'pres', did you mean 'press'?"),
        ("press Tob", 7, "unknown key 'Tob', did you mean 'Tab'?"),
        ("press Ctlr+S", 7, "unknown key 'Ctlr', did you mean 'Ctrl'?"),
        ("press", 1, "expected 'press KEY'"),
        ("press a b", 9, "expected 'press KEY'"),
        ("hold a", 6, "expected 'hold KEY seconds'"),
        ("hold a x", 8, "expected seconds"),
        ("hold a nan", 8, "expected seconds"),
        ("wait -1", 6, "expected seconds"),
        ("hold + 1", 6, "typed, not held"),
        ("  click 1;2", 9, "expected x,y"),
        ("click 1,2 top", 11, "expected one of left, middle, right"),
        ("wheel upp", 7, "did you mean 'up'?"),
        ("wheel up 0", 10, "expected a count"),
        ("resize 0x5", 8, "expected WxH"),
        ("close it", 7, "expected 'close'"),
    ],
)
def test_a_bad_line_gives_an_error_with_its_position(line, column, expected):
    renderer = FakeRenderer()
    with pytest.raises(ReplayError) as caught:
        replay(scene(), ["# keys", "", line], renderer=renderer, size=(8, 6), path="scene.rt", file="keys.txt")
    text = str(caught.value)
    assert text.startswith(f"keys.txt:3:{column}: ")
    assert expected in text
    assert text.splitlines()[1].strip() == line.strip()
    assert renderer.rendered == []
