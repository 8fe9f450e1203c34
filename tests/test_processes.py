"""Processes of tests that hang are ended, and tell where they hang."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from tests import processes, waiting

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork"),
    pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning"),  # what Python 3.12 says of a fork
]

HANGING = "import signal\ndef hang():\n    print('ready', flush=True)\n    signal.pause()\nhang()\n"
STACK = ' in hang\n  File "<string>", line 5 in <module>'


def test_a_child_that_hangs_is_ended_and_tells_where(monkeypatch: pytest.MonkeyPatch) -> None:
    reader, writer = os.pipe()

    def hang_for_ever() -> None:
        os.write(writer, b"!")
        signal.pause()

    wait = processes.fork(hang_for_ever)
    assert os.read(reader, 1) == b"!"
    monkeypatch.setattr(waiting, "HANG_LIMIT", 0.01)
    with pytest.raises(TimeoutError, match="in hang_for_ever"):
        wait()
    os.close(reader)
    os.close(writer)


@pytest.mark.parametrize("error", [TimeoutError(), subprocess.TimeoutExpired(["program"], waiting.HANG_LIMIT)])
def test_a_program_that_hangs_is_ended_and_tells_where(error: Exception) -> None:
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with pytest.raises(type(error)), processes.started([sys.executable, "-c", HANGING], **pipes) as program:  # noqa: PT012
        assert program.stdout.readline() == b"ready\n"
        raise error
    assert STACK in "".join(error.__notes__)
    assert program.returncode == -signal.SIGABRT


def fail() -> None:
    """Fail, as a test does."""
    raise AssertionError


@pytest.mark.parametrize(
    ("work", "status"),
    [(list, 0), (fail, 1), (lambda: os.kill(os.getpid(), signal.SIGKILL), -signal.SIGKILL), (lambda: os._exit(7), 7)],
)
def test_the_status_of_a_child_tells_how_it_ended(work, status) -> None:
    assert processes.in_child(work) == status
