"""A full disk, an I/O error or a kill at any write of a picture, a film, a scene or a report: old files or new ones.

`python -m tests.fuzz.faults` tries all writes; here some of each sort of file are tried.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.image import Image
from minirt.movie import encode_film
from tests.faulty_files import CODES, faulty_files, short
from tests.file_writers import Writer, writers
from tests.fuzz import faults

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


@pytest.mark.skipif("MP4 film" not in WRITERS, reason="needs PyAV")
def test_an_mp4_film_that_is_cut_off_or_lacks_a_picture_counts_as_another(tmp_path: Path) -> None:
    WRITERS["MP4 film"](tmp_path)
    film = (tmp_path / "film.mp4").read_bytes()
    pictures = [Image(np.zeros((18, 32, 3), np.uint8))] * 3
    others = [film[: len(film) * part // 10] for part in range(10)] + [film[:-1], encode_film(pictures, "MP4", 25)]
    assert faults.comparable("film.mp4", film) not in {faults.comparable("film.mp4", other) for other in others}


@every_writer
def test_short_writes_are_gone_on_with(writer: Writer, tmp_path: Path) -> None:
    whole = faults.written(writer, tmp_path / "whole")
    with faulty_files(short):
        assert faults.written(writer, tmp_path / "short") == whole


def in_place(folder: Path) -> None:
    """Write a file itself, as no writer here does."""
    try:
        with os.fdopen(os.open(folder / "file", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666), "wb") as file:
            file.write(b"new" * 1000)
    except OSError as error:
        raise RenderError(str(error)) from None


def deaf(folder: Path) -> None:
    """Write a file as a whole, and take no notice of errors."""
    with suppress(OSError):
        file_io.write(folder / "file", b"new" * 1000)


@needs_forks
def test_a_writer_in_place_would_be_found(tmp_path: Path) -> None:
    for number, tried in enumerate((faults.tried_kills, lambda *given: faults.tried_errors(*given, CODES))):
        (tmp_path / str(number)).mkdir()
        with pytest.raises(AssertionError, match="file is half written"):
            tried(in_place, tmp_path / str(number), SOME)


@needs_forks
def test_a_writer_that_hides_errors_would_be_found(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="the error was lost"):
        faults.tried_errors(deaf, tmp_path, SOME, CODES)


@needs_forks
def test_without_locks_the_next_run_would_not_clear_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_io, "is_free", lambda _: None)
    with pytest.raises(AssertionError, match="the next run does not clear up"):
        faults.tried_kills(WRITERS["scene"], tmp_path, SOME)
