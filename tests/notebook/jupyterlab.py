"""JupyterLab in a real browser without a window: a notebook is opened, run and used with keys and mouse."""

from __future__ import annotations

import io
import os
import secrets
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import DEVNULL

import numpy as np
from PIL import Image

from tests.browser import Page, open_browser, require_browser
from tests.processes import started
from tests.waiting import until

HOST = "127.0.0.1"
WIDTH, HEIGHT = 1200, 800
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
            page.call(
                "Emulation.setDeviceMetricsOverride", width=WIDTH, height=HEIGHT, deviceScaleFactor=1, mobile=False
            )
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

    def __init__(self, page: Page) -> None:
        self.page = page
        until(lambda: is_true(page, f"Number({CANVAS}?.dataset.frame) > 0"), "the first frame")

    def press(self, key: str, code: str) -> None:
        """Press and release a key."""
        for sort in ("keyDown", "keyUp"):
            text = {"text": key} if len(key) == 1 and sort == "keyDown" else {}
            self.page.call("Input.dispatchKeyEvent", type=sort, key=key, code=code, **text)

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

    def has_focus(self) -> bool:
        """Whether keys go to the viewer."""
        return bool(self.page.value(f"document.activeElement === {CANVAS}"))
