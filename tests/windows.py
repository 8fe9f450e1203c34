"""Desktop: an X server (Xvfb) with a window manager (openbox) for tests of real windows, and a user's actions.

    from tests.windows import desktop  # a fixture, one desktop for the whole session

    @pytest.mark.window
    def test_escape(desktop: Desktop) -> None:
        with desktop.program(sys.executable, "-m", "some.program") as program:
            window = desktop.find("its title")
            desktop.key(window, "Escape")
            assert program.wait(HANG_LIMIT) == 0

Without the tools these tests are skipped; with MINIRT_REQUIRE_WINDOW=1 in the environment they fail.
"""

from __future__ import annotations

import itertools
import os
import re
import select
import shutil
import signal
import subprocess
import tempfile
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests import processes
from tests.idle import until_idle
from tests.paths import ROOT
from tests.skipping import install_command, skip_incomplete
from tests.waiting import HANG_LIMIT, until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

TOOLS = ("Xvfb", "openbox", "xdotool", "wmctrl", "xwd", "xwininfo", "xprop", "setxkbmap")
SCREEN = (2560, 1600)  # its size in pixels
OPENBOX_CONFIG = """\
<openbox_config xmlns="http://openbox.org/3.4/rc">
  <theme><animateIconify>no</animateIconify></theme>
</openbox_config>
"""  # without animation: a window that is being minimised or restored is not where the pointer moves to
MANAGER_VARIABLE = "MINIRT_TEST_WINDOW_MANAGER"  # environment variable with the process id of the window manager
NO_DELAY = ("--delay", "0")  # for xdotool, which otherwise pauses between press and release


class Desktop:
    """A user's actions on the display that `environment` names. Windows are given by X11's ids."""

    def __init__(self, environment: dict[str, str]) -> None:
        self.environment = environment
        self._programs: list[subprocess.Popen[str]] = []  # running inside their `with` blocks
        self._held: list[str] = []  # keys that are down

    def run(self, *command: str) -> bytes:
        """Run a command and return its standard output. CalledProcessError if it fails, TimeoutExpired if it hangs."""
        done = processes.run(command, env=self.environment)
        try:
            done.check_returncode()
        except subprocess.CalledProcessError as error:
            error.add_note(done.stderr.decode(errors="replace"))
            raise
        output: bytes = done.stdout
        return output

    def is_managed(self) -> bool:
        """Whether a window manager answers and has a list of windows."""
        answers = (processes.run(["wmctrl", option], env=self.environment) for option in ("-m", "-l"))
        return all(answer.returncode == 0 for answer in answers)

    @contextmanager
    def manager_paused(self) -> Iterator[None]:
        """Stop the window manager for a while: no new window is shown, and none gets the focus."""
        manager = int(self.environment[MANAGER_VARIABLE])
        until_idle(manager, itertools.count().__next__, 3)  # it must not be stopped while it has grabbed the display
        os.kill(manager, signal.SIGSTOP)
        try:
            yield
        finally:
            os.kill(manager, signal.SIGCONT)

    @contextmanager
    def program(self, *command: str, **options: Any) -> Iterator[subprocess.Popen[str]]:
        """Start a program on this desktop, from the project's root; afterwards it is ended and its windows are closed.

        `options` are those of `subprocess.Popen`; by default standard output and standard error are pipes.
        """
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
        started = processes.started(command, env=self.environment, cwd=ROOT, text=True, **options)
        with self._cleanup(), started as process:
            self._programs.append(process)
            try:
                yield process
            finally:
                self._programs.remove(process)

    def find(self, title: str, size: tuple[int, int] | None = None) -> int:
        """Wait until the window with this title and size has the focus, and return it.

        AssertionError if no program is left that could open it.
        """
        found: list[int] = []

        def look() -> bool:
            self._expect_program()
            with _closed_windows_ignored():  # the program may be replacing its window
                found[:] = [window for window, name in self.windows() if name == title]
                if found and size in (None, self.size(found[0])):
                    self.activate(found[0])
                    return True
            return False

        until(look, f"a window called {title}")
        return found[0]

    def windows(self) -> list[tuple[int, str]]:
        """List the windows that the window manager knows, with their titles."""
        rows = (line.split(None, 3) for line in self.run("wmctrl", "-l").decode().splitlines())
        return [(int(row[0], 16), "".join(row[3:])) for row in rows]

    def activate(self, window: int) -> None:
        """Bring a window to the front and wait until it has the focus. CalledProcessError if it does not exist."""

        def has_focus() -> bool:
            self.run("xdotool", "windowactivate", str(window))
            return self._active() == window

        until(has_focus, f"the focus of window {window}")

    def key(self, window: int, *names: str) -> None:
        """Press and release keys by xdotool's names, such as Escape, shift+Tab."""
        self.activate(window)
        self.run("xdotool", "key", *NO_DELAY, *names)

    def keydown(self, name: str) -> None:
        """Press a key and hold it."""
        self._held.append(name)
        self.run("xdotool", "keydown", *NO_DELAY, name)

    def keyup(self, name: str) -> None:
        """Release a key."""
        self.run("xdotool", "keyup", *NO_DELAY, name)
        self._held.remove(name)

    def release_keys(self) -> None:
        """Release all keys that a failed test may have left pressed."""
        while self._held:
            self.keyup(self._held[-1])

    def move(self, window: int, x: int, y: int) -> None:
        self.run("xdotool", "mousemove", "--window", str(window), str(x), str(y))

    def click(self, window: int, x: int, y: int, button: int = 1) -> None:
        """Click at x, y of a window; buttons 4 to 7 turn the wheel."""
        move = ("mousemove", "--window", str(window), str(x), str(y))
        self.run("xdotool", *move, "click", *NO_DELAY, str(button))

    def resize(self, window: int, width: int, height: int) -> None:
        self.run("xdotool", "windowsize", str(window), str(width), str(height))
        until(lambda: self.size(window) == (width, height), f"a window of {width}x{height}")

    def size(self, window: int) -> tuple[int, int]:
        lines = self.run("xdotool", "getwindowgeometry", "--shell", str(window)).decode().splitlines()
        values = dict(line.split("=") for line in lines)
        return int(values["WIDTH"]), int(values["HEIGHT"])

    def minimise(self, window: int) -> None:
        """Minimise a window and wait until the window manager has done it.

        The window manager ignores about one request of a hundred that follow a click, so requests are repeated.
        """

        def is_minimised() -> bool:
            self.run("xdotool", "windowminimize", str(window))
            return not self._is_shown(window) and self._active() != window

        until(is_minimised, f"minimised window {window}")

    def restore(self, window: int) -> None:
        """Bring back a minimised window and wait until it is shown and has the focus."""

        def is_restored() -> bool:
            self.activate(window)
            return self._is_shown(window)

        until(is_restored, f"restored window {window}")

    def close_button(self, window: int) -> None:
        self.run("wmctrl", "-i", "-c", hex(window))

    def exists(self, window: int) -> bool:
        return processes.run(["xwininfo", "-id", str(window)], env=self.environment).returncode == 0

    def screenshot(self, window: int) -> NDArray[np.uint8]:
        """Return the picture that a window shows: (h, w, 3) uint8, red, green, blue."""
        return pixels(self.run("xwd", "-silent", "-id", str(window)))

    @contextmanager
    def _cleanup(self) -> Iterator[None]:
        """Release all keys afterwards and, after the last program, wait until no window is left for the next test."""
        try:
            yield
        finally:
            self.release_keys()
            if not self._programs:
                until(self._is_empty, "the end of all windows")

    def _expect_program(self) -> None:
        """Fail at once, with the output of the programs, if none is left that could open a window."""
        if self._programs and all(process.poll() is not None for process in self._programs):
            for process in self._programs:
                processes.kill_group(process)  # its child processes may keep the pipes open
            results = [(process.returncode, *process.communicate()) for process in self._programs]
            raise AssertionError(f"no program is left that could open a window: {results}")

    def _is_empty(self) -> bool:
        with _closed_windows_ignored():
            return not self.windows()
        return False

    def _active(self) -> int | None:
        """The window that has the focus, or None."""
        with suppress(subprocess.CalledProcessError):  # no window has the focus
            return int(self.run("xdotool", "getactivewindow"))
        return None

    def _is_shown(self, window: int) -> bool:
        return b"Map State: IsViewable" in self.run("xwininfo", "-id", str(window))


@contextmanager
def _closed_windows_ignored() -> Iterator[None]:
    """Leave the block if one of its windows is closed meanwhile, which may happen at any time."""
    try:
        yield
    except subprocess.CalledProcessError as error:
        if not re.search(rb"Bad(Window|Drawable)", error.stderr):  # which of the two depends on the moment
            raise


@pytest.fixture(scope="session")
def desktop() -> Iterator[Desktop]:
    """Fixture: one desktop for all tests of the session."""
    require_tools()
    with open_desktop() as opened:
        yield opened


def require_tools() -> None:
    """Skip the test if tools are missing, or fail it in continuous integration."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        skip_incomplete(f"tests of real windows need {', '.join(missing)}; install them: {install_command('xvfb')}")


@contextmanager
def open_desktop() -> Iterator[Desktop]:
    """Start an X server with a free display number, and a window manager on it; both end with the block."""
    with ExitStack() as stack:
        home = stack.enter_context(tempfile.TemporaryDirectory())  # so that the user's configuration is not read
        (Path(home) / "openbox").mkdir()
        (Path(home) / "openbox" / "rc.xml").write_text(OPENBOX_CONFIG)
        environment = {key: value for key, value in os.environ.items() if key != "WAYLAND_DISPLAY"}
        environment |= {"PYTHONPATH": str(ROOT), "XDG_CONFIG_HOME": home}
        environment["DISPLAY"], _ = stack.enter_context(display())
        command = ["openbox", "--sm-disable"]
        manager = stack.enter_context(_server(command, env=environment | {"XDG_CACHE_HOME": home}))
        opened = Desktop(environment | {MANAGER_VARIABLE: str(manager.pid)})
        until(lambda: opened.is_managed() or manager.poll() is not None, "openbox")
        if manager.poll() is not None:
            raise RuntimeError("openbox did not start")
        yield opened


@contextmanager
def display(size: tuple[int, int] = SCREEN, *options: str) -> Iterator[tuple[str, int]]:
    """Start an X server and return its display name and its process id; it ends with the block.

    Its keyboard does not repeat held keys: on a busy machine the time between a press and its release may be so long
    that a key would repeat. Tests of key repeat turn it on.
    """
    with ExitStack() as stack:
        reader, writer = os.pipe()
        number = stack.enter_context(os.fdopen(reader))
        with os.fdopen(writer):
            command = ["Xvfb", *options, "-displayfd", str(writer), "-screen", "0", "{}x{}x24".format(*size)]
            command += ["-nolisten", "tcp", "-noreset"]  # else it restarts when its last client leaves
            command += ["-r", "-ardelay", "100", "-arinterval", "20"]  # milliseconds, if a test turns key repeat on
            server = stack.enter_context(_server(command, pass_fds=(writer,)))
        # Xvfb writes its number when it is ready, or closes the pipe when it ends.
        until(lambda: bool(select.select([number], [], [], 0)[0]), "Xvfb's display number")
        name = number.readline().strip()
        if not name:
            raise RuntimeError("Xvfb did not start")
        yield f":{name}", server.pid


@contextmanager
def _server(command: list[str], **options: Any) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program, which is terminated before it is killed, so that it can remove its files."""
    with processes.started(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options) as process:
        try:
            yield process
        finally:
            process.terminate()
            process.send_signal(signal.SIGCONT)  # a test that was killed may have left it stopped
            process.wait(HANG_LIMIT)


def pixels(dump: bytes | NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Decode the X Window Dump format: a header of big-endian words, a colour table, rows of 32-bit pixels."""
    header = np.frombuffer(dump, ">u4", 25)
    header_size, width, height, row_size, colors = (int(header[i]) for i in (0, 4, 5, 12, 19))
    if header[11] != 32 or header[7] != 0:  # bits per pixel; byte order, 0 is least significant first
        raise ValueError("the window's pixels are not 32-bit BGRX")
    rows = np.frombuffer(dump, np.uint8, offset=header_size + 12 * colors, count=row_size * height)
    return rows.reshape(height, row_size)[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]
