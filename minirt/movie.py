"""Films: one file of all pictures in the formats that can hold them, numbered pictures in any other format."""

from __future__ import annotations

import os
from base64 import b64encode
from collections.abc import Iterable, Sized
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import RenderError
from minirt.formats.table import FORMATS, check_quality, encoding, format_of
from minirt.helpers import file_io
from minirt.helpers.progress import State, in_notebooks

if TYPE_CHECKING:
    from minirt.rendering.image import Image

FPS = 25.0  # frames per second
INLINE = 32 * 2**20  # bytes of the largest film that a notebook shows: it becomes a part of the notebook
PICTURES = {".gif": "gif", ".webp": "webp", ".apng": "png"}  # films that browsers take for pictures
VIDEOS = (".mp4", ".webm")


class SavedMovie(list[Path]):
    """The files of a film. A notebook plays a film of one file, of at most 32 MiB, below the cell."""

    def _repr_html_(self) -> str | None:
        """Return the film as HTML; None, for its names alone, where a notebook cannot play it."""
        (path, *others) = self
        suffix = path.suffix.lower()
        if others or suffix not in (*PICTURES, *VIDEOS) or path.stat().st_size > INLINE:
            return None
        data = b64encode(path.read_bytes()).decode()
        if suffix in PICTURES:
            return f'<img alt="{escape(path.name)}" src="data:image/{PICTURES[suffix]};base64,{data}">'
        return f'<video controls autoplay loop muted src="data:video/{suffix[1:]};base64,{data}"></video>'


def save_movie(
    pictures: Iterable[Image], path: str | os.PathLike[str], fps: float = FPS, *, quality: int | None = None
) -> SavedMovie:
    """Write a film of `fps` pictures per second; return its files, as a list that notebooks play.

    A path that ends in .gif, .webp, .apng, .mp4 or .webm gives one file, written as a whole or not at all; the first
    three loop for ever, the last two need PyAV. Any other path, such as spin.png, gives a file for each picture:
    spin-0001.png, spin-0002.png, ... `quality`, from 1 to 100, is for lossy formats. RenderError without pictures, with
    pictures of different sizes in one file, or when a file cannot be written.
    """
    total = len(pictures) if isinstance(pictures, Sized) else None
    number = 0  # of pictures that are in the film

    def state() -> State:
        return State(f"picture {number + 1}" + (f" of {total}" if total else ""), number / total if total else None)

    with in_notebooks(state):
        check_quality(format_of(path), quality)
        film = Film(path, fps, quality) if FORMATS[format_of(path)].is_film else None
        for picture in pictures:
            if film:
                film.add(picture)
            else:
                picture.save(numbered(path, number + 1), quality=quality)
            number += 1
    if not number:
        raise RenderError("a movie needs a picture")
    return SavedMovie([film.save()] if film else [numbered(path, each) for each in range(1, number + 1)])


class Film:
    """A film in one file, to which pictures are added one after the other; the arguments are those of `save_movie`."""

    def __init__(self, path: str | os.PathLike[str], fps: float = FPS, quality: int | None = None) -> None:
        from minirt.formats.films import CODECS, QUALITY, LoopFilm, VideoFilm

        self.path, self.name = Path(path), format_of(path)
        with file_io.told_errors(path):
            file_io.probe(path)
        self.film = (VideoFilm if self.name in CODECS else LoopFilm)(self.name, fps, quality or QUALITY)
        self.sizes: set[tuple[int, int]] = set()

    def add(self, picture: Image) -> None:
        """Add a picture; RenderError where the film cannot hold it."""
        self.sizes.add((picture.array.shape[1], picture.array.shape[0]))
        if len(self.sizes) > 1:
            different = " and ".join(f"{width}x{height}" for width, height in sorted(self.sizes))
            raise RenderError(f"the pictures of a film have one size, got {different}")
        with encoding("film", self.name):
            self.film.add(picture.array)

    def save(self) -> Path:
        """Write a film that has pictures, and return its path; RenderError when that fails."""
        with encoding("film", self.name):
            data = self.film.data()
        with file_io.told_errors(self.path):
            file_io.write(self.path, data)
        return self.path


def numbered(path: str | os.PathLike[str], number: int) -> Path:
    """Return the path of a picture of a film."""
    target = Path(path)
    return target.with_name(f"{target.stem}-{number:04}{target.suffix}")
