"""Saving films from Python: progress in notebooks, and files that play below the cell."""

from __future__ import annotations

import os
from base64 import b64encode
from collections.abc import Iterable, Iterator, Sized
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.helpers.progress import State, in_notebooks
from minirt.movie import FPS
from minirt.movie import save_movie as save

if TYPE_CHECKING:
    from minirt.image import Image

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
    spin-0001.png, spin-0002.png, ... `quality`, from 1 to 100, is for lossy formats. RenderError without pictures, or
    when a file cannot be written.
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
        return SavedMovie(save(counted(), path, fps, quality=quality))
