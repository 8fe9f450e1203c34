"""Regular files are read whole, with memory for their own size and not for the largest that is allowed."""

from __future__ import annotations

import os
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from minirt.errors import FileError
from minirt.helpers import file_io

LARGEST = 2**26


def peak(read: Callable[[], bytes]) -> int:
    """Return how many bytes a reader reserves at most."""
    tracemalloc.start()
    try:
        read()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_small_file_needs_little_memory(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(bytes(1000))
    assert file_io.read(path, LARGEST) == bytes(1000)
    assert peak(lambda: file_io.read(path, LARGEST)) < 2**20
    with path.open("rb") as file:
        assert peak(lambda: file.read(LARGEST)) > LARGEST  # so the check notices


@pytest.mark.parametrize("size", [0, 1, 999, 1000, 1001])
def test_files_up_to_the_limit_are_read_whole(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a"
    path.write_bytes(os.urandom(size))
    if size <= 1000:
        assert file_io.read(path, 1000) == path.read_bytes()
    else:
        with pytest.raises(FileError, match="larger than"):
            file_io.read(path, 1000)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
@pytest.mark.parametrize("first", [b"", b"a"])
def test_a_file_whose_bytes_do_not_come_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: bytes
) -> None:
    """As /proc/kmsg, a regular file of length 0, whose reader waits for the next message of the kernel."""
    path = tmp_path / "a"
    os.mkfifo(path)
    monkeypatch.setattr(file_io, "check_regular", lambda path, status, largest: status)
    with path.open("r+b", buffering=0) as writer:
        writer.write(first)
        with pytest.raises(FileError) as caught:
            file_io.read(path, 1000)
    assert caught.value.reason == "cannot be read: resource temporarily unavailable"


@pytest.mark.parametrize(("told", "largest", "fits"), [(0, 5000, True), (10, 5000, True), (10, 1999, False)])
def test_a_file_that_grows_while_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, told: int, largest: int, fits: bool
) -> None:
    path = tmp_path / "a"
    path.write_bytes(bytes(2000))
    real = file_io.check_regular

    def before_it_grew(path: Any, status: os.stat_result, largest: int) -> os.stat_result:
        values = list(real(path, status, 2**40))
        values[6] = told  # st_size
        return os.stat_result(values)

    monkeypatch.setattr(file_io, "check_regular", before_it_grew)
    if fits:
        assert file_io.read(path, largest) == bytes(2000)
    else:
        with pytest.raises(FileError, match="larger than"):
            file_io.read(path, largest)
