"""A program that is killed at any moment of writing leaves the old file or the new one, never a part."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from minirt.helpers import file_io
from tests.processes import in_child

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no forks")

OLD, NEW = b"old " * 1000, b"new one " * 2000


def kill_at_each_line(work: Callable[[], object], modules: tuple[str, ...]) -> Iterator[int]:
    """Do the work in child processes; yield after each: the first is killed before the first line of the modules, the
    second before the second line, and so on until one ends by itself."""
    number = 0
    while is_killed(work, modules, number):
        yield number
        number += 1
    assert number > 10, "the work hardly runs any lines of these modules"
    yield number


def is_killed(work: Callable[[], object], modules: tuple[str, ...], number: int) -> bool:
    """Do the work in a child process that kills itself before line `number`; False where it ended before that."""

    def traced() -> None:
        sys.settrace(killer(modules, number))
        work()

    status = in_child(traced)
    assert status in (0, -signal.SIGKILL), "the work failed"
    return status != 0


def killer(modules: tuple[str, ...], number: int) -> Callable[[FrameType, str, Any], Any]:
    """Return a trace function that kills its process before a line of these modules, the first of which is 0."""
    left = number

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal left
        if frame.f_globals.get("__name__", "").rpartition(".")[2] not in modules:
            return None
        if event == "line":
            if not left:
                os.kill(os.getpid(), signal.SIGKILL)
            left -= 1
        return trace

    return trace


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
