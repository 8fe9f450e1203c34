"""Every key of the table on American, French and German keyboards, in a real window."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from minirt.viewer.bindings import BINDINGS
from tests.viewer.fake import TEXT
from tests.viewer.hands import do
from tests.viewer.test_help import LAYOUTS, MOUSE
from tests.windows import Desktop, until

pytestmark = pytest.mark.window

COUNTRIES = dict(zip(LAYOUTS, ("us", "fr", "de"), strict=True))
LAST = ("toggle full screen", "quit")  # the window may be another afterwards, or none


@contextmanager
def keyboard(desktop: Desktop, country: str) -> Iterator[None]:
    """A keyboard of that country."""
    desktop.run("setxkbmap", country)
    try:
        yield
    finally:
        desktop.run("setxkbmap", "us")


@contextmanager
def telling(desktop: Desktop, folder: Path, keys: str) -> Iterator[tuple[subprocess.Popen[str], Path]]:
    """The viewer, and the file into which it tells what keys led to."""
    scene, told = folder / "scene.rt", folder / "told"
    scene.write_text(TEXT)
    told.write_text("")
    command = [sys.executable, "-W", "error", "-m", "tests.viewer.teller", str(scene), keys, str(told)]
    with keyboard(desktop, COUNTRIES[keys]), desktop.program(*command) as process:
        yield process, told


def press(desktop: Desktop, told: Path, keys: list[str]) -> None:
    """Press keys, and wait until all of them led to something."""
    window = desktop.find("miniRT - scene.rt")
    count = len(told.read_text().splitlines()) + len(keys)
    do(desktop, window, *(f"press {key}" for key in keys), "wait 0.2")
    until(lambda: len(told.read_text().splitlines()) >= count, f"what {keys} led to", 20)


@pytest.mark.parametrize("keys", LAYOUTS)
def test_every_key_leads_to_its_row(desktop: Desktop, tmp_path: Path, keys: str) -> None:
    table = [(key, row.action) for row in BINDINGS for key in row.spellings(keys) if key not in MOUSE]
    usual = [(key, action) for key, action in table if action not in LAST]
    assert len(usual) > 40
    full_screen, quits = ([(key, action) for key, action in table if action == last] for last in LAST)
    with telling(desktop, tmp_path, keys) as (process, told):
        press(desktop, told, [key for key, _ in usual])
        for key, _ in full_screen:
            press(desktop, told, [key])
        press(desktop, told, [quits[0][0]])
        assert process.communicate(timeout=20)[1] == ""
        assert process.returncode == 0
        pressed = [*usual, *full_screen, quits[0]]
        led = told.read_text().splitlines()
        assert [(key, action) for (key, _), action in zip(pressed, led, strict=True)] == pressed
    for key, action in quits[1:]:
        with telling(desktop, tmp_path, keys) as (process, told):
            press(desktop, told, [key])
            assert process.wait(20) == 0
            assert told.read_text() == f"{action}\n"
