"""Films: one file of all pictures in the formats that can hold them, numbered pictures in any other format.

Loops are written by Pillow (GIF, APNG, WebP), MP4 (H.264) and WebM (VP9) by PyAV (`minirt[video]`).
"""

from __future__ import annotations

import io
import os
from base64 import b64encode
from collections.abc import Iterable, Sized
from fractions import Fraction
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from minirt.errors import RenderError
from minirt.formats.table import FORMATS, check_quality, format_of, told_encoding_errors
from minirt.helpers import file_io
from minirt.helpers.progress import WorkState, in_notebooks
from minirt.rendering.image import Image

# Formats of films by their suffixes; .png stands for numbered pictures.
FILMS = {each.suffixes[0]: each for each in FORMATS.values() if each.is_film} | {".png": FORMATS["PNG"]}
FPS = 25.0  # frames per second
INLINE = 32 * 2**20  # bytes of the largest film that a notebook shows: it becomes a part of the notebook
MEDIA = {".gif": "image/gif", ".webp": "image/webp", ".apng": "image/png", ".mp4": "video/mp4", ".webm": "video/webm"}
QUALITY = 80  # of 100
COLOURS = 255  # of each picture of a GIF; Pillow uses one more for pixels that stay as they are
LONGEST = {"GIF": 655_350, "APNG": 65_535, "WEBP": 2**24 - 1}  # milliseconds that a picture can last
OPTIONS: dict[str, dict[str, Any]] = {"GIF": {"optimize": True}, "APNG": {}, "WEBP": {"method": 0}}  # 0: the fastest
CODECS = {"MP4": ("mp4", "libx264", 45), "WEBM": ("webm", "libvpx-vp9", 58)}  # and constant rate factors of quality 0
BEST = 4  # constant rate factor of quality 100
BT709, STUDIO_RANGE = 1, 1  # FFmpeg's numbers of the matrix from RGB, and of levels from 16 to 235


class SavedMovie(list[Path]):
    """The files of a film. A notebook plays a film of one file, of at most 32 MiB, below the cell."""

    def _repr_html_(self) -> str | None:
        """Return the film as HTML; None, for its names alone, where a notebook cannot play it."""
        (path, *others) = self
        media = MEDIA.get(path.suffix.lower())
        if others or not media or not (status := file_io.found(path)) or status.st_size > INLINE:
            return None
        source = f"data:{media};base64,{b64encode(path.read_bytes()).decode()}"
        if media.startswith("image"):
            return f'<img alt="{escape(path.name)}" src="{source}">'
        return f'<video controls autoplay loop muted src="{source}"></video>'


def save_movie(
    pictures: Iterable[Image | np.ndarray],
    path: str | os.PathLike[str],
    fps: float = FPS,
    *,
    quality: int | None = None,
) -> SavedMovie:
    """Write a film of `fps` pictures per second; return its files, as a list that notebooks play.

    The pictures are those of `minirt.render`, or arrays (h, w, 3) of uint8, red, green and blue.

    A path that ends in .gif, .webp, .apng, .mp4 or .webm gives one file, written as a whole or not at all; the first
    three loop for ever, the last two need PyAV. Any other path, such as spin.png, gives a file for each picture:
    spin-0001.png, spin-0002.png, ... `quality`, from 1 to 100, is for lossy formats. RenderError without pictures, with
    pictures of different sizes in one file, or when a file cannot be written.
    """
    total = len(pictures) if isinstance(pictures, Sized) else None
    number = 0  # of pictures that are in the film

    def state() -> WorkState:
        return WorkState(f"picture {number + 1}" + (f" of {total}" if total else ""), number / total if total else None)

    with in_notebooks(state):
        check_quality(format_of(path), quality)
        film = Film(path, fps, quality) if FORMATS[format_of(path)].is_film else None
        for each in pictures:
            picture = image_of(each)
            if film:
                film.add(picture)
            else:
                picture.save(numbered(path, number + 1), quality=quality)
            number += 1
    if not number:
        raise RenderError("a movie needs a picture")
    return SavedMovie([film.save()] if film else [numbered(path, each) for each in range(1, number + 1)])


def image_of(picture: Image | np.ndarray) -> Image:
    """Return a picture of a film as an `Image`; RenderError for an array that is none."""
    if isinstance(picture, Image):
        return picture
    array = np.asarray(picture)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] != 3 or not array.size:
        what = f"an array {array.shape} of {array.dtype}" if array.ndim else repr(picture)
        raise RenderError(
            f"a film takes pictures of minirt.render, or arrays (h, w, 3) of uint8 from 0 to 255, got {what:.60}"
        )
    return Image(array)


class Film:
    """A film in one file, to which pictures are added one after the other; the arguments are those of `save_movie`."""

    def __init__(self, path: str | os.PathLike[str], fps: float = FPS, quality: int | None = None) -> None:
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
        with told_encoding_errors("film", self.name):
            self.film.add(picture.array)

    def save(self) -> Path:
        """Write a film that has pictures, and return its path; RenderError when that fails."""
        with told_encoding_errors("film", self.name):
            data = self.film.data()
        with file_io.told_errors(self.path):
            file_io.write(self.path, data)
        return self.path


def numbered(path: str | os.PathLike[str], number: int) -> Path:
    """Return the path of a picture of a film."""
    target = Path(path)
    return target.with_name(f"{target.stem}-{number:04}{target.suffix}")


# The bytes of a film, of pictures of one size, (h, w, 3) uint8; an error of its library where it cannot hold one.


class LoopFilm:
    """A film that loops for ever. Pillow gets all pictures at the end, and stores the rectangles that change.

    A picture that stays as it is lasts longer, so that it takes no place.
    """

    def __init__(self, name: str, fps: float, quality: int) -> None:
        self.name, self.quality = name, quality
        # GIF counts hundredths of a second, and many programs slow down pictures of fewer than two.
        self.each = 10 * max(2, round(100 / fps)) if name == "GIF" else round(1000 / fps)
        self.pictures: list[Any] = []  # of Pillow
        self.durations: list[int] = []  # milliseconds
        self.last: np.ndarray | None = None

    def add(self, picture: np.ndarray) -> None:
        """Keep a picture until the end."""
        from PIL import Image as pillow  # noqa: N813

        if self.last is not None and np.array_equal(picture, self.last):
            self.durations[-1] += self.each
            return
        image = pillow.fromarray(picture)
        if self.name == "GIF":  # an octree keeps the colours of small objects, and takes less than a median cut
            image = image.quantize(COLOURS, pillow.Quantize.FASTOCTREE, dither=pillow.Dither.NONE)
        self.pictures.append(image)
        self.durations.append(self.each)
        self.last = picture

    def data(self) -> bytes:
        first, *others = self.pictures
        durations = [min(each, LONGEST[self.name]) for each in self.durations]
        buffer = io.BytesIO()
        first.save(
            buffer, "PNG" if self.name == "APNG" else self.name, save_all=True, append_images=others,
            duration=durations, loop=0, quality=self.quality, **OPTIONS[self.name],
        )  # fmt: skip
        return buffer.getvalue()


class VideoFilm:
    """A film compressed by a codec, picture by picture. Colours have half the resolution of brightness. So widths and
    heights are even: odd ones gain a row or a column."""

    def __init__(self, name: str, fps: float, quality: int) -> None:
        import av
        from av.video.reformatter import VideoReformatter

        self.name, self.fps, self.quality = name, fps, quality
        self.buffer = io.BytesIO()
        self.film = av.open(self.buffer, "w", format=CODECS[name][0])
        self.stream: Any = None
        # One of its own: PyAV 19 shares one among all films, and its threads are gone in a child after `os.fork()`.
        self.reformatter: Any = VideoReformatter()

    def add(self, picture: np.ndarray) -> None:
        """Compress a picture."""
        import av

        even = np.pad(picture, [(0, len(picture) % 2), (0, picture.shape[1] % 2), (0, 0)], "edge")
        if self.stream is None:
            self.stream = self.new_stream(*even.shape[:2])
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(even), format="rgb24")
        yuv = self.reformatter.reformat(frame, format="yuv420p", dst_colorspace="ITU709", dst_color_range="MPEG")
        self.film.mux(self.stream.encode(yuv))

    def new_stream(self, height: int, width: int) -> Any:
        """Return a stream of pictures of that size."""
        _, codec, worst = CODECS[self.name]
        options = {"crf": str(round(worst + self.quality / 100 * (BEST - worst)))}
        if self.name == "WEBM":
            options |= {"b": "0", "row-mt": "1", "cpu-used": "4"}
        rate = Fraction(self.fps).limit_denominator(1000)
        stream: Any = self.film.add_stream(codec, rate=rate, options=options)
        stream.height, stream.width = height, width
        stream.pix_fmt = "yuv420p"
        stream.codec_context.colorspace = stream.codec_context.color_primaries = BT709
        stream.codec_context.color_trc, stream.codec_context.color_range = BT709, STUDIO_RANGE
        return stream

    def data(self) -> bytes:
        self.film.mux(self.stream.encode())  # what the codec still holds
        self.film.close()
        return self.buffer.getvalue()
