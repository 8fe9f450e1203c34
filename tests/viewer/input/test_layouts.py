"""Every key of the table on American, French and German keyboards, in a real window."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from minirt.viewer.input.bindings import BINDINGS
from tests.viewer.display.test_help import LAYOUTS, MOUSE
from tests.viewer.fake import TEXT
from tests.viewer.xdotool import do
from tests.waiting import HANG_LIMIT, until
from tests.windows import SCREEN, Desktop

pytestmark = pytest.mark.window

COUNTRIES = dict(zip(LAYOUTS, ("us", "fr", "de"), strict=True))
SIZE = (320, 240)
LAST = ("toggle full screen", "quit")  # the window may be another afterwards, or none


@contextmanager
def keyboard(desktop: Desktop, country: str) -> Iterator[None]:
    """A keyboard of that country."""
    desktop.run("setxkbmap", country)
    try:
        yield
    finally:
        desktop.run("setxkbmap", "us")


class Teller:
    """The running viewer of scenes, and the file into which it tells what keys led to."""

    def __init__(self, desktop: Desktop, process: subprocess.Popen[str], told: Path) -> None:
        self.desktop = desktop
        self.process = process
        self._told = told

    @property
    def told(self) -> list[str]:
        """The rows so far."""
        return self._told.read_text().splitlines()

    def press(self, scene: Path, size: tuple[int, int], *keys: str) -> None:
        """Press keys in the window of that scene and size, and wait until all of them led to something.

        Where the program ends instead, what it told is less than what was pressed.
        """
        window = self.desktop.find(f"miniRT - {scene.name}", size)
        count = len(self.told) + len(keys)
        do(self.desktop, window, *(f"press {key}" for key in keys))
        until(lambda: len(self.told) >= count or self.process.poll() is not None, f"what {keys} led to")


@pytest.mark.parametrize("keys", LAYOUTS)
def test_every_key_leads_to_its_row(desktop: Desktop, tmp_path: Path, keys: str) -> None:
    table = [(key, row.action) for row in BINDINGS for key in row.spellings(keys) if key not in MOUSE]
    usual = [(key, action) for key, action in table if action not in LAST]
    assert len(usual) > 40
    full_screen, quits = ([(key, action) for key, action in table if action == last] for last in LAST)
    assert len(full_screen) == 2
    scenes = [tmp_path / f"scene-{number}.rt" for number in range(len(quits))]  # each key that quits has its own
    for scene in scenes:
        scene.write_text(TEXT)
    told = tmp_path / "told"
    told.write_text("")
    command = [sys.executable, "-W", "error", "-m", "tests.viewer.action_log", keys, str(told), *map(str, scenes)]
    with keyboard(desktop, COUNTRIES[keys]), desktop.program(*command) as process:
        teller = Teller(desktop, process, told)
        teller.press(scenes[0], SIZE, *(key for key, _ in usual))
        for (key, _), size in zip(full_screen, (SIZE, SCREEN), strict=True):
            teller.press(scenes[0], size, key)
        for (key, _), scene in zip(quits, scenes, strict=True):
            teller.press(scene, SIZE, key)
        assert process.communicate(timeout=HANG_LIMIT)[1] == ""
        assert process.returncode == 0
    pressed = [*usual, *full_screen, *quits]
    assert [(key, action) for (key, _), action in zip(pressed, teller.told, strict=True)] == pressed
