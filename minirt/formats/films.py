"""Writers of films: loops by Pillow (GIF, APNG, WebP), and MP4 (H.264) and WebM (VP9) by PyAV (`minirt[video]`)."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any, BinaryIO

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


class Film:
    """A film that is being written to a file, which can seek: one picture after the other, all of one size."""

    def __init__(self, out: BinaryIO, name: str, fps: float, quality: int | None = None) -> None:
        """Write so many pictures a second in a format; `quality`, from 1 to 100, is for lossy formats."""
        self.out = out
        self.name = name
        self.fps = fps
        self.quality = quality

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8. OSError or ValueError when that fails."""
        raise NotImplementedError

    def end(self) -> None:
        """Write the end of a film that has pictures. OSError or ValueError when that fails."""

    def close(self) -> None:
        """Free what a film holds, whether it has its end or not."""


def new_film(out: BinaryIO, name: str, fps: float, quality: int | None = None) -> Film:
    """Return a film of a format; see `Film`."""
    return (VideoFilm if name in CODECS else LoopFilm)(out, name, fps, quality)


class LoopFilm(Film):
    """A film that loops for ever. Pillow gets all pictures at the end, and stores the rectangles that change.

    A picture that stays as it is lasts longer, so that it takes no place.
    """

    def __init__(self, out: BinaryIO, name: str, fps: float, quality: int | None = None) -> None:
        super().__init__(out, name, fps, quality)
        # GIF counts hundredths of a second, and many programs slow down pictures of fewer than two.
        self.each = 10 * max(2, round(100 / fps)) if name == "GIF" else round(1000 / fps)
        self.pictures: list[PillowImage] = []
        self.durations: list[int] = []  # milliseconds
        self.last: np.ndarray | None = None

    def add(self, picture: np.ndarray) -> None:
        """Keep a picture, (h, w, 3) uint8, until the end."""
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

    def end(self) -> None:
        """Write the file."""
        first, *others = self.pictures
        durations = [min(each, LONGEST[self.name]) for each in self.durations]
        options = OPTIONS[self.name]
        if self.name == "WEBP":
            options = options | {"quality": QUALITY if self.quality is None else self.quality}
        buffer = io.BytesIO()
        first.save(
            buffer, "PNG" if self.name == "APNG" else self.name, save_all=True, append_images=others,
            duration=durations, loop=0, **options,
        )  # fmt: skip
        self.out.write(buffer.getbuffer())


class FailingOnce:
    """A file that fails at most once: PyAV raises the first error, and prints those that follow with their traceback.

    After an error it takes everything and keeps nothing.
    """

    def __init__(self, out: BinaryIO) -> None:
        self.out = out
        self.has_failed = False

    def write(self, data: bytes) -> int:
        """Write data."""
        return self.attempt(self.out.write, data, otherwise=len(data))

    def seek(self, offset: int, whence: int = 0) -> int:
        """Move to a place."""
        return self.attempt(self.out.seek, offset, whence, otherwise=offset)

    def tell(self) -> int:
        """Return the place."""
        return self.attempt(self.out.tell, otherwise=0)

    def seekable(self) -> bool:
        """Whether it can move: always."""
        return True

    def writable(self) -> bool:
        """Whether it can be written: always."""
        return True

    def attempt(self, action: Callable[..., int], *given: object, otherwise: int) -> int:
        """Do something with the file, unless it has failed before. OSError."""
        if self.has_failed:
            return otherwise
        try:
            return action(*given)
        except OSError:
            self.has_failed = True
            raise


class VideoFilm(Film):
    """Writes pictures by a codec. Colours have half the resolution of brightness. So widths and heights are even: odd
    ones gain a row or a column."""

    def __init__(self, out: BinaryIO, name: str, fps: float, quality: int | None = None) -> None:
        import av
        from av.video.reformatter import VideoReformatter

        super().__init__(out, name, fps, quality)
        with value_errors():
            self.film = av.open(FailingOnce(out), "w", format=CODECS[self.name][0])
        self.stream: Any = None
        # One of its own: PyAV 19 shares one among all films, and its threads are gone in a child after `os.fork()`.
        self.reformatter: Any = VideoReformatter()

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8."""
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
        rate = Fraction(self.fps).limit_denominator(1000)
        stream: Any = self.film.add_stream(CODECS[self.name][1], rate=rate, options=options(self.name, self.quality))
        stream.height, stream.width = height, width
        stream.pix_fmt = "yuv420p"
        stream.codec_context.colorspace = stream.codec_context.color_primaries = BT709
        stream.codec_context.color_trc, stream.codec_context.color_range = BT709, STUDIO_RANGE
        return stream

    def end(self) -> None:
        """Write what the codec still holds, and the end of the file."""
        with value_errors():
            self.film.mux(self.stream.encode())
            self.film.close()

    def close(self) -> None:
        """Free the codec."""
        with suppress(ValueError, OSError), value_errors():
            self.film.close()


@contextmanager
def value_errors() -> Iterator[None]:
    """Raise PyAV's errors as ValueError."""
    import av

    try:
        yield
    except av.FFmpegError as error:
        raise ValueError(str(error)) from None


def options(name: str, quality: int | None) -> dict[str, str]:
    """Return the options of the codec for a quality from 1 to 100."""
    share = (QUALITY if quality is None else quality) / 100
    factor = round(WORST[name] + share * (BEST - WORST[name]))
    return {"crf": str(factor), "b": "0", "row-mt": "1", "cpu-used": "4"} if name == "WEBM" else {"crf": str(factor)}
