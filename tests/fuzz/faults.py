"""Faults at all writes of all sorts of files that are replaced as a whole: kills, and errors of the disk.

python -m tests.fuzz.faults [WRITES]      # at so many random writes of each sort of file, or all; status 1 if one fails
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from minirt.errors import MiniRTError
from minirt.formats.table import FORMATS, is_installed
from minirt.helpers import file_io
from minirt.image import Image
from minirt.movie import save_movie
from minirt.report.document import write_files
from minirt.scene import parse
from tests.faulty_files import CODES, counting, failing_at, faulty_files, is_killed_at
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
RANDOM = slice(256, 512)  # bytes of a WebM film with its random identifiers
Files = dict[str, bytes]  # name -> content


def contents(folder: Path) -> Files:
    """Return the files of a folder, without what may differ between two writings."""
    return {each.name: comparable(each.name, each.read_bytes()) for each in sorted(folder.iterdir())}


def comparable(name: str, data: bytes) -> bytes:
    """Return a WebM film without its random identifiers, a whole MP4 film as its structure, and others as they are.

    The x264 of PyAV 19 encodes the same pictures in two or three ways, by what happens to lie in memory: seen in one of
    100 to 600 films, whose levels then differ by up to 3.
    """
    if name.endswith(".webm"):
        return data[: RANDOM.start] + data[RANDOM.stop :]
    return (name.endswith(".mp4") and structure(data)) or data


def structure(film: bytes) -> bytes:
    """Return the names of the boxes of an MP4 film and its number of pictures (ISO 14496-12); nothing if it is not
    whole."""
    names, at = [], 0
    while at + 8 <= len(film):
        names.append(film[at + 4 : at + 8])
        at += max(8, int.from_bytes(film[at : at + 4], "big"))
    sizes = film.find(b"stsz") + 4  # the table of sizes: flags, the common size and the number, of 4 bytes each
    return b" ".join((*names, film[sizes + 8 : sizes + 12])) if at == len(film) and names[-1:] == [b"moov"] else b""


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
        file_io.CLEANED.discard(work)
        assert is_killed_at(lambda: writer(work), number)
        found = contents(work)
        check_whole({name: data for name, data in found.items() if not Path(name).match(file_io.TEMPORARY)}, new)
        writer(work)
        assert contents(work) == new, "the next run does not clear up"
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


def main(some: int = sys.maxsize) -> int:
    """Try all sorts of files, and print what fails."""
    failed = 0
    for name, writer in writers().items():
        for trial in (tried_kills, lambda *given: tried_errors(*given, CODES)):
            with tempfile.TemporaryDirectory() as folder:
                try:
                    print(f"{name}: {trial(writer, Path(folder), some)} writes", flush=True)
                except AssertionError as error:
                    failed += 1
                    print(f"{name}: {error}", flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
