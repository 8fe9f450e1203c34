"""Calls of MiniLibX for images: new ones, those of files, their memory, and drawing them on a window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from minirt.errors import MlxError
from minirt.mlx.image import Image
from minirt.mlx.options import MaybeNone, integer
from minirt.mlx.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from os import PathLike

    from numpy.typing import NDArray

    from minirt.mlx.options import Integer
    from minirt.mlx.window import Window, WindowHost

    FileName = str | PathLike[str]
    ImageAndSize = tuple[Image | MaybeNone, int, int]  # (None, 0, 0) after a failure

GREATEST = 32767  # pixels of an image's side


class ImageCalls(Settings):
    """The part of `Mlx` for images. `mlx_ptr` is unused, as in MiniLibX."""

    def mlx_new_image(self, mlx_ptr: WindowHost, width: Integer, height: Integer) -> Image | MaybeNone:
        """Return an image that is all transparent, or None for a size below 1 or above 32767 pixels."""
        columns, rows = integer(width), integer(height)
        if not (0 < columns <= GREATEST and 0 < rows <= GREATEST):
            return self._mlx_failed(MlxError(f"an image cannot be of {columns}x{rows} pixels"))
        return Image(np.zeros((rows, columns, 4), np.uint8))

    def mlx_get_data_addr(self, img_ptr: Image) -> tuple[memoryview, int, int, int]:
        """Return (bytes, bits per pixel, bytes per row, 0). The bytes of a pixel are blue, green, red, alpha."""
        return img_ptr.pixels.reshape(-1).data, 32, 4 * img_ptr.width, 0

    def mlx_put_image_to_window(
        self, mlx_ptr: WindowHost, win_ptr: Window, img_ptr: Image, x: Integer, y: Integer
    ) -> int:
        """Blend the image, as it is now, into the window with its top left corner at x, y; alpha 255 is opaque."""
        win_ptr.canvas.put(img_ptr.pixels, integer(x), integer(y))
        return 0

    def mlx_destroy_image(self, mlx_ptr: WindowHost, img_ptr: Image) -> int:
        """Do nothing: Python frees an image without references."""
        return 0

    def mlx_png_file_to_image(self, mlx_ptr: WindowHost, filename: FileName) -> ImageAndSize:
        """Return (image, width, height) of a picture file of any format that Pillow reads."""
        return self._mlx_image_of(lambda: _read_picture(filename))

    def mlx_xpm_file_to_image(self, mlx_ptr: WindowHost, filename: FileName) -> ImageAndSize:
        """Return (image, width, height) of an XPM file."""
        return self._mlx_image_of(lambda: _read_xpm_file(filename))

    def mlx_xpm_to_image(self, mlx_ptr: WindowHost, xpm_data: Sequence[str]) -> ImageAndSize:
        """Return (image, width, height) of the strings of an XPM file."""
        from minirt.mlx.xpm import read_xpm

        return self._mlx_image_of(lambda: read_xpm(xpm_data))

    def _mlx_image_of(self, read: Callable[[], NDArray[np.uint8]]) -> ImageAndSize:
        """Return the image that `read` makes with its size, or (None, 0, 0)."""
        try:
            image = Image(read())
        except MlxError as error:
            return self._mlx_failed(error), 0, 0
        return image, image.width, image.height


def _read_picture(filename: FileName) -> NDArray[np.uint8]:
    """Read a picture file as BGRA. Raises MlxError."""
    from PIL import Image as Pillow

    try:
        with Pillow.open(filename) as picture:
            rgba = np.asarray(picture.convert("RGBA"))
    except (OSError, ValueError, SyntaxError, Pillow.DecompressionBombError) as error:
        raise MlxError(f"{filename} cannot be read as a picture: {error}") from error
    return np.ascontiguousarray(rgba[..., [2, 1, 0, 3]])


def _read_xpm_file(filename: FileName) -> NDArray[np.uint8]:
    """Read an XPM file as BGRA. Raises MlxError."""
    from minirt.mlx.xpm import read_xpm, strings_of

    try:
        return read_xpm(strings_of(Path(filename).read_text(encoding="latin-1")))
    except (OSError, ValueError, MlxError) as error:
        raise MlxError(f"{filename} cannot be read as an XPM picture: {error}") from error
