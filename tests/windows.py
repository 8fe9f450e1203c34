"""A desktop of its own for tests of real windows: Xvfb with the window manager openbox, and a user's hands.

    from tests.windows import desktop  # a fixture, one desktop for the whole session

    @pytest.mark.window
    def test_escape(desktop: Desktop) -> None:
        with desktop.program(sys.executable, "-m", "some.program") as program:
            window = desktop.find("its title")
            desktop.key(window, "Escape")
            assert program.wait(10) == 0

Without the tools these tests are skipped; with MINIRT_REQUIRE_WINDOW=1 in the environment they fail.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

TOOLS = ("Xvfb", "openbox", "xdotool", "wmctrl", "xwd")
ROOT = Path(__file__).parent.parent
PATIENCE = 10.0  # seconds that anything may take


class Desktop:
    """The user's hands on the display that `environment` names. Windows are X11's numbers."""

    def __init__(self, environment: dict[str, str]) -> None:
        self.environment = environment

    def run(self, *command: str) -> bytes:
        """Standard output of a command; raises CalledProcessError or TimeoutExpired."""
        return subprocess.run(command, env=self.environment, capture_output=True, check=True, timeout=PATIENCE).stdout

    def is_managed(self) -> bool:
        """Whether a window manager answers."""
        done = subprocess.run(
            ["wmctrl", "-m"], env=self.environment, capture_output=True, check=False, timeout=PATIENCE
        )
        return done.returncode == 0

    @contextmanager
    def program(self, *command: str) -> Iterator[subprocess.Popen[str]]:
        """Start a program on this desktop, from the project's root; it is killed if it is still there at the end."""
        with subprocess.Popen(
            command, env=self.environment, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        ) as process:
            try:
                yield process
            finally:
                process.kill()

    def find(self, title: str) -> int:
        """Wait for the window of this title, until it has the focus."""
        found: list[int] = []

        def look() -> bool:
            with suppress(subprocess.CalledProcessError, IndexError):  # not there yet, or on its way to another place
                lines = self.run("wmctrl", "-l").decode().splitlines()
                found[:] = [int(line.split()[0], 16) for line in lines if line.split(None, 3)[3:] == [title]]
                self.activate(found[0])
                return True
            return False

        until(look, f"a window called {title}")
        return found[0]

    def activate(self, window: int) -> None:
        self.run("xdotool", "windowactivate", "--sync", str(window))

    def key(self, window: int, *names: str) -> None:
        """Press and release; xdotool's names, such as Escape, shift+Tab."""
        self.activate(window)
        self.run("xdotool", "key", *names)

    def keydown(self, name: str) -> None:
        self.run("xdotool", "keydown", name)

    def keyup(self, name: str) -> None:
        self.run("xdotool", "keyup", name)

    def move(self, window: int, x: int, y: int) -> None:
        self.run("xdotool", "mousemove", "--window", str(window), str(x), str(y))

    def click(self, window: int, x: int, y: int, button: int = 1) -> None:
        """Buttons 4 to 7 turn the wheel."""
        self.move(window, x, y)
        self.run("xdotool", "click", str(button))

    def resize(self, window: int, width: int, height: int) -> None:
        self.run("xdotool", "windowsize", str(window), str(width), str(height))
        until(lambda: self.size(window) == (width, height), f"a window of {width}x{height}")

    def size(self, window: int) -> tuple[int, int]:
        lines = self.run("xdotool", "getwindowgeometry", "--shell", str(window)).decode().splitlines()
        values = dict(line.split("=") for line in lines)
        return int(values["WIDTH"]), int(values["HEIGHT"])

    def minimise(self, window: int) -> None:
        self.run("xdotool", "windowminimize", str(window))

    def restore(self, window: int) -> None:
        self.activate(window)

    def close_button(self, window: int) -> None:
        self.run("wmctrl", "-i", "-c", hex(window))

    def screenshot(self, window: int) -> NDArray[np.uint8]:
        """What the window shows: (h, w, 3) uint8, red, green, blue."""
        return _pixels(self.run("xwd", "-silent", "-id", str(window)))


def until(condition: Callable[[], bool], what: str, seconds: float = PATIENCE) -> None:
    """Wait until `condition` holds; `what` says in the failure what did not come."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"{what} did not come within {seconds} s")
        time.sleep(0.02)


@pytest.fixture(scope="session")
def desktop() -> Iterator[Desktop]:
    """One desktop for all tests of the session."""
    require()
    with open_desktop() as opened:
        yield opened


def require() -> None:
    """Skip the test where the tools are missing, or fail it if they have to be there."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        reason = f"tests of real windows need {', '.join(missing)}"
        if os.environ.get("MINIRT_REQUIRE_WINDOW") == "1":
            pytest.fail(reason)
        pytest.skip(reason)


@contextmanager
def open_desktop() -> Iterator[Desktop]:
    """Start a display on a free number and a window manager on it; both end with the block."""
    with ExitStack() as stack:
        reader, writer = os.pipe()
        command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", "2560x1600x24", "-nolisten", "tcp"]
        command += ["-noreset"]  # or it starts afresh, without openbox, when its last client leaves
        stack.enter_context(_process(command, dict(os.environ), pass_fds=(writer,)))
        os.close(writer)
        with os.fdopen(reader) as number:  # Xvfb writes it when it is ready, or goes and closes its end
            name = number.readline().strip()
        if not name:
            raise RuntimeError("Xvfb did not start")
        home = stack.enter_context(tempfile.TemporaryDirectory())  # no configuration of this user's
        environment = {key: value for key, value in os.environ.items() if key != "WAYLAND_DISPLAY"}
        environment |= {"DISPLAY": f":{name}", "PYTHONPATH": str(ROOT), "XDG_CONFIG_HOME": home, "XDG_CACHE_HOME": home}
        stack.enter_context(_process(["openbox", "--sm-disable"], environment))
        opened = Desktop(environment)
        until(opened.is_managed, "openbox")
        yield opened


@contextmanager
def _process(command: list[str], environment: dict[str, str], pass_fds: tuple[int, ...] = ()) -> Iterator[None]:
    with subprocess.Popen(
        command, env=environment, pass_fds=pass_fds, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            yield
        finally:
            process.terminate()


def _pixels(dump: bytes) -> NDArray[np.uint8]:
    """Read the X Window Dump format: a header of big-endian words, a colour table, rows of 32-bit pixels."""
    header = np.frombuffer(dump, ">u4", 25)
    header_size, width, height, row_size, colors = (int(header[i]) for i in (0, 4, 5, 12, 19))
    if header[11] != 32 or header[7] != 0:  # bits per pixel; byte order, 0 is least significant first
        raise ValueError("the window's pixels are not 32-bit BGRX")
    rows = np.frombuffer(dump, np.uint8, offset=header_size + 12 * colors, count=row_size * height)
    return rows.reshape(height, row_size)[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]
