"""The viewer in JupyterLab, in a real browser: keys and the mouse move a ball, and the pixels show it."""

from __future__ import annotations

import io
import json
import os
import secrets
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import DEVNULL

import numpy as np
import pytest
from PIL import Image

from tests.browser import Page, open_browser, require_browser
from tests.processes import started
from tests.skipping import require
from tests.waiting import until

pytestmark = pytest.mark.slow
WIDTH, HEIGHT = 320, 180
SCENE = "A 1 255,255,255\nC 0,0,-10 0,0,1 40\nsp 0,0,0 2 255,0,0\n"  # a red disc on black, without shades
CELL = f"""
import minirt
viewer = minirt.view(minirt.loads({SCENE!r}), ({WIDTH}, {HEIGHT}))  # without a display: in the notebook
viewer
"""
HOST = "127.0.0.1"
OPTIONS = (
    "--no-browser",
    "--allow-root",
    "--expose-app-in-browser",
    "--ServerApp.port_retries=0",
    "--LabApp.news_url=None",  # nothing from the network
)
READY = (
    "[...window.jupyterapp.shell.widgets('main')].some(each => each.sessionContext?.session?.kernel?.status === 'idle')"
)
RUN = "window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)"
KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}
SLOW = '"Plugin @jupyter'  # what JupyterLab's warning begins with that a part of it starts slowly, on a busy machine
CTRL = 2  # of the modifiers of the protocol
COMMANDS = "window.done = []; window.jupyterapp.commands.commandExecuted.connect((_, each) => done.push(each.id)); true"
CANVAS = "document.querySelector('canvas.minirt-viewer')"


@contextmanager
def opened(notebook: Path, home: Path) -> Iterator[Page]:
    """Start JupyterLab and a browser, open a notebook, and run its cells; all of it ends with the block."""
    with socket.socket() as free:
        free.bind((HOST, 0))
        port = free.getsockname()[1]
    token = secrets.token_hex()
    command = [
        *(sys.executable, "-m", "jupyterlab", *OPTIONS, f"--ip={HOST}", f"--port={port}"),
        *(f"--IdentityProvider.token={token}", f"--ServerApp.root_dir={notebook.parent}"),
    ]
    environment = os.environ | {"HOME": str(home), "XDG_CACHE_HOME": cache_folder()}
    environment.pop("DISPLAY", None)
    with started(command, env=environment, stdout=DEVNULL, stderr=DEVNULL):
        until(lambda: is_listening(port), "JupyterLab")
        with open_browser(require_browser(), home / "browser") as page:
            page.call(
                "Network.emulateNetworkConditions", offline=False, latency=0, downloadThroughput=-1, uploadThroughput=-1
            )
            page.call("Emulation.setDeviceMetricsOverride", width=1200, height=800, deviceScaleFactor=1, mobile=False)
            page.call("Page.navigate", url=f"http://{HOST}:{port}/doc/tree/{notebook.name}?token={token}")
            until(lambda: is_true(page, f"!!window.jupyterapp && {READY}"), "the kernel")
            page.value(RUN)
            yield page


def cache_folder() -> str:
    """Return the user's cache folder, in which compiled kernels are."""
    return os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")


def is_listening(port: int) -> bool:
    """Whether a server answers at a port."""
    with suppress(OSError):
        socket.create_connection((HOST, port)).close()
        return True
    return False


def is_true(page: Page, script: str) -> bool:
    """Whether a JavaScript expression is true; it is not while the page that it speaks of is being loaded."""
    with suppress(AssertionError):
        return bool(page.value(script))
    return False


class ViewerInPage:
    """The viewer in a page, used by its user."""

    def __init__(self, page: Page, folder: Path) -> None:
        self.page = page
        self.folder = folder  # of the notebook
        until(lambda: is_true(page, f"Number({CANVAS}?.dataset.frame) > 0"), "the first frame")

    def press(self, key: str, code: str, ctrl: bool = False) -> None:
        """Press and release a key."""
        number = {"Tab": 9}.get(key, ord(key.upper()) if key.isascii() and len(key) == 1 else 0)
        held = {"key": key, "code": code, "windowsVirtualKeyCode": number, "modifiers": CTRL if ctrl else 0}
        for sort in ("keyDown", "keyUp"):
            text = {"text": key} if len(key) == 1 and sort == "keyDown" and not ctrl else {}
            self.page.call("Input.dispatchKeyEvent", type=sort, **held, **text)

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag with the left button, between points of the frame."""
        left, top = (self.page.value(f"{CANVAS}.getBoundingClientRect().{side}") for side in ("left", "top"))
        self.page.drag((left + start[0], top + start[1]), (left + end[0], top + end[1]))

    def pixels(self) -> np.ndarray:
        """Return the frame that the page shows, (h, w, 3), as its screenshot has it."""
        box = self.page.value(f"{CANVAS}.getBoundingClientRect().toJSON()")
        picture = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        left, top = round(box["left"]), round(box["top"])
        return np.asarray(picture)[top : top + round(box["height"]), left : left + round(box["width"])].astype(int)

    def complaints(self) -> list[str]:
        """Return what the page has complained about, but for a machine that is slow."""
        return [each for each in self.page.complaints if SLOW not in each]

    def has_focus(self) -> bool:
        """Whether keys go to the viewer."""
        return bool(self.page.value(f"document.activeElement === {CANVAS}"))


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ViewerInPage]:
    """Fixture: a viewer in JupyterLab."""
    require("anywidget", "jupyterlab", "ipykernel")
    folder: Path = tmp_path_factory.mktemp("lab")
    with opened(written(folder / "ball.ipynb", CELL), folder) as page:
        yield ViewerInPage(page, folder)


def written(path: Path, *cells: str) -> Path:
    """Write a notebook with these cells of code, and return its path."""
    cell = {"cell_type": "code", "metadata": {}, "execution_count": None, "outputs": []}
    made = [{**cell, "id": f"cell{number}", "source": source} for number, source in enumerate(cells)]
    notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": KERNEL}, "cells": made}
    path.write_text(json.dumps(notebook))
    return path


def red_pixels(viewer: ViewerInPage) -> tuple[np.ndarray, ...]:
    """Return the rows and columns of the red pixels; nothing in the frame but the ball is red."""
    pixels = viewer.pixels()
    return np.nonzero((pixels[..., 0] > 128) & (pixels[..., 1:].max(axis=-1) < 80))


def is_centred(viewer: ViewerInPage) -> bool:
    """Whether the ball is in the middle, by its width and its top: tips cover a part of its lower half."""
    rows, columns = red_pixels(viewer)
    radius = np.ptp(columns) / 2
    return bool(np.hypot(columns.min() + radius - WIDTH / 2, rows.min() + radius - HEIGHT / 2) < 2)


def ball(viewer: ViewerInPage) -> tuple[float, float, int]:
    """Return the centre of the red pixels, and their number."""
    rows, columns = red_pixels(viewer)
    return (float(columns.mean()), float(rows.mean()), len(rows)) if len(rows) else (0.0, 0.0, 0)


def test_a_key_and_a_drag_move_the_ball_and_escape_gives_the_keyboard_back(viewer: ViewerInPage) -> None:
    until(lambda: ball(viewer)[2] > 100, "the ball")
    until(lambda: is_centred(viewer), "a picture that is not coarse")
    x, _, size = ball(viewer)

    viewer.press("d", "KeyD")  # before a click the notebook has the keyboard
    assert not viewer.has_focus()
    viewer.drag((WIDTH / 2, HEIGHT / 2), (WIDTH / 2, HEIGHT / 2))  # a click selects the ball
    until(viewer.has_focus, "the focus")
    assert abs(ball(viewer)[0] - x) < 2

    viewer.drag((WIDTH / 2, HEIGHT / 2), (WIDTH / 2 - 60, HEIGHT / 2))
    dragged = x - 60 * 9 / 10  # the point at the distance 9 follows the pointer, and the centre is at 10
    until(lambda: abs(ball(viewer)[0] - dragged) < 4, "the ball where it was dragged")
    assert ball(viewer)[2] > 0.8 * size  # of which tips have covered a part

    viewer.press("d", "KeyD")
    until(lambda: ball(viewer)[0] > dragged + 6, "the ball on the right")

    viewer.press("Escape", "Escape")
    until(lambda: not viewer.has_focus(), "the end of the focus")
    assert viewer.complaints() == []


def test_keys_are_the_viewer_s_alone_and_known_by_their_place(viewer: ViewerInPage) -> None:
    viewer.page.value(COMMANDS)
    x, y, _ = ball(viewer)
    viewer.drag((x, y), (x, y))  # a click selects the ball
    until(viewer.has_focus, "the focus")
    viewer.press("в", "KeyD")  # the letter of a Russian keyboard in the place of D
    until(lambda: ball(viewer)[0] > x + 6, "the ball on the right")
    viewer.press("Tab", "Tab")
    viewer.press("s", "KeyS", ctrl=True)
    until((viewer.folder / "scene.rt").exists, "the scene in its file")
    assert viewer.has_focus()
    assert viewer.page.value("done") == []  # JupyterLab saved no notebook
    assert viewer.complaints() == []
