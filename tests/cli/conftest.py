"""A folder with a scene in it, and the program inside of this process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from minirt import cli
from tests.cli.program import SCENE, Ended


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with ball.rt in it."""
    (tmp_path / "ball.rt").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(folder: Path, capsysbinary: pytest.CaptureFixture[bytes]) -> Callable[..., Ended]:
    """Call the program with arguments."""

    def call(*arguments: str) -> Ended:
        try:
            status = cli.main(arguments)
        except SystemExit as exit:  # argparse leaves so
            status = exit.code
        out, err = capsysbinary.readouterr()
        return Ended(status, out, err.decode())

    return call
