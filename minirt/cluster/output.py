"""A TIFF file in the making, and the journal beside it."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, TextIO

from minirt.cluster import journal
from minirt.cluster.task import Made, Region
from minirt.errors import RenderError
from minirt.formats import tiff
from minirt.helpers import file_io

FLAGS = os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)


class Output:
    """A file in the making, and its journal."""

    def __init__(self, target: Path, key: str, bands: Sequence[Region]) -> None:
        """`key` tells the picture from others, `bands` are its parts."""
        self.target = target = Path(os.path.realpath(target))  # a link stays
        self.key = key
        self.strips = [-(-rows // tiff.ROWS) for *_, rows in bands]  # of each band
        self.data_path, self.journal_path = (target.with_name(target.name + end) for end in (".part", ".journal"))

    def __enter__(self) -> Output:
        self.data: BinaryIO = os.fdopen(os.open(self.data_path, FLAGS, 0o666), "r+b")
        try:
            lock(self.data, self.target)
            self.bands = journal.read(self.journal_path, self.key, self.data, self.strips)
            self.end = max((each.end for each in self.bands.values()), default=tiff.BIG.header.size)
            self.data.truncate(self.end)
            lines = [journal.title(self.key) + "\n", *map(journal.line, self.bands.values())]
            file_io.write(self.journal_path, "".join(lines).encode())
            self.lines: TextIO = self.journal_path.open("a", encoding="utf-8")
        except BaseException:
            self.data.close()
            raise
        return self

    def __exit__(self, *error: object) -> None:
        self.lines.close()
        self.data.close()

    def add(self, band: int, made: Made) -> None:
        """Append the strips of a band, then its line in the journal."""
        self.data.seek(self.end)
        data = b"".join(made.strips)
        self.data.write(data)
        self.data.flush()
        reached = None if made.reached is None else list(made.reached)
        sizes, digest = [len(each) for each in made.strips], hashlib.sha256(data).hexdigest()
        self.bands[band] = journal.Entry(band, self.end, sizes, digest, reached)
        self.end += len(data)
        self.lines.write(journal.line(self.bands[band]))
        self.lines.flush()

    def finish(self, width: int, height: int, bits: int) -> None:
        """Write the directory, give the file its name, and delete the journal."""
        places: list[int] = []
        sizes: list[int] = []
        for _, each in sorted(self.bands.items()):
            places += [each.start + sum(each.sizes[:number]) for number in range(len(each.sizes))]
            sizes += each.sizes
        start = tiff.even(self.end)
        self.data.seek(start)
        self.data.write(tiff.directory(width, height, bits, places, sizes, start))
        self.data.seek(0)
        self.data.write(tiff.header(start))
        self.data.flush()
        os.fsync(self.data.fileno())
        with suppress(FileNotFoundError):
            shutil.copymode(self.target, self.data_path)
        self.data_path.replace(self.target)
        self.journal_path.unlink()


def lock(file: BinaryIO, target: Path) -> None:
    """Lock a file until it is closed; RenderError where another program has locked it."""
    if not file_io.lock(file.fileno()):
        raise RenderError(f"{target}: another program is rendering into this file")
