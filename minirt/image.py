"""Pictures in memory, written to PNG, and to other formats by Pillow."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from minirt import atomic_write, png
from minirt.errors import RenderError

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

    from minirt.rendering.sampling.outcome import Outcome


def format_of(path: str | os.PathLike[str]) -> str:
    """Return Pillow's name of the format of a file extension; RenderError when Pillow cannot write it."""
    suffix = Path(path).suffix.lower()
    if suffix == ".png":  # without Pillow, which loads the plug-ins of all formats to answer
        return "PNG"
    from PIL import Image as pillow  # noqa: N813

    name = pillow.registered_extensions().get(suffix, "")
    if name not in pillow.SAVE:
        raise RenderError(f"{os.fspath(path)}: cannot write pictures with the extension '{suffix}', try .png")
    return name


@dataclass(frozen=True, eq=False)
class Image:
    """A picture; notebooks display it."""

    array: np.ndarray  # (h, w, 3) uint8, RGB
    linear: np.ndarray | None = None  # (h, w, 3) float64, radiance before clamping and rounding
    reached: Outcome | None = None  # samples and estimated error of a picture with samples="auto"

    @classmethod
    def from_bgra(cls, pixels: np.ndarray, linear: np.ndarray | None = None, reached: Outcome | None = None) -> Image:
        """Make a picture of a frame buffer, (h, w, 4) in the order blue, green, red, alpha."""
        return cls(np.ascontiguousarray(pixels[..., 2::-1]), linear, reached)

    @cached_property
    def pil(self) -> PillowImage:
        """The picture as a Pillow image."""
        from PIL import Image as pillow  # noqa: N813

        return pillow.fromarray(self.array)

    def encode(self, name: str = "PNG") -> bytes:
        """Return the bytes of a file in a format of Pillow; RenderError when the format cannot hold the picture."""
        buffer = io.BytesIO()
        try:
            if name == "PNG":
                return png.encode(self.array)
            self.pil.save(buffer, name)
        except (OSError, ValueError, KeyError) as error:
            raise RenderError(f"cannot write this picture as {name}: {error}") from None
        return buffer.getvalue()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file in the format of its extension, as a whole or not at all; RenderError when that fails."""
        data = self.encode(format_of(path))
        try:
            atomic_write.write(path, data)
        except OSError as error:
            raise RenderError(f"{os.fspath(path)}: cannot write: {error.strerror or error}") from None

    def _repr_png_(self) -> bytes:
        """Return the picture as PNG; notebooks call this."""
        return self.encode()
