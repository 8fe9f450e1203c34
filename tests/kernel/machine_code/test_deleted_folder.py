"""Another program deletes the folder of kernels at any moment, or parts of it: kernels are right all the same.

So does a program of another version, which forgets old folders beside a program that uses one.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from minirt.kernel.machine_code import cache_folder
from tests.kernel.machine_code.small_kernels import double, is_found, square

MODULES = ("file_io", "cache_folder", "code_cache", "container", "library", "private_files")


def delete_all(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


def delete_files(folder: Path) -> None:
    for each in folder.glob("**/*"):
        if each.is_file():
            each.unlink()


def delete_key(folder: Path) -> None:
    (folder / "key").unlink(missing_ok=True)


def delete_kernels(folder: Path) -> None:
    for each in folder.glob("*.kernel"):
        each.unlink()


def at_each_line(work: Callable[[], object], act: Callable[[], object]) -> Iterator[None]:
    """Do the work again and again; yield after each: another program acts before the first line of the modules, then
    before the second line, and so on until the work ends before that."""
    number, left = 0, -1

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal left
        if frame.f_globals.get("__name__", "").rpartition(".")[2] not in MODULES:
            return None
        if event == "line":
            left -= 1
            if left == -1:
                act()
        return trace

    while left < 0:
        left, before = number, sys.gettrace()
        sys.settrace(trace)
        try:
            work()
        finally:
            sys.settrace(before)
        yield
        number += 1
    assert number > 10, "the work hardly runs any lines of these modules"


@pytest.mark.parametrize("act", [delete_all, delete_files, delete_key, delete_kernels])
@pytest.mark.parametrize("is_kept", [True, False])
def test_kernels_are_right_whenever_their_folder_is_deleted(
    tmp_path: Path, act: Callable[[Path], object], is_kept: bool
) -> None:
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    assert (is_found(double, folder), is_found(square, folder)) == (False, False)
    for _ in at_each_line(lambda: is_found(double, folder), lambda: act(folder)):
        folder.mkdir(mode=0o700, exist_ok=True)
        is_found(double, folder)
        is_found(square, folder)
        assert is_found(double, folder), "what the deletion leaves is a folder like any other"
        if not is_kept:
            delete_kernels(folder)


def test_the_folder_is_made_or_missed_whenever_it_is_deleted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    found: set[bool] = set()
    for _ in at_each_line(lambda: found.add(cache_folder.folder() is None), lambda: delete_all(cache)):
        folder = cache_folder.folder()
        assert folder is not None
        assert folder.is_dir()
        for age in range(cache_folder.OTHER_VERSIONS + 2):
            (folder.parent / f"kernels-{age}").mkdir(exist_ok=True)
    assert found == {False, True}
