"""Journal of unfinished work: the bands that are done, in a hidden file beside the output, from which it goes on.

After a head, which is empty but in a TIFF file, comes a line that names the work; then records follow, each with its
number, length and checksum. A program that is killed leaves at most the last record incomplete.
"""

from __future__ import annotations

import os
import stat
import struct
import zlib
from collections.abc import Callable
from contextlib import suppress
from math import inf, prod
from pathlib import Path
from time import perf_counter
from typing import IO, NamedTuple

import numpy as np

from minirt.cluster.job import Made
from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.rendering.outcome import Outcome

TITLE = b"miniRT journal 1, work "
FLAGS = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)  # of a file that must not exist yet
HEAD = struct.Struct("<QQI")  # number, length and checksum of a record
LEVEL = 1  # of compression
SHARE = 0.1  # of the time, that goes into keeping bands at most; cheap ones are sooner rendered again than kept


class Place(NamedTuple):
    """Place of a record in the file."""

    start: int
    length: int
    checksum: int


class Journal:
    """Records by their numbers. The file is there from the first record on."""

    def __init__(self, output: str | os.PathLike[str], work: str, resume: bool, head: bytes = b"") -> None:
        """Go on with the journal of an output, or delete it.

        RenderError where another program writes it, and, with a head of no bytes, where it is of other work.
        """
        self.path = path_for(output)
        self.start = head + TITLE + work.encode() + b"\n"
        self.is_strict = not head
        self.places: dict[int, Place] = {}
        self.file: IO[bytes] | None = None
        self.credit = 0.0  # seconds that keeping bands may take
        if resume:
            self.open_existing()
        else:
            delete(self.path)

    def open_existing(self) -> None:
        """Open the file of an interrupted program, if there is one."""
        try:
            if not stat.S_ISREG(self.path.lstat().st_mode):
                raise RenderError(f"{self.path}: not a regular file")
            self.file = self.path.open("r+b")
        except FileNotFoundError:
            return
        except OSError as error:
            raise RenderError(f"{self.path}: cannot be read: {error.strerror or error}") from None
        lock(self.file, self.path)
        start = self.file.read(len(self.start))
        if start != self.start:
            if self.is_strict and not self.start.startswith(start):  # as of a program killed before the first record
                self.close()
                raise RenderError(
                    f"{self.path}: was left by another scene, other settings or another version; without --resume the "
                    "work begins anew"
                )
            self.file.seek(0)
            self.file.write(self.start)
        end, size = self.file.tell(), os.fstat(self.file.fileno()).st_size
        while start == self.start and len(head := self.file.read(HEAD.size)) == HEAD.size:
            number, length, checksum = HEAD.unpack(head)
            place = Place(self.file.tell(), length, checksum)
            if length > size - place.start:
                break
            self.places[number] = place
            end = self.file.seek(place.start + length)
        self.file.truncate(end)

    def read(self, number: int) -> bytes | None:
        """Return a record; None where it is missing or damaged."""
        place = self.places.get(number)
        if place is None or self.file is None:
            return None
        self.file.seek(place.start)
        data = self.file.read(place.length)
        return data if zlib.crc32(data) == place.checksum else None

    def append(self, number: int, data: bytes) -> bytes:
        """Keep a record, and return it. OSError when it cannot be written."""
        if self.file is None:
            self.file = os.fdopen(os.open(self.path, FLAGS, 0o666), "r+b")
            lock(self.file, self.path)
            self.file.write(self.start)
        start = self.file.seek(0, os.SEEK_END) + HEAD.size
        place = Place(start, len(data), zlib.crc32(data))
        self.file.write(HEAD.pack(number, place.length, place.checksum) + data)
        self.file.flush()
        self.places[number] = place
        return data

    def offer(self, number: int, data: bytes | Made, seconds: float) -> None:
        """Keep what took so long to make, unless keeping has taken its share of the time or the disk is full."""
        self.credit += SHARE * seconds
        if self.credit >= 0:
            start = perf_counter()
            try:
                self.append(number, packed(data) if isinstance(data, Made) else data)
            except OSError:
                self.credit = -inf
            self.credit -= perf_counter() - start

    def restore(self, number: int, *shapes: tuple[int, ...]) -> Made | None:
        """Return a band of arrays of some shapes, levels and then light; None where it is missing or damaged."""
        data = self.read(number)
        try:
            return None if data is None else unpacked(data, shapes)
        except (ValueError, KeyError, TypeError, zlib.error):
            return None

    def become_output(self, output: Path, ends: Callable[[int], tuple[bytes, bytes]]) -> None:
        """Rename the file, after its head was replaced and a tail added: `ends` returns both, by where the tail begins.

        OSError."""
        import shutil

        assert self.file
        end = self.file.seek(0, os.SEEK_END)
        start = end + end % 2
        head, tail = ends(start)
        self.file.seek(start)
        self.file.write(tail)
        self.file.seek(0)
        self.file.write(head)
        self.file.flush()
        os.fsync(self.file.fileno())
        with suppress(FileNotFoundError):
            shutil.copymode(output, self.path)
        self.path.replace(output)

    def close(self) -> None:
        """Leave the file as it is."""
        if self.file:
            with suppress(OSError):
                self.file.close()

    def remove(self) -> None:
        """Delete the file."""
        self.close()
        delete(self.path)


def packed(made: Made) -> bytes:
    """Return a band as a record: a line of JSON, then compressed arrays, or strips as they are."""
    import json

    parts = [each if isinstance(each, bytes) else zlib.compress(each.tobytes(), LEVEL) for each in made.parts]
    about = [len(each) for each in parts], made.reached, made.not_finite
    return json.dumps(about).encode() + b"\n" + b"".join(parts)


class Record(NamedTuple):
    """Head of the record of a band."""

    sizes: list[int]  # bytes of its parts
    reached: Outcome | None
    not_finite: int  # rays
    start: int  # byte at which its parts begin


def record_of(data: bytes) -> Record:
    """Return what a record begins with; ValueError and others where it is of no band."""
    import json

    line, _, _ = data.partition(b"\n")
    sizes, reached, not_finite = json.loads(line)
    return Record(sizes, None if reached is None else Outcome(*reached), not_finite, len(line) + 1)


def unpacked(data: bytes, shapes: tuple[tuple[int, ...], ...]) -> Made:
    """Return the band of a record; ValueError and others where it is of other arrays."""
    sizes, reached, not_finite, start = record_of(data)
    arrays = []
    for size, shape, kind in zip(sizes, shapes, (np.uint8, np.float64), strict=False):
        length = prod(shape) * np.dtype(kind).itemsize
        part = zlib.decompressobj().decompress(data[start : start + size], length + 1)
        arrays.append(np.frombuffer(part, kind).reshape(shape))
        start += size
    if len(arrays) < len(shapes):
        raise ValueError("arrays are missing")
    return Made(tuple(arrays), reached, not_finite)


def path_for(output: str | os.PathLike[str]) -> Path:
    """Return the path of the journal of an output: `.spin.gif.journal` beside `spin.gif`."""
    path = Path(output)
    return path.with_name(f".{path.name}.journal")


def delete(path: Path) -> None:
    """Delete a file, if there is one that can be deleted."""
    with suppress(OSError):
        path.unlink()


def lock(file: IO[bytes], path: Path) -> None:
    """Lock a file until it is closed; RenderError where another program has locked it."""
    if not file_io.lock(file.fileno()):
        file.close()
        raise RenderError(f"{path}: another program is at this work")
