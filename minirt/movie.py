"""Films: one file of all pictures in the formats that can hold them, numbered pictures in any other format."""

from __future__ import annotations

import os
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator, Sized
from functools import partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, TypeAlias

from minirt.errors import RenderError
from minirt.formats.table import FORMATS, check_quality, format_of
from minirt.helpers import file_io
from minirt.helpers.progress import State, in_notebooks

if TYPE_CHECKING:
    from minirt.formats.films import Film
    from minirt.rendering.image import Image

Recording: TypeAlias = Callable[[Callable[["Image"], None]], object]  # gives pictures to a function

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

    def counted() -> Iterator[Image]:
        nonlocal number
        for picture in pictures:
            yield picture
            number += 1

    def state() -> State:
        return State(f"picture {number + 1}" + (f" of {total}" if total else ""), number / total if total else None)

    with in_notebooks(state):
        if FORMATS[format_of(path)].is_film:
            return SavedMovie([record_movie(partial(each_of, counted()), path, fps, quality=quality)])
        check_quality(format_of(path), quality)
        return SavedMovie(save_numbered(counted(), Path(path), quality))


def record_movie(
    record: Recording, path: str | os.PathLike[str], fps: float = FPS, *, quality: int | None = None
) -> Path:
    """Write a film in one file of pictures that `record` makes: it is called with a function that takes each of them.

    The other arguments, errors and the result are those of `save_movie`.
    """
    target, name = Path(path), format_of(path)
    check_quality(name, quality)
    try:
        file_io.write(target, lambda file: write_film(record, file, name, fps, quality))
    except OSError as error:
        raise RenderError(f"{target}: cannot write: {error.strerror or error}") from None
    return target


def each_of(pictures: Iterable[Image], add: Callable[[Image], None]) -> None:
    """Give pictures to a function, one after the other."""
    for picture in pictures:
        add(picture)


def save_numbered(pictures: Iterable[Image], target: Path, quality: int | None = None) -> list[Path]:
    """Write a file for each picture, and return their paths; RenderError without pictures."""
    written = []
    for number, picture in enumerate(pictures, 1):
        file = numbered(target, number)
        picture.save(file, quality=quality)
        written.append(file)
    if not written:
        raise RenderError("a movie needs a picture")
    return written


def numbered(target: Path, number: int) -> Path:
    """Return the path of a picture of a film."""
    return target.with_name(f"{target.stem}-{number:04}{target.suffix}")


def write_film(record: Recording, out: BinaryIO, name: str, fps: float, quality: int | None = None) -> None:
    """Write the pictures that `record` makes to a file that can seek; of a loop all are in memory at once.

    RenderError without pictures, or when the format cannot hold them; OSError when the file cannot be written.
    """
    from minirt.formats.films import new_film

    film: Film | None = None
    sizes: set[tuple[int, int]] = set()

    def add(picture: Image) -> None:
        nonlocal film
        film = film or new_film(out, name, fps, quality)
        sizes.add((picture.array.shape[1], picture.array.shape[0]))
        if len(sizes) > 1:
            different = " and ".join(f"{width}x{height}" for width, height in sorted(sizes))
            raise RenderError(f"the pictures of a film have one size, got {different}")
        try:
            film.add(picture.array)
        except (ValueError, KeyError, OverflowError) as error:
            raise RenderError(f"cannot write this film as {name}: {error}") from None

    try:
        record(add)
        if film is None:
            raise RenderError("a movie needs a picture")
        film.end()
    finally:
        if film:
            film.close()
