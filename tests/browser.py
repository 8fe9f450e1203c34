"""A real browser without a window, driven through the pipe of the Chrome DevTools Protocol.

https://chromedevtools.github.io/devtools-protocol documents the methods and the events.
"""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.processes import started
from tests.skipping import install_command, skip_incomplete
from tests.waiting import HANG_LIMIT

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--no-first-run",
    "--disable-gpu",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)
IN_PIPES = 'exec "$0" "${@:3}" 3<&"$1" 4>&"$2"'  # the browser reads commands from 3 and writes answers to 4
SILENT = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
Message = dict[str, Any]


class Page:
    """A tab of the browser, which has no network, and what it has complained about and asked for."""

    def __init__(self, reader: int, writer: int) -> None:
        self.reader, self.writer = reader, writer
        self.unread = b""
        self.number = 0
        self.session: str | None = None
        self.complaints: list[str] = []  # errors and warnings of the console, exceptions
        self.requests: list[str] = []  # addresses that the page has asked for
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)

    def open(self, file: Path, width: int = 1000, height: int = 800, is_dark: bool = False) -> None:
        """Open a file in a window of the given size, and wait until it has loaded."""
        self.complaints, self.requests = [], []
        scheme = {"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600
        )
        self.call("Page.navigate", url=file.as_uri())
        self.receive(lambda message: message.get("method") == "Page.loadEventFired")

    def value(self, script: str) -> Any:
        """Return the value of a JavaScript expression."""
        found = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Press the mouse at one point of the window and release it at another."""
        for sort, (x, y), held in (("Pressed", start, 1), ("Moved", end, 1), ("Released", end, 0)):
            self.call(
                "Input.dispatchMouseEvent", type=f"mouse{sort}", x=x, y=y, button="left", buttons=held, clickCount=1
            )

    def press(self, key: str, code: int) -> None:
        """Press and release a key; `code` is that of `KeyboardEvent.keyCode`."""
        for sort in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=sort, key=key, code=key, windowsVirtualKeyCode=code)

    def screenshot(self) -> bytes:
        """Return the window as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot")["data"])

    def call(self, method: str, **parameters: Any) -> Message:
        """Call a method of the protocol and return its result."""
        self.number += 1
        number, session = self.number, {"sessionId": self.session} if self.session else {}
        message = {"id": number, "method": method, "params": parameters} | session
        os.write(self.writer, json.dumps(message).encode() + b"\0")
        answer = self.receive(lambda message: message.get("id") == number)
        assert "error" not in answer, answer
        result: Message = answer["result"]
        return result

    def receive(self, is_wanted: Callable[[Message], bool]) -> Message:
        """Wait for a message, and note what others say until then."""
        while True:
            while b"\0" not in self.unread:
                assert select.select([self.reader], [], [], HANG_LIMIT)[0], "the browser is silent"
                more = os.read(self.reader, 65536)
                assert more, "the browser has ended"
                self.unread += more
            text, _, self.unread = self.unread.partition(b"\0")
            message = json.loads(text)
            self.note(message)
            if is_wanted(message):
                return message

    def note(self, message: Message) -> None:
        """Keep the requests of the page and the complaints about it."""
        parameters = message.get("params", {})
        match message.get("method"):
            case "Network.requestWillBeSent":
                self.requests.append(parameters["request"]["url"])
            case "Runtime.exceptionThrown" | "Log.entryAdded":
                self.complaints.append(json.dumps(parameters))
            case "Runtime.consoleAPICalled" if parameters["type"] in ("error", "warning", "assert"):
                self.complaints.append(json.dumps(parameters))


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """Fixture: one page of one browser for all tests of the session."""
    with open_browser(require_browser(), tmp_path_factory.mktemp("browser")) as opened:
        yield opened


def require_browser() -> str:
    """Return the browser's command. Without one skip the test, or fail it in continuous integration."""
    found = [name for name in NAMES if shutil.which(name)]
    if not found:
        skip_incomplete(f"needs Chromium or Chrome; install it: {install_command('chromium')}")
    return found[0]


@contextmanager
def open_browser(command: str, home: Path) -> Iterator[Page]:
    """Start a browser, which keeps its files in a folder, and return its first page; it ends with the block."""
    (commands, writer), (reader, answers) = os.pipe(), os.pipe()
    shell = ["bash", "-c", IN_PIPES, command, str(commands), str(answers), *OPTIONS, f"--user-data-dir={home}"]
    with started(shell, pass_fds=(commands, answers), env=os.environ | {"HOME": str(home)}, **SILENT):
        os.close(commands)
        os.close(answers)
        try:
            yield Page(reader, writer)
        finally:
            os.close(reader)
            os.close(writer)
