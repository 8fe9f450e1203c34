"""Pictures in memory, written to files in the formats of `minirt.formats.table`.

Formats of floating-point numbers (EXR, HDR, PFM) hold linear light: exposed, without tone, unclamped. All others hold
levels, to which the tone curve has been applied; those of 16 bits are made of the light, without dithering.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from minirt.errors import RenderError
from minirt.formats import png
from minirt.formats.table import FLOAT, check_bits, check_quality, format_of, told_encoding_errors
from minirt.helpers import file_io
from minirt.kernel.functions import copy_levels
from minirt.kernel.machine_code.library import bound

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray
    from PIL.Image import Image as PillowImage

    from minirt.rendering.outcome import Outcome
    from minirt.rendering.threads import Run

DEEP = 2**16  # levels of 16 bits


def rgb_of(pixels: np.ndarray, run: Run = lambda job: job()) -> np.ndarray:
    """Return red, green and blue, (h, w, 3), of pixels (h, w, 4) in the order blue, green, red, alpha; `run` runs a job
    on all threads."""
    height, width, _ = pixels.shape
    levels, lines = np.empty((height, width, 3), np.uint8), np.ascontiguousarray(pixels).reshape(height, 4 * width)
    run(bound(copy_levels, np.zeros(1, np.int64), lines, levels.reshape(height, 3 * width)))
    return levels


@dataclass(frozen=True, eq=False)
class Image:
    """A picture; notebooks display it."""

    array: NDArray[np.uint8]  # (h, w, 3) RGB
    linear: NDArray[np.float64] | None = None  # (h, w, 3) radiance before clamping and rounding
    reached: Outcome | None = None  # samples and estimated error of a picture with samples="auto"
    tone: str = "plain"  # the curve from `linear` to `array`
    not_finite: int = 0  # rays whose light was infinite or NaN, and is 0 in the picture

    @classmethod
    def from_bgra(cls, pixels: np.ndarray) -> Image:
        """Make a picture of a frame buffer, (h, w, 4) in the order blue, green, red, alpha."""
        return cls(rgb_of(pixels))

    @cached_property
    def pil(self) -> PillowImage:
        """The picture as a Pillow image."""
        from PIL import Image as pillow  # noqa: N813

        return pillow.fromarray(self.array)

    @property
    def deep(self) -> np.ndarray:
        """The picture with 16 bits a channel, (h, w, 3) uint16, made of its light; RenderError without light."""
        from minirt.rendering.tone_mapping import tone_named

        light, curve = self.light("16 bits"), tone_named(self.tone, DEEP)
        levels = np.empty(light.shape, np.uint16)
        for into, row in zip(levels, light, strict=True):
            into[...] = np.searchsorted(curve.halfway, row, "right")
        return levels

    def channels(self, bits: int) -> np.ndarray:
        """Return the picture with 8 or 16 bits a channel, or its light as float32; RenderError without light."""
        if bits == FLOAT:
            return self.light(f"{FLOAT} bits").astype(np.float32)
        return self.array if bits == 8 else self.deep

    def light(self, what: str) -> np.ndarray:
        """Return the linear light; RenderError, which says that `what` needs it, where the picture has none."""
        if self.linear is None:
            raise RenderError(f"{what} need linear light, and this picture has levels of 8 bits alone")
        return self.linear

    def encode(
        self,
        name: str = "PNG",
        *,
        bits: int | None = None,
        quality: int | None = None,
        texts: Mapping[str, str] | None = None,
    ) -> bytes:
        """Return the bytes of a file in a format of `minirt.formats.table`; RenderError when it cannot hold the
        picture.

        `bits` a channel are 8 or 16 for PNG and TIFF, or 32 for the light in a TIFF file; None is the format's own: 8,
        or 32 for EXR, HDR and PFM. `quality`, from 1 to 100, is for lossy formats. A PNG file, and no other, carries
        `texts`, by their keywords.
        """
        from minirt.formats import floats, tiff

        bits = check_bits(name, bits)
        check_quality(name, quality)
        with told_encoding_errors("picture", name):
            if name == "PNG":
                return png.encode(self.channels(bits), texts)
            if name == "TIFF" and bits != 8:
                return tiff.encode(self.channels(bits))
            if bits == FLOAT:
                return floats.ENCODERS[name](self.light(f"{FLOAT} bits"))
            buffer = io.BytesIO()
            options = {} if quality is None else {"quality": quality}
            self.pil.save(buffer, "PNG" if name == "APNG" else name, **options)
            return buffer.getvalue()

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        bits: int | None = None,
        quality: int | None = None,
        texts: Mapping[str, str] | None = None,
    ) -> None:
        """Write a file in the format of its extension, as a whole or not at all; RenderError when that fails.

        The arguments are those of `encode`.
        """
        data = self.encode(format_of(path), bits=bits, quality=quality, texts=texts)
        with file_io.told_errors(path):
            file_io.write(path, data)

    def _repr_png_(self) -> bytes:
        """Return the picture as PNG; notebooks call this."""
        return self.encode()

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> np.ndarray:
        """Return `array` to `numpy.asarray`, which shares its memory."""
        if copy:
            return np.array(self.array, dtype)
        return np.asarray(self.array, dtype)

    def __repr__(self) -> str:
        height, width = self.array.shape[:2]
        is_lit = vars(self).get("linear", self) is not None  # without asking for it
        return f"<Image of {width}x{height} pixels{', with linear light' if is_lit else ''}>"


class LinearImage(Image):
    """A picture with its linear light, which may be made when it is asked for: then the picture is rendered again."""

    again: Callable[[], Image]  # renders it with light

    @classmethod
    def lit_on_demand(cls, image: Image, again: Callable[[], Image]) -> LinearImage:
        """Return the same picture with the light of one that is rendered when it is needed."""
        made = cls(**vars(image))
        del vars(made)["linear"]
        vars(made)["again"] = again
        return made

    if TYPE_CHECKING:
        linear: NDArray[np.float64]  # (h, w, 3) radiance before clamping and rounding
    else:

        @cached_property
        def linear(self) -> np.ndarray:
            """The light of the picture, rendered again."""
            return self.again().linear

    def __getstate__(self) -> dict[str, Any]:
        """Return the attributes, with the light, for a copy that may be far from the files of the scene."""
        return {"linear": self.linear} | {name: value for name, value in vars(self).items() if name != "again"}
