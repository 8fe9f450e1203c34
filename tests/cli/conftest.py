"""Fixtures: a folder with a scene, and the program run inside this process."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt import cli
from tests.cli.program import SCENE, Result, Run


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which contains ball.rt."""
    (tmp_path / "ball.rt").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(folder: Path, capsysbinary: pytest.CaptureFixture[bytes]) -> Run:
    """A function that calls the program with arguments."""

    def call(*arguments: str) -> Result:
        try:
            status = cli.main(arguments)
        except SystemExit as exit:  # raised by argparse
            status = exit.code
        out, err = capsysbinary.readouterr()
        return Result(status, out, err.decode())

    return call
