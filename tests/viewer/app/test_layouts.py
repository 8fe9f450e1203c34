"""Every key binding on keyboards of several countries, also without Latin letters, in a real window.

python -m tests.viewer.app.test_layouts LOG SCENE...   # logs the actions of keys, one scene after the other
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from minirt.scene import load
from minirt.viewer.app import keyboard as keys_module
from minirt.viewer.app.desktop import run
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import BINDINGS, Binding
from tests.viewer.fake import TEXT, FakeRenderer
from tests.viewer.test_bindings import MOUSE
from tests.viewer.xdotool import LETTER_CODES, do
from tests.waiting import HANG_LIMIT, until
from tests.windows import SCREEN, Desktop

pytestmark = pytest.mark.window

KEYBOARDS = {  # X11's names, with the layout of the table and the key codes of letters that the keyboard does not print
    "fr": ("azerty", None),
    "de": ("qwertz", None),
    "us dvorak": ("qwerty", None),
    "gr": ("qwerty", LETTER_CODES),
}
SIZE = (320, 240)
LAST = ("toggle full screen", "quit")  # the window may be replaced or closed afterwards
# Return closes the list that N has opened; Escape takes the keys from the panel that F1 has opened, and from the name
# that F2 begins.
WITH = {"Shift+N": "Return Shift+N", "F1": "F1 Escape", "F2": "F2 Escape"}


@contextmanager
def keyboard(desktop: Desktop, layout: str) -> Iterator[None]:
    """Set the keyboard layout, or a layout and its variant, for the block."""
    desktop.run("setxkbmap", *layout.split())
    try:
        yield
    finally:
        desktop.run("setxkbmap", "us")


def log_actions(log: str, *scenes: str) -> int:
    """Show the scenes and log the actions of their keys to a file; return the first exit status that is not 0."""

    def logged(perform: Callable[..., None]) -> Callable[..., None]:
        def perform_and_log(
            performer: EventDispatcher | Session, binding: Binding, *arguments: float, **others: bool
        ) -> None:
            perform(performer, binding, *arguments, **others)
            with Path(log).open("a") as lines:
                lines.write(f"{binding.action}\n")

        return perform_and_log

    for owner, name in ((EventDispatcher, "perform"), (keys_module, "hold")):
        setattr(owner, name, logged(getattr(owner, name)))
    options = {"size": SIZE, "keys": "auto", "renderer": FakeRenderer()}
    statuses = (run(load(scene).scene, path=scene, **options) for scene in scenes)
    return next((status for status in statuses if status), 0)


@contextmanager
def logging(desktop: Desktop, log: Path, *scenes: Path) -> Iterator[subprocess.Popen[str]]:
    """Run `log_actions`. The user's language tells nothing of the keyboard, and no other window had a panel."""
    log.write_text("")
    for scene in scenes:
        scene.write_text(TEXT)
    command = [sys.executable, "-W", "error", "-m", "tests.viewer.app.test_layouts", str(log), *map(str, scenes)]
    with desktop.program("env", f"XDG_STATE_HOME={log.parent}", "LC_ALL=C", *command) as process:
        yield process


def test_the_keys_follow_the_layout_that_is_chosen_while_the_window_is_open(desktop: Desktop, tmp_path: Path) -> None:
    log, scene = tmp_path / "log", tmp_path / "scene.rt"
    actions: list[str] = []
    with keyboard(desktop, "us"), logging(desktop, log, scene):
        window = desktop.find(f"miniRT - {scene.name}")
        for layout, key in (("us", "w"), ("fr", "z"), ("de", "w"), ("fr", "z")):
            desktop.run("setxkbmap", layout)
            do(desktop, window, f"press {key}")
            actions.append("forward")
            until(lambda: log.read_text().split("\n")[:-1] == actions, f"the action of {key} on {layout}")


@pytest.mark.parametrize("layout", KEYBOARDS)
def test_every_key_triggers_its_action(desktop: Desktop, tmp_path: Path, layout: str) -> None:
    keys, codes = KEYBOARDS[layout]
    table = [(key, row.action) for row in BINDINGS for key in row.spellings(keys) if key not in MOUSE]
    usual = [(key, action) for key, action in table if action not in LAST]
    assert len(usual) > 40
    full_screen, quits = ([(key, action) for key, action in table if action == last] for last in LAST)
    assert len(full_screen) == 2
    scenes = [tmp_path / f"scene-{number}.rt" for number in range(len(quits))]  # one for each key that quits
    log = tmp_path / "log"
    with keyboard(desktop, layout), logging(desktop, log, *scenes) as process:

        def press(scene: Path, size: tuple[int, int], *keys: str) -> None:
            """Press keys in a window until each of them has led to an action, or the program has ended."""
            window = desktop.find(f"miniRT - {scene.name}", size)
            count = len(log.read_text().splitlines()) + len(keys)
            listed = " ".join(WITH.get(key, key) for key in keys)
            do(desktop, window, *(f"press {key}" for key in listed.split()), codes=codes)
            until(
                lambda: len(log.read_text().splitlines()) >= count or process.poll() is not None, f"actions of {keys}"
            )

        press(scenes[0], SIZE, *(key for key, _ in usual))
        for (key, _), size in zip(full_screen, (SIZE, SCREEN), strict=True):
            press(scenes[0], size, key)
        for (key, _), scene in zip(quits, scenes, strict=True):
            press(scene, SIZE, key)
        assert process.communicate(timeout=HANG_LIMIT)[1] == ""
        assert process.returncode == 0
    pressed = [*usual, *full_screen, *quits]
    assert [(key, action) for (key, _), action in zip(pressed, log.read_text().splitlines(), strict=True)] == pressed


if __name__ == "__main__":
    sys.exit(log_actions(*sys.argv[1:]))
