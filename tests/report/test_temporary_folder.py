"""The temporary folder of a report ends with it; that of a killed program, with the next report."""

from __future__ import annotations

import os
import signal
import sys
import tempfile
from pathlib import Path

import pytest

from minirt.report.temporary_folder import PREFIX, temporary_folder
from tests.processes import in_child

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="folders cannot be locked there")


@pytest.fixture(autouse=True)
def parent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder in which temporary ones are made."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_the_folder_ends_with_the_block(parent: Path) -> None:
    with temporary_folder() as made:
        assert made.parent == parent
        (made / "file").touch()
    assert list(parent.iterdir()) == []


def test_the_folder_of_a_killed_program_is_deleted_by_the_next(parent: Path) -> None:

    def killed() -> None:
        with temporary_folder() as made:
            (made / "file").touch()
            os.kill(os.getpid(), signal.SIGKILL)

    assert in_child(killed) == -signal.SIGKILL
    (left,) = parent.iterdir()
    assert (left / "file").exists()
    with temporary_folder() as made:
        assert list(parent.iterdir()) == [made]


def test_folders_in_use_and_of_others_stay(parent: Path) -> None:
    (parent / "other").mkdir()
    (parent / f"{PREFIX}link").symlink_to(parent / "other")
    (parent / f"{PREFIX}file").touch()
    with temporary_folder() as first, temporary_folder() as second:
        assert {first, second} < set(parent.iterdir())
    assert len(list(parent.iterdir())) == 3
