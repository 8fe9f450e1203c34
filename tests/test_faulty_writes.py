"""A full disk, an I/O error or short writes while a report or a film is written: old or new files."""

from __future__ import annotations

import errno
import io
import os
import random
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt.errors import MiniRTError
from minirt.formats.table import is_installed
from minirt.helpers import file_io
from minirt.helpers.file_io import writing
from minirt.movie import save_movie
from minirt.rendering.image import Image
from minirt.report.document import write_files
from tests.formats.pictures import picture
from tests.report.made_up import FINDINGS, ROWS

Writer = Callable[[Path], object]  # writes into an empty folder, or one in which it has written before
Fault = Callable[[memoryview], memoryview]  # gets the data of a write, and returns what is written

BUFFER = 256  # bytes of the largest write, so that even a small file takes several
CODES = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG)
BLACK = np.zeros((20, 32, 3))
OLD = b"old"


def film(suffix: str) -> Writer:
    """Return a writer of a film, or of numbered pictures."""

    def write(folder: Path) -> None:
        levels = picture(18, 32).array
        save_movie((Image(np.roll(levels, 5 * n, axis=1)) for n in range(4)), folder / f"film{suffix}")

    return write


WRITERS: dict[str, Writer] = {  # what `tests/faults` does not write
    "report": lambda folder: write_files(folder, FINDINGS, {ROWS[0].name: BLACK}, BLACK),
    "exr": lambda folder: picture(18, 32).save(folder / "still.exr"),
    ".webp": film(".webp"),
    **({".mp4": film(".mp4")} if is_installed("MP4") else {}),
}
every_writer = pytest.mark.parametrize("writer", WRITERS.values(), ids=list(WRITERS))


class FaultyFile(io.FileIO):
    """A file whose writes suffer from a fault."""

    fault: Fault

    def write(self, data: Any) -> int:
        """Write what the fault leaves of the first bytes."""
        return super().write(self.fault(memoryview(data).cast("B")[:BUFFER]))


@contextmanager
def faulty_files(fault: Fault) -> Iterator[None]:
    """Let all writes to files that this thread opens by their descriptors suffer from a fault."""

    def open_faulty(descriptor: int, mode: str = "r", *others: Any, **named: Any) -> Any:
        if mode != "wb":
            return fdopen(descriptor, mode, *others, **named)
        raw = FaultyFile(descriptor, "wb")
        raw.fault = fault
        return io.BufferedWriter(raw, BUFFER)

    fdopen = os.fdopen
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fdopen", open_faulty)
        yield


def short(data: memoryview) -> memoryview:
    """Write a part only, as interrupted by a signal."""
    return data[: len(data) - 1] if len(data) % 5 == 4 else data[: -(-len(data) // 3)]


def contents(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder; of an MP4 film, whose bytes differ at times, the number of pictures."""
    return {each.name: comparable(each) for each in sorted(folder.iterdir())}


def comparable(file: Path) -> bytes:
    """Return the contents of a file, and of a film what encoders do not vary."""
    data = file.read_bytes()
    if file.suffix not in (".mp4", ".webm") or data == OLD:
        return data
    import av

    with av.open(io.BytesIO(data)) as film:
        return f"{sum(1 for _ in film.decode(video=0))} pictures".encode()


def written(writer: Writer, folder: Path) -> dict[str, bytes]:
    """Let a writer write into a new folder; return its files."""
    folder.mkdir()
    writer(folder)
    return contents(folder)


def count_writes(writer: Writer, folder: Path) -> int:
    """Return the number of writes to files of a writer."""
    counted: list[int] = []

    def note(data: memoryview) -> memoryview:
        counted.append(len(data))
        return data

    with faulty_files(note):
        written(writer, folder)
    return len(counted)


@every_writer
def test_an_error_at_a_write_is_told_and_leaves_old_or_new_files(
    writer: Writer, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """At the last write, and at one of those before; as on a full disk all that follow fail, too."""
    new, last = written(writer, tmp_path / "new"), count_writes(writer, tmp_path / "counted") - 1
    assert last >= 0
    for number, code in zip({last, random.Random(last).randint(0, last)}, CODES, strict=False):
        left = number

        def fail(data: memoryview, code: int = code) -> memoryview:
            nonlocal left
            left -= 1
            if left < 0:
                raise OSError(code, os.strerror(code))
            return data

        work = tmp_path / str(number)
        work.mkdir()
        for name in new:
            (work / name).write_bytes(OLD)
        with faulty_files(fail), pytest.raises(MiniRTError, match=f"(?i){os.strerror(code)}") as caught:
            writer(work)
        found = contents(work)
        kept = [name for name in found.keys() - new.keys() if found.pop(name)]
        assert all(f" kept in {work / name}; " in caught.value.__notes__[0] for name in kept)
        assert found.keys() == new.keys()
        assert all(data in (OLD, new[name]) for name, data in found.items())
    assert capfd.readouterr() == ("", ""), "libraries print nothing of their own"


@every_writer
def test_short_writes_are_gone_on_with(writer: Writer, tmp_path: Path) -> None:
    whole = written(writer, tmp_path / "whole")
    with faulty_files(short):
        assert written(writer, tmp_path / "short") == whole


def test_old_temporary_files_of_killed_programs_are_swept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only they: not those that a program may still write, other names, folders, nor what a link leads to."""
    monkeypatch.setattr(writing, "SWEPT", set())
    folder, elsewhere = tmp_path / "work", tmp_path / "elsewhere"
    names = [writing.TEMPORARY.replace("*", f"{number:016x}") for number in range(4)]
    old, young, is_link, is_folder = (folder / each for each in names)
    others = [folder / each for each in ("scene.rt", ".minirt-1.tmp", f"{names[0]}~", names[0].replace("0", "g"))]
    folder.mkdir()
    for each in (old, young, elsewhere, *others):
        each.write_bytes(OLD)
    is_link.symlink_to(elsewhere)
    is_folder.mkdir()
    for each in (old, elsewhere, is_folder, *others):
        os.utime(each, (1000, 1000))
    file_io.create(folder / "new", b"new")
    assert {*folder.iterdir()} == {young, is_link, is_folder, *others, folder / "new"}
    assert elsewhere.read_bytes() == OLD


def test_a_folder_is_searched_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A film of many pictures does not read its folder for each. A folder that cannot be read does not matter."""
    searched: list[str] = []

    def scan(folder: str) -> Any:
        searched.append(folder)
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(os, "scandir", scan)
    for number in range(3):
        file_io.write(tmp_path / f"{number}", b"new")
    assert searched == [str(tmp_path)]


def test_a_failing_disk_does_not_keep_a_lock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux closes a file even where it reports an error."""
    close = os.close

    def failing(descriptor: int) -> None:
        close(descriptor)
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    first, second = (os.open(tmp_path / "lock", os.O_RDWR | os.O_CREAT) for _ in range(2))
    assert file_io.lock(first)
    assert sys.platform == "win32" or not file_io.lock(second)
    with monkeypatch.context() as patch:
        patch.setattr(os, "close", failing)
        file_io.unlock(first)
    assert file_io.lock(second)
    os.close(second)
