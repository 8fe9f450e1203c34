"""Movies: an animated GIF, or numbered pictures in any other format."""

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

FPS = 25.0  # frames per second
COLOURS = 256  # of each frame of a GIF

T = TypeVar("T")


def save_movie(pictures: Iterable[Image], path: str | os.PathLike[str], fps: float = FPS) -> list[Path]:
    """Write a movie of `fps` pictures per second; return its files.

    A path that ends in .gif gives one looping file, written as a whole or not at all. Any other path, such as spin.png,
    gives a file for each picture: spin-0001.png, spin-0002.png, ... RenderError without pictures, or when a file cannot
    be written.
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
    """Return the bytes of a looping GIF; the format counts durations in hundredths of a second."""
    frames = [quantise(picture.pil) for picture in pictures]
    if not frames:
        raise RenderError("a movie needs a picture")
    buffer = io.BytesIO()
    duration = 10 * max(2, round(100 / fps))  # ms; many programs slow down frames shorter than 20 ms
    frames[0].save(buffer, "GIF", save_all=True, append_images=frames[1:], duration=duration, loop=0, optimize=True)
    return buffer.getvalue()


def quantise(picture: PillowImage) -> PillowImage:
    """Reduce a picture to 256 colours by an octree, which keeps the colours of small objects and takes two thirds
    of the bytes of a median cut."""
    from PIL.Image import Dither, Quantize

    return picture.quantize(COLOURS, Quantize.FASTOCTREE, dither=Dither.NONE)


def with_progress(items: Iterable[T], count: int, noun: str) -> Iterator[T]:
    """Yield the items, and print after each how many of `count` are done, if standard error is a terminal."""
    terminal = sys.stderr.isatty()
    for number, item in enumerate(items, 1):
        yield item
        if terminal:
            print(f"\r{noun} {number} of {count}", end="\n" if number == count else "", file=sys.stderr, flush=True)
