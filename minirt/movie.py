"""Moving pictures: an animated GIF, or numbered pictures of any other format."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from minirt import atomic_write
from minirt.errors import RenderError

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

    from minirt.image import Image

FPS = 25.0  # pictures a second
COLOURS = 256  # of each picture of a GIF

T = TypeVar("T")


def save_movie(pictures: Iterable[Image], path: str | os.PathLike[str], fps: float = FPS) -> list[Path]:
    """Write pictures that are shown one after the other, `fps` of them a second; returns the files.

    A name that ends in .gif is one file, written as a whole or not at all, that plays again and again; of any other,
    such as spin.png, each picture is a file of its own: spin-0001.png, spin-0002.png, ... RenderError where there is no
    picture, or a file cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() == ".gif":
        data = encode_gif(pictures, fps)
        try:
            atomic_write.write(target, data)
        except OSError as error:
            raise RenderError(f"{target}: cannot write: {error.strerror or error}") from None
        return [target]
    written = []
    for number, picture in enumerate(pictures, 1):
        file = target.with_name(f"{target.stem}-{number:04}{target.suffix}")
        picture.save(file)
        written.append(file)
    if not written:
        raise RenderError("a movie needs a picture")
    return written


def encode_gif(pictures: Iterable[Image], fps: float) -> bytes:
    """The bytes of a GIF. Its time is counted in hundredths of a second."""
    frames = [quantised(picture.pil) for picture in pictures]
    if not frames:
        raise RenderError("a movie needs a picture")
    buffer = io.BytesIO()
    duration = 10 * max(2, round(100 / fps))  # ms; what is shorter than 20 many programs play slowly
    frames[0].save(buffer, "GIF", save_all=True, append_images=frames[1:], duration=duration, loop=0, optimize=True)
    return buffer.getvalue()


def quantised(picture: PillowImage) -> PillowImage:
    """The picture with few colours: by an octree, which keeps those of small things and takes two thirds of the bytes
    that a median cut takes."""
    from PIL.Image import Dither, Quantize

    return picture.quantize(COLOURS, Quantize.FASTOCTREE, dither=Dither.NONE)


def with_progress(things: Iterable[T], count: int, what: str) -> Iterator[T]:
    """The things, while a terminal at standard error is told how many are done."""
    told = sys.stderr.isatty()
    for number, thing in enumerate(things, 1):
        yield thing
        if told:
            print(f"\r{what} {number} of {count}", end="\n" if number == count else "", file=sys.stderr, flush=True)
