"""A full disk, an I/O error or a kill at a write of a picture, a film, a scene or a report: old files or new ones."""

from __future__ import annotations

import io
import os
import random
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import MiniRTError
from minirt.formats.table import FORMATS, is_installed
from minirt.helpers import file_io
from minirt.movie import save_movie
from minirt.rendering.image import Image
from minirt.report.document import write_files
from minirt.scene import parse
from tests.faulty_files import CODES, counting, failing_at, faulty_files, is_killed_at, short
from tests.formats.pictures import picture
from tests.report.made_up import FINDINGS, ROWS

Writer = Callable[[Path], object]  # writes into an empty folder, or one in which it has written before

SIZE = HEIGHT, WIDTH = 18, 32
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\n" + "".join(f"sp 0,0,{n} 4 10,20,30\n" for n in range(5, 90))
BLACK = np.zeros((20, 32, 3))


def still(suffix: str) -> Writer:
    """Return a writer of a picture."""
    return lambda folder: picture(*SIZE).save(folder / f"still{suffix}")


def film(suffix: str) -> Writer:
    """Return a writer of a film, or of numbered pictures."""

    def write(folder: Path) -> None:
        levels = picture(*SIZE).array
        save_movie((Image(np.roll(levels, 5 * n, axis=1)) for n in range(4)), folder / f"film{suffix}")

    return write


def scene(folder: Path) -> None:
    """Save a scene, as the editor does."""
    parse(SCENE, "scene.rt").scene.save(folder / "scene.rt")


def report(folder: Path) -> None:
    """Write the report of a scene."""
    write_files(folder, FINDINGS, {ROWS[0].name: BLACK}, BLACK)


def writers() -> dict[str, Writer]:
    """Return the writers by the names of what they write."""
    found: dict[str, Writer] = {"scene": scene, "report": report, "numbered": film(".png")}
    for name, each in FORMATS.items():
        if is_installed(name):
            if each.is_still:
                found[f"{name} still"] = still(each.suffixes[0])
            if each.is_film:
                found[f"{name} film"] = film(each.suffixes[0])
    return found


OLD = b"old"
Files = dict[str, bytes]  # name -> content


def contents(folder: Path) -> Files:
    """Return the files of a folder, without what may differ between two writings."""
    return {each.name: comparable(each.name, each.read_bytes()) for each in sorted(folder.iterdir())}


def comparable(name: str, data: bytes) -> bytes:
    """Return a whole MP4 or WebM film as its number of pictures, and others as they are: encoders differ in some bytes
    from time to time."""
    if not name.endswith((".mp4", ".webm")) or data == OLD:
        return data
    import av

    try:
        with av.open(io.BytesIO(data)) as film:
            return f"{sum(1 for _ in film.decode(video=0))} pictures".encode()
    except av.FFmpegError:
        return data


def written(writer: Writer, folder: Path) -> Files:
    """Let a writer write into a new folder; return its files."""
    folder.mkdir()
    writer(folder)
    return contents(folder)


def moments(writer: Writer, folder: Path, some: int) -> list[int]:
    """Return the numbers of some random writes, the last among them, or of all if there are no more."""
    counted: list[int] = []
    with faulty_files(counting(counted)):
        writer(folder)
    last = len(counted) - 1
    assert last >= 0, "nothing was written"
    chosen = {last, *random.Random(some).sample(range(last), min(some - 1, last))}
    return sorted(chosen)


def put_old(folder: Path, names: Sequence[str]) -> None:
    """Let a folder hold old files alone."""
    for each in folder.iterdir():
        each.unlink()
    for name in names:
        (folder / name).write_bytes(OLD)


def check_whole(found: Files, new: Files) -> None:
    """AssertionError unless each file is the old one or the new one, and no other is there."""
    for name, data in found.items():
        assert name in new, f"{name} was left"
        assert data in (OLD, new[name]), f"{name} is half written"
    assert found.keys() == new.keys(), "a file is gone"


def tried_kills(writer: Writer, folder: Path, some: int) -> int:
    """Kill a writer at some of its writes, and let it write again after each; return how many there were."""
    new, work = written(writer, folder / "new"), folder / "work"
    work.mkdir()
    chosen = moments(writer, work, some)
    for number in chosen:
        put_old(work, list(new))
        assert is_killed_at(lambda: writer(work), number)
        for each in work.glob(file_io.TEMPORARY):  # which are deleted an hour later
            each.unlink()
        check_whole(contents(work), new)
        writer(work)
        assert contents(work) == new
    return len(chosen)


def tried_errors(writer: Writer, folder: Path, some: int, codes: Sequence[int]) -> int:
    """Let some writes of a writer fail; return how many there were."""
    new, work = written(writer, folder / "new"), folder / "work"
    work.mkdir()
    chosen = moments(writer, work, some)
    for turn, number in enumerate(chosen):
        put_old(work, list(new))
        code = codes[turn % len(codes)]
        told = None
        try:
            with faulty_files(failing_at(number, code)):
                writer(work)
        except MiniRTError as error:
            told = str(error)
        assert told is not None, "the error was lost"
        assert os.strerror(code).lower() in told.lower(), f"{told} does not tell the reason"
        check_whole(contents(work), new)
    return len(chosen)


WRITERS = writers()
SOME = 2  # writes of a sort of file that fail

every_writer = pytest.mark.parametrize("writer", WRITERS.values(), ids=list(WRITERS))
needs_forks = pytest.mark.skipif(sys.platform == "win32", reason="there are no forks")


@needs_forks
@every_writer
def test_a_kill_at_a_write_leaves_old_or_new_files_and_the_next_run_clears_up(writer: Writer, tmp_path: Path) -> None:
    assert tried_kills(writer, tmp_path, SOME) > 0


@every_writer
def test_an_error_at_a_write_is_told_and_leaves_old_or_new_files(
    writer: Writer, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert tried_errors(writer, tmp_path, SOME, CODES) > 0
    assert capfd.readouterr() == ("", ""), "libraries print nothing of their own"


@every_writer
def test_short_writes_are_gone_on_with(writer: Writer, tmp_path: Path) -> None:
    whole = written(writer, tmp_path / "whole")
    with faulty_files(short):
        assert written(writer, tmp_path / "short") == whole
