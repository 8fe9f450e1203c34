"""Run the scenarios of contract_input, contract_picture and contract_loop on both back ends."""

from __future__ import annotations

import json
import subprocess
import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from tests.lines import next_line
from tests.mlx.contract import load, run_scenario
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from types import TracebackType
    from typing import Self

    from tests.mlx.contract import Log
    from tests.windows import Desktop


COMMAND = (sys.executable, "-W", "error", "-m", "tests.mlx.contract")


class ScenarioProcess:
    """One process for all scenarios; after a failed scenario the next one gets a new process.

    errors: file for the standard error of the process.
    """

    def __init__(self, desktop: Desktop, errors: Path) -> None:
        self._desktop = desktop
        self._errors = errors
        self._process: subprocess.Popen[str] | None = None
        self._exit_stack = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: BaseException | TracebackType | None) -> None:
        """End the process, and expect status 0 and no errors."""
        with self._exit_stack:
            if self._process is not None and kind is None:
                assert self._process.stdin is not None
                self._process.stdin.close()
                assert (self._process.wait(HANG_LIMIT), self._errors.read_text()) == (0, "")

    def run(self, name: str) -> Log:
        """Run a scenario and return its log. AssertionError if the process ends or writes errors."""
        try:
            log = self._ask(name)
            assert self._errors.read_text() == ""
        except BaseException:
            self._stop()
            raise
        if log != load()[name].log:
            self._stop()
        return log

    def _ask(self, name: str) -> Log:
        """Send the name and wait for the log. The process has a time limit of its own: it answers or ends."""
        process = self._process or self._start()
        assert process.stdin is not None
        process.stdin.write(f"{name}\n")
        process.stdin.flush()
        try:
            log: Log = json.loads(next_line(process))
        except EOFError:
            raise AssertionError(f"{name} ended the process: {self._errors.read_text()}") from None
        return log

    def _start(self) -> subprocess.Popen[str]:
        errors = self._exit_stack.enter_context(self._errors.open("w"))
        program = self._desktop.program(*COMMAND, stdin=subprocess.PIPE, stderr=errors)
        self._process = self._exit_stack.enter_context(program)
        return self._process

    def _stop(self) -> None:
        self._process = None
        self._exit_stack.close()


@pytest.fixture(scope="module")
def scenario_process(desktop: Desktop, tmp_path_factory: pytest.TempPathFactory) -> Iterator[ScenarioProcess]:
    """One process for all scenarios on the screen."""
    folder: Path = tmp_path_factory.mktemp("process")
    with ScenarioProcess(desktop, folder / "errors") as started:
        yield started


@pytest.mark.parametrize("name", load())
def test_memory(name: str) -> None:
    assert run_scenario(name, Mlx(Memory(patience=HANG_LIMIT))) == load()[name].log


@pytest.mark.window
@pytest.mark.parametrize("name", load())
def test_screen(name: str, scenario_process: ScenarioProcess) -> None:
    assert scenario_process.run(name) == load()[name].log
