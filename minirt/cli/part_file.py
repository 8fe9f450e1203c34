"""Part file: what is done of long work, in a hidden file beside its output, from which `--resume` goes on.

It begins with a line that tells the work; parts follow, each with its number, length and checksum. A program that is
killed leaves at most the last part incomplete.
"""

from __future__ import annotations

import os
import stat
import struct
import zlib
from contextlib import suppress
from math import inf
from pathlib import Path
from time import perf_counter
from typing import IO, NamedTuple

from minirt.errors import RenderError
from minirt.helpers import file_io

TITLE = b"miniRT part file 1, work "
FLAGS = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)  # of a file that must not exist yet
HEAD = struct.Struct("<QQI")  # number, length and checksum of a part
LEVEL = 1  # of compression
SHARE = 0.1  # of the time, that goes into keeping parts at most; cheap ones are sooner rendered again than kept


class Place(NamedTuple):
    """Place of a part in the file."""

    start: int
    length: int
    checksum: int


class PartFile:
    """Parts by their numbers. The file is there from the first part on."""

    def __init__(self, target: str | os.PathLike[str], work: str, resume: bool) -> None:
        """Go on with the part file of a target, or delete it. RenderError where it is of other work."""
        self.path = path_for(target)
        self.work = work
        self.places: dict[int, Place] = {}
        self.file: IO[bytes] | None = None
        self.credit = 0.0  # seconds that keeping parts may take
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
        title = self.file.readline(1000)
        if title != self.title:
            self.close()
            if self.title.startswith(title):  # the program was killed before it had kept anything
                self.file = None
                delete(self.path)
                return
            raise RenderError(
                f"{self.path}: was left by another scene, other settings or another version; without --resume the work "
                f"begins anew"
            )
        end, size = self.file.tell(), os.fstat(self.file.fileno()).st_size
        while len(head := self.file.read(HEAD.size)) == HEAD.size:
            number, length, checksum = HEAD.unpack(head)
            start = self.file.tell()
            if length > size - start:
                break
            self.places[number] = Place(start, length, checksum)
            end = self.file.seek(start + length)
        self.file.truncate(end)

    @property
    def title(self) -> bytes:
        """The first line."""
        return TITLE + self.work.encode() + b"\n"

    def read(self, number: int, size: int) -> bytes | None:
        """Return the `size` bytes of a part; None where it is missing or damaged."""
        place = self.places.get(number)
        if place is None or self.file is None:
            return None
        self.file.seek(place.start)
        packed = self.file.read(place.length)
        if zlib.crc32(packed) != place.checksum:
            return None
        try:
            data = zlib.decompressobj().decompress(packed, size + 1)
        except zlib.error:
            return None
        return data if len(data) == size else None

    def offer(self, number: int, data: bytes, seconds: float) -> None:
        """Keep a part that took so long to make, unless keeping has taken its share of the time or the disk is full."""
        self.credit += SHARE * seconds
        if self.credit >= 0:
            start = perf_counter()
            try:
                self.append(number, data)
            except OSError:
                self.credit = -inf
            self.credit -= perf_counter() - start

    def append(self, number: int, data: bytes) -> None:
        """Keep a part. OSError when it cannot be written."""
        packed = zlib.compress(data, LEVEL)
        if self.file is None:
            self.file = os.fdopen(os.open(self.path, FLAGS, 0o666), "r+b")
            lock(self.file, self.path)
            self.file.write(self.title)
        start = self.file.seek(0, os.SEEK_END) + HEAD.size
        place = Place(start, len(packed), zlib.crc32(packed))
        self.file.write(HEAD.pack(number, place.length, place.checksum) + packed)
        self.file.flush()
        self.places[number] = place

    def close(self) -> None:
        """Leave the file as it is."""
        if self.file:
            with suppress(OSError):
                self.file.close()

    def remove(self) -> None:
        """Delete the file."""
        self.close()
        delete(self.path)


def path_for(target: str | os.PathLike[str]) -> Path:
    """Return the path of the part file of an output: `.spin.gif.part` beside `spin.gif`."""
    path = Path(target)
    return path.with_name(f".{path.name}.part")


def delete(path: Path) -> None:
    """Delete a file, if there is one that can be deleted."""
    with suppress(OSError):
        path.unlink()


def lock(file: IO[bytes], path: Path) -> None:
    """Lock a file until it is closed; RenderError where another program has locked it."""
    if not file_io.lock(file.fileno()):
        raise RenderError(f"{path}: another program is at this work")
