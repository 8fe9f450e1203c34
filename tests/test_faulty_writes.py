"""A full disk, an I/O error or a kill at any write of a picture, a film, a scene or a report: old files or new ones.

`python -m tests.fuzz.faults` tries all writes; here some of each sort of file are tried.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.faulty_files import CODES, faulty_files, short
from tests.fuzz import faults
from tests.fuzz.faults import Writer, writers

WRITERS = writers()
SOME = 2  # writes of a sort of file that fail

every_writer = pytest.mark.parametrize("writer", WRITERS.values(), ids=list(WRITERS))
needs_forks = pytest.mark.skipif(sys.platform == "win32", reason="there are no forks")


@needs_forks
@every_writer
def test_a_kill_at_a_write_leaves_old_or_new_files_and_the_next_run_clears_up(writer: Writer, tmp_path: Path) -> None:
    assert faults.tried_kills(writer, tmp_path, SOME) > 0


@every_writer
def test_an_error_at_a_write_is_told_and_leaves_old_or_new_files(
    writer: Writer, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert faults.tried_errors(writer, tmp_path, SOME, CODES) > 0
    assert capfd.readouterr() == ("", ""), "libraries print nothing of their own"


@pytest.mark.parametrize("name", [name for name in ("MP4 film", "WEBM film") if name in WRITERS])
def test_no_error_at_any_write_makes_pyav_print_a_traceback(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert faults.tried_errors(WRITERS[name], tmp_path, 100, CODES) > SOME
    assert capfd.readouterr() == ("", "")


@every_writer
def test_short_writes_are_gone_on_with(writer: Writer, tmp_path: Path) -> None:
    whole = faults.written(writer, tmp_path / "whole")
    with faulty_files(short):
        assert faults.written(writer, tmp_path / "short") == whole
