"""All sources are found in a fixed order, and nothing else."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from minirt.kernel.machine_code import cache_folder
from minirt.kernel.machine_code.source_files import source_files


def test_sources_are_found_in_subfolders_and_other_files_are_not(tmp_path: Path) -> None:
    for name in ("b.py", "a.py", "sub/c.py", "sub/deep/d.py", "sub/page.md", "a.pyc", "__pycache__/a.pyc"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    names = ["lanes/a.py", "lanes/b.py", "lanes/sub/c.py", "lanes/sub/deep/d.py"]
    assert list(source_files(tmp_path, "lanes")) == [(name, name.removeprefix("lanes/").encode()) for name in names]


def test_the_order_is_not_that_of_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in "dacb":
        (tmp_path / f"{name}.py").touch()
    scan, orders = os.scandir, []
    for seed in range(5):
        shuffled = sorted(scan(tmp_path), key=lambda entry: entry.name)
        random.Random(seed).shuffle(shuffled)
        monkeypatch.setattr(os, "scandir", lambda _, entries=shuffled: iter(entries))
        orders.append([name for name, _ in source_files(tmp_path, "x")])
    assert orders == [["x/a.py", "x/b.py", "x/c.py", "x/d.py"]] * 5


def test_they_are_the_sources_of_a_kernel() -> None:
    for folder in cache_folder.SOURCES:
        expected = {
            path.relative_to(cache_folder.PACKAGE).as_posix() for path in (cache_folder.PACKAGE / folder).rglob("*.py")
        }
        assert {name for name, _ in source_files(cache_folder.PACKAGE / folder, folder)} == expected
