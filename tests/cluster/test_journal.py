"""Journals of unfinished work: a torn end is cut, and what cannot be read or written is one sentence or no matter."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest

from minirt.cluster.job import Job, Strips
from minirt.cluster.journal import Journal
from minirt.errors import RenderError
from minirt.rendering.settings import RenderSettings
from tests.cluster.scenes import BALL

WORK = "a film"


def band(number: int) -> Job:
    """Return a band with a number."""
    return Job(BALL, (8, 6), RenderSettings(), number)


def strips(number: int) -> Strips:
    """Return what is made of a band: 100 bytes."""
    return Strips((bytes([number]) * 100,), None)


def interrupted(output: Path, *numbers: int) -> list[int]:
    """Keep bands of these numbers, unless they are kept, until an interrupt; return the numbers of all that were kept
    before."""
    with pytest.raises(KeyboardInterrupt), Journal(output, WORK) as journal:  # noqa: PT012
        before = sorted(journal.places)
        assert [journal.restore(band(each)) for each in before] == [strips(each) for each in before]
        for each in numbers:
            journal.keep(each, strips(each), 1e9)
        raise KeyboardInterrupt
    return before


@pytest.mark.parametrize("cut", [1, 99, 130])
def test_what_is_kept_after_a_torn_end_is_found_again(tmp_path: Path, cut: int) -> None:
    """A program that was killed leaves a torn record, over which the next one writes."""
    output, file = tmp_path / "x.gif", tmp_path / ".x.gif.journal"
    interrupted(output, 0, 1, 2)
    file.write_bytes(file.read_bytes()[:-cut])
    assert interrupted(output, 3, 4) == [0, 1]
    assert interrupted(output) == [0, 1, 3, 4]


def make_faulty(patch: pytest.MonkeyPatch, name: str) -> None:
    """Let a method of all files that are opened fail with EIO."""

    class File:
        def __init__(self, file: Any) -> None:
            self.file = file

        def __getattr__(self, asked: str) -> Any:
            if asked == name:
                raise OSError(errno.EIO, os.strerror(errno.EIO))
            return getattr(self.file, asked)

    opened = Path.open
    patch.setattr(Path, "open", lambda *given, **how: File(opened(*given, **how)))


@pytest.mark.parametrize("failing", ["read", "seek", "truncate", "tell"])
def test_a_journal_that_cannot_be_read_is_one_sentence(
    tmp_path: Path, failing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    output = tmp_path / "x.gif"
    interrupted(output, 0, 1)
    with monkeypatch.context() as patch, pytest.raises(RenderError) as caught:  # noqa: PT012
        make_faulty(patch, failing)
        with Journal(output, WORK) as journal:
            journal.restore(band(1))
    assert str(caught.value) == f"{tmp_path / '.x.gif.journal'}: cannot be read: Input/output error"
    assert interrupted(output) == [0, 1]


def test_a_disk_that_is_full_ends_keeping_and_not_reading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Data that the disk has not taken is not written again by the next read."""
    output = tmp_path / "x.gif"
    interrupted(output, 0, 1)
    resource = pytest.importorskip("resource", reason="no limit of the size of files")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    size = (tmp_path / ".x.gif.journal").stat().st_size
    with Journal(output, WORK) as journal:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 50, before[1]))
        try:
            journal.keep(2, strips(2), 1e9)
            assert journal.restore(band(1)) == strips(1)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert not list(tmp_path.iterdir())
