"""A program that is killed at any moment of writing leaves the old file or the new one, never a part."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.helpers import file_io
from tests.killed import kill_at_each_line

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no forks")

OLD, NEW = b"old " * 1000, b"new one " * 2000


def contents_after_kills(write: Callable[[Path, bytes], object], path: Path, old: bytes | None) -> set[bytes | None]:
    """Return what a killed writer left at a path, over all moments; None for no file."""
    found: set[bytes | None] = set()
    for _ in kill_at_each_line(lambda: write(path, NEW), ("file_io", __name__.rpartition(".")[2])):
        found.add(path.read_bytes() if path.exists() else None)
        for each in path.parent.iterdir():
            assert each == path or each.match(file_io.TEMPORARY), f"{each} was left"
            each.unlink()
        if old is not None:
            path.write_bytes(old)
    return found


def test_a_file_is_replaced_as_a_whole(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    path.write_bytes(OLD)
    assert contents_after_kills(file_io.write, path, OLD) == {OLD, NEW}


def test_a_new_file_is_written_as_a_whole(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    assert contents_after_kills(file_io.write, path, None) == {None, NEW}
    path.unlink(missing_ok=True)
    assert contents_after_kills(file_io.create, path, None) == {None, NEW}


def test_the_next_writer_deletes_temporary_files_of_killed_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "scene.rt"
    monkeypatch.setattr(file_io, "CLEANED", set())
    for number in kill_at_each_line(lambda: file_io.write(path, NEW), ("file_io",)):
        if number > 30:
            break
    assert list(tmp_path.glob(file_io.TEMPORARY))
    file_io.write(path, NEW)
    assert list(tmp_path.iterdir()) == [path]
