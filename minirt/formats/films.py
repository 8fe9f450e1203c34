"""Films in memory: loops by Pillow (GIF, APNG, WebP), and MP4 (H.264) and WebM (VP9) by PyAV (`minirt[video]`).

Both classes take pictures of one size, (h, w, 3) uint8, and raise ValueError where they cannot hold one.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

QUALITY = 80  # of 100
COLOURS = 255  # of each picture of a GIF; Pillow uses one more for pixels that stay as they are
LONGEST = {"GIF": 655_350, "APNG": 65_535, "WEBP": 2**24 - 1}  # milliseconds that a picture can last
OPTIONS: dict[str, dict[str, Any]] = {
    "GIF": {"optimize": True},
    "APNG": {},
    "WEBP": {"method": 0},  # of compression: the fastest
}
CODECS = {"MP4": ("mp4", "libx264"), "WEBM": ("webm", "libvpx-vp9")}
WORST = {"MP4": 45, "WEBM": 58}  # constant rate factors of quality 0; that of quality 100 is 4
BEST = 4
BT709, STUDIO_RANGE = 1, 1  # FFmpeg's numbers of the matrix from RGB, and of levels from 16 to 235


class LoopFilm:
    """A film that loops for ever. Pillow gets all pictures at the end, and stores the rectangles that change.

    A picture that stays as it is lasts longer, so that it takes no place.
    """

    def __init__(self, name: str, fps: float, quality: int) -> None:
        self.name, self.quality = name, quality
        # GIF counts hundredths of a second, and many programs slow down pictures of fewer than two.
        self.each = 10 * max(2, round(100 / fps)) if name == "GIF" else round(1000 / fps)
        self.pictures: list[PillowImage] = []
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
        """Return the bytes of the file."""
        first, *others = self.pictures
        durations = [min(each, LONGEST[self.name]) for each in self.durations]
        options = OPTIONS[self.name] | ({"quality": self.quality} if self.name == "WEBP" else {})
        buffer = io.BytesIO()
        first.save(
            buffer, "PNG" if self.name == "APNG" else self.name, save_all=True, append_images=others,
            duration=durations, loop=0, **options,
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
        with value_errors():
            if self.stream is None:
                self.stream = self.new_stream(*even.shape[:2])
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(even), format="rgb24")
            yuv = self.reformatter.reformat(frame, format="yuv420p", dst_colorspace="ITU709", dst_color_range="MPEG")
            self.film.mux(self.stream.encode(yuv))

    def new_stream(self, height: int, width: int) -> Any:
        """Return a stream of pictures of that size."""
        options = {"crf": str(round(WORST[self.name] + self.quality / 100 * (BEST - WORST[self.name])))}
        if self.name == "WEBM":
            options |= {"b": "0", "row-mt": "1", "cpu-used": "4"}
        rate = Fraction(self.fps).limit_denominator(1000)
        stream: Any = self.film.add_stream(CODECS[self.name][1], rate=rate, options=options)
        stream.height, stream.width = height, width
        stream.pix_fmt = "yuv420p"
        stream.codec_context.colorspace = stream.codec_context.color_primaries = BT709
        stream.codec_context.color_trc, stream.codec_context.color_range = BT709, STUDIO_RANGE
        return stream

    def data(self) -> bytes:
        """Return the bytes of the file, after what the codec still holds."""
        with value_errors():
            self.film.mux(self.stream.encode())
            self.film.close()
        return self.buffer.getvalue()


@contextmanager
def value_errors() -> Iterator[None]:
    """Raise PyAV's errors as ValueError."""
    import av

    try:
        yield
    except av.FFmpegError as error:
        raise ValueError(str(error)) from None
