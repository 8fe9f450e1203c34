"""Pictures: pixels in memory, and PNG and friends outside of it (Pillow)."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from minirt import atomic_write
from minirt.errors import RenderError

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

    from minirt.rendering.sampling.outcome import Outcome


def format_of(path: str | os.PathLike[str]) -> str:
    """Pillow's name of the format that a file name's extension stands for; RenderError where it can write none."""
    from PIL import Image as pillow  # noqa: N813

    suffix = Path(path).suffix.lower()
    name = pillow.registered_extensions().get(suffix, "")
    if name not in pillow.SAVE:
        raise RenderError(f"{os.fspath(path)}: cannot write pictures with the extension '{suffix}', try .png")
    return name


@dataclass(frozen=True, eq=False)
class Image:
    """A picture; in a notebook it shows itself."""

    array: np.ndarray  # (h, w, 3) uint8, red green blue
    linear: np.ndarray | None = None  # (h, w, 3) float64, the light before it was clamped and rounded
    reached: Outcome | None = None  # samples and estimated error, where an error or a time was asked for

    @classmethod
    def from_bgra(cls, pixels: np.ndarray, linear: np.ndarray | None = None, reached: Outcome | None = None) -> Image:
        """The picture in a framebuffer (h, w, 4) in the order blue, green, red, alpha."""
        return cls(np.ascontiguousarray(pixels[..., 2::-1]), linear, reached)

    @cached_property
    def pil(self) -> PillowImage:
        """The picture as an image of Pillow."""
        from PIL import Image as pillow  # noqa: N813

        return pillow.fromarray(self.array)

    def encode(self, name: str = "PNG") -> bytes:
        """The picture as a file of a format of Pillow; RenderError where that format cannot hold it."""
        buffer = io.BytesIO()
        try:
            self.pil.save(buffer, name)
        except (OSError, ValueError, KeyError) as error:
            raise RenderError(f"cannot write this picture as {name}: {error}") from None
        return buffer.getvalue()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file in the format of its extension, as a whole or not at all; RenderError where that fails."""
        data = self.encode(format_of(path))
        try:
            atomic_write.write(path, data)
        except OSError as error:
            raise RenderError(f"{os.fspath(path)}: cannot write: {error.strerror or error}") from None

    def _repr_png_(self) -> bytes:
        return self.encode()
