"""Journal of unfinished work: the bands that are done, in a hidden file beside the output, from which it goes on.

After a line that names the work, records follow, each with its number, length and checksum. A program that is killed
leaves at most the last record incomplete.
"""

from __future__ import annotations

import json
import os
import struct
import zlib
from contextlib import suppress
from itertools import accumulate, pairwise
from math import inf
from pathlib import Path
from time import perf_counter
from typing import IO, Any

import numpy as np

from minirt.cluster.job import Job, Made, Strips
from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.rendering.outcome import Outcome

TITLE = b"miniRT journal 3, work "
HEAD = struct.Struct("<QQI")  # number, length and checksum of a record
LEVEL = 1  # of compression
BANDS = "bands of the picture"
OTHER_WORK = "was left by another scene, other settings or another version; without --resume the work begins anew"
SHARE = 0.1  # of the time, that goes into keeping bands at most; cheap ones are sooner rendered again than kept


class Journal:
    """Records by their numbers. The file is there from the first record on, to the end of the block that fills it. An
    error that ends the block gets a note about what is kept."""

    def __init__(
        self,
        output: str | os.PathLike[str],
        work: str,
        *,
        again: str = "the same command or call",
        what: str = BANDS,
        resume: bool = True,
        keeps_all: bool = False,
        has_parts: bool = True,
    ) -> None:
        """Go on with the journal of an output, or, without `resume`, delete it.

        `work` is a line that says what is rendered, and how: the same for the same pixels. A journal that `keeps_all`
        bands, of which the output is put together, begins anew where that of the file is of other work. Without
        `has_parts` the records have outcomes, and nothing that was rendered. The note says that so many of `what` are
        kept, and that the command or call `again` goes on. RenderError where another program writes the journal, and
        where it is of other work and does not keep all.
        """
        self.path = journal_path(output)
        self.start = TITLE + work.encode() + b"\n"
        self.again, self.what, self.total = again, what, 0
        self.keeps_all, self.has_parts = keeps_all, has_parts
        self.places: dict[int, tuple[int, int]] = {}  # start and length of each record
        self.file: IO[bytes] | None = None
        self.credit = 0.0  # seconds that keeping bands may take
        if resume:
            self.open_existing()
        else:
            file_io.delete(self.path)

    def open_existing(self) -> None:
        """Open the file of an interrupted program, if there is one, and find its whole records."""
        try:
            with file_io.told_errors(self.path, "cannot be read"), suppress(FileNotFoundError):
                self.file = self.locked("r+b")
                self.find_records(self.file)
        except RenderError:
            self.close()
            raise

    def find_records(self, file: IO[bytes]) -> None:
        """Find the places of the whole records of an open file, and cut the rest. RenderError where the file is of
        other work, unless the journal `keeps_all`; OSError."""
        start = file.read(len(self.start))
        if not (self.keeps_all or self.start.startswith(start)):  # a part: of a program killed before the first band
            raise RenderError(f"{self.path}: {OTHER_WORK}")
        if start != self.start:
            file.seek(0)
            file.truncate()
            write_all(file, self.start)
        end, size = file.tell(), os.fstat(file.fileno()).st_size
        while len(head := file.read(HEAD.size)) == HEAD.size:
            number, length, checksum = HEAD.unpack(head)
            if length > size or zlib.crc32(file.read(length)) != checksum:
                break
            self.places[number] = end + HEAD.size, length
            end = file.tell()
        file.truncate(end)

    def locked(self, mode: str) -> IO[Any]:
        """Open the file, and lock it until it is closed; RenderError where another program has locked it. OSError."""
        file = self.path.open(mode, buffering=0)  # else what a full disk does not take is written again with each seek
        if not file_io.lock(file.fileno()):
            file.close()
            raise RenderError(f"{self.path}: another program is at this work")
        return file

    def keep(self, number: int, made: Made, seconds: float) -> None:
        """Keep what was made of band `number` in so many seconds, unless keeping took its share of the time before or
        the disk is full.

        OSError where the journal `keeps_all` and cannot be written.
        """
        self.credit += SHARE * seconds
        if self.credit < 0 and not self.keeps_all:
            return
        start = perf_counter()
        try:
            self.append(number, record_of(made if self.has_parts else Strips((), made.reached)))
        except OSError:
            if self.keeps_all:
                raise
            self.credit = -inf  # nothing is kept any more
        self.credit -= perf_counter() - start

    def append(self, number: int, data: bytes) -> None:
        """Write a record. OSError when it cannot be written."""
        if self.file is None:
            self.file = self.locked("x+b")
            write_all(self.file, self.start)
        start = self.file.seek(0, os.SEEK_END) + HEAD.size
        write_all(self.file, HEAD.pack(number, len(data), zlib.crc32(data)) + data)
        self.places[number] = start, len(data)

    def restore(self, band: Job) -> Made | None:
        """Return what was made of a band; None where that is missing. RenderError where it cannot be read."""
        if band.number not in self.places or self.file is None:
            return None
        start, length = self.places[band.number]
        with file_io.told_errors(self.path, "cannot be read"):
            self.file.seek(start)
            return made_of_record(self.file.read(length), band)

    def close(self) -> None:
        """Close the file, if there is one."""
        with suppress(OSError):
            if self.file:
                self.file.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, _: object, error: BaseException | None, __: object) -> None:
        if self.file is None:  # there is none, or it is another program's
            return
        self.close()
        if error is None or not self.places:
            file_io.delete(self.path)
        else:
            kept = f"{len(self.places)} of {self.total} {self.what} {'is' if len(self.places) == 1 else 'are'} kept"
            error.add_note(f"{kept} in {self.path}; {self.again} goes on")


def write_all(file: IO[bytes], data: bytes) -> None:
    """Write data to a file without a buffer, in as many steps as the system needs. OSError."""
    while data:
        data = data[file.write(data) :]


def record_of(made: Made) -> bytes:
    """Return what was made of a band as a record: a line of JSON, then compressed arrays, or strips as they are.

    The line has the sizes of these parts in bytes and the outcome; for a picture also its tone and `not_finite`.
    """
    about: list[Any] = [made.reached]
    if isinstance(made, Strips):
        parts = list(made.parts)
    else:
        parts = [zlib.compress(each.tobytes(), LEVEL) for each in (made.array, made.linear) if each is not None]
        about += made.tone, made.not_finite
    return json.dumps([[*map(len, parts)], *about]).encode() + b"\n" + b"".join(parts)


def made_of_record(data: bytes, band: Job) -> Made:
    """Return what was made of a band, from its record: see `record_of`."""
    line, _, rest = data.partition(b"\n")
    sizes, reached, *about = json.loads(line)
    parts = [rest[start:end] for start, end in pairwise(accumulate(sizes, initial=0))]
    reached = reached and Outcome(*reached)
    if not about:
        return Strips(tuple(parts), reached)
    shape = band.region.height, band.region.width, 3
    kinds = zip(parts, (np.uint8, np.float64), strict=False)
    levels, *light = [np.frombuffer(zlib.decompress(part), kind).reshape(shape) for part, kind in kinds]
    return Image(levels, light[0] if light else None, reached, *about)


def journal_path(output: str | os.PathLike[str]) -> Path:
    """Return the path of the journal of an output: `.spin.gif.journal` beside `spin.gif`."""
    path = Path(output)
    return path.with_name(f".{path.name}.journal")
