"""The tests run alike in every environment: in a read-only home, with Ctrl+C ignored."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests import conftest, environment
from tests.lines import next_line
from tests.paths import ROOT
from tests.processes import started
from tests.waiting import HANG_LIMIT

CHILD = [sys.executable, "-c", "import signal; signal.pause()"]
PARENT = f"""
import signal, subprocess
child = subprocess.Popen({CHILD}, close_fds=False)
print("both run", flush=True)
signal.pause()
"""


def prepared(monkeypatch: pytest.MonkeyPatch, **variables: str) -> dict[str, str]:
    """Return these environment variables as `prepare` completes them."""
    monkeypatch.setattr(os, "environ", variables)
    environment.prepare()
    for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):  # journals and defaults of tests are not the user's
        assert variables.pop(name).startswith(str(ROOT / "out"))
    return variables


def test_kernels_are_cached_in_the_folder_of_the_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert prepared(monkeypatch, XDG_CACHE_HOME=str(tmp_path)) == {"XDG_CACHE_HOME": str(tmp_path)}
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "me")
    assert prepared(monkeypatch) == {}
    assert list(tmp_path.iterdir()) == [tmp_path / "me"]


def test_kernels_are_cached_beside_the_sources_if_that_folder_cannot_be_written(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    instead = {"XDG_CACHE_HOME": str(ROOT / "out" / "cache")}
    assert prepared(monkeypatch, XDG_CACHE_HOME=str(tmp_path / "file")) == instead

    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", homeless)
    assert prepared(monkeypatch) == instead


def test_ctrl_c_reaches_the_tests_if_the_caller_ignores_it() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        conftest.pytest_configure()
        with started([sys.executable, "-c", "import sys; print('ready', flush=True); sys.stdin.read()"],
                     stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:  # fmt: skip
            next_line(process)
            process.send_signal(signal.SIGINT)
            assert process.communicate(timeout=HANG_LIMIT)[0] == b""
        assert process.returncode == -signal.SIGINT
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_program_whose_block_fails_leaves_nothing_running() -> None:
    """Parent and child hold one end of a pipe; the other end sees when both are gone."""
    reader, writer = os.pipe()

    def failing_block() -> None:
        with started([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, pass_fds=(writer,)) as parent:
            next_line(parent)
            os.close(writer)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        failing_block()
    with os.fdopen(reader, "rb") as file:
        assert file.read() == b""
