"""Calls of MiniLibX for hooks, the event loop and images; the options, and what happens on a failure."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minirt.errors import MlxError, printable
from minirt.mlx.arguments import Hook, Host, Integer, MaybeNone, MlxImage, Options, integer, set_hook
from minirt.mlx.display import Display
from minirt.mlx.events import Event
from minirt.mlx.window import Window

FileName = str | PathLike[str]
Switch = bool | None
ImageAndSize = tuple[MlxImage | MaybeNone, int, int]  # (None, 0, 0) after a failure

GREATEST = 32767  # pixels of an image's side


class Calls:
    """Options, hooks, the loop and images of `Mlx`. A hook of None removes the one that was set.

    The attributes' names leave all others to programs, many of which derive their own class from Mlx.
    `mlx_ptr` is unused in the calls for images, as in MiniLibX.
    """

    SYNC_IMAGE_WRITABLE = 1
    SYNC_WIN_FLUSH = 2
    SYNC_WIN_COMPLETED = 3

    def __init__(
        self, backend: Display | None = None, *, alpha: bool = True, strict: bool = False, symbols: bool = False
    ) -> None:
        self._mlx_backend = backend
        self._mlx_options = Options(alpha, strict, symbols)

    def mlx_set_options(
        self, *, alpha: Switch = None, strict: Switch = None, symbols: Switch = None, application: str | None = None
    ) -> int:
        """Change options, `alpha` and `application` for windows that are opened later; None leaves one as it is."""
        given = {"alpha": alpha, "strict": strict, "symbols": symbols, "application": application}
        vars(self._mlx_options).update((name, value) for name, value in given.items() if value is not None)
        return 0

    def _mlx_failed(self, error: MlxError) -> MaybeNone:
        """Raise the error, or print it and return None, as MiniLibX does."""
        if self._mlx_options.strict:
            raise error
        print(f"mlx: {printable(str(error))}", file=sys.stderr)
        return None

    # --- hooks and the loop ---

    def mlx_hook(self, win_ptr: Window, x_event: Integer, x_mask: Integer, callback: Hook | None, param: object) -> int:
        """Set the one hook of an event and window. `Event` lists the arguments before `param`; the mask is unused."""
        return set_hook(win_ptr.hooks, integer(x_event), callback, param)

    def mlx_key_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(keycode, param) when a key is released."""
        return set_hook(win_ptr.hooks, Event.KEY_RELEASE, callback, param)

    def mlx_mouse_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(button, x, y, param) when a button is pressed or the wheel turned."""
        return set_hook(win_ptr.hooks, Event.BUTTON_PRESS, callback, param)

    def mlx_expose_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(param) when the window has to be drawn; its earlier content is still there."""
        return set_hook(win_ptr.hooks, Event.EXPOSE, callback, param)

    def mlx_loop_hook(self, mlx_ptr: Display, callback: Hook | None, param: object) -> int:
        """Call callback(param) about 60 times a second; with None the loop sleeps until an event."""
        return set_hook(mlx_ptr.hooks, "loop", callback, param)

    def mlx_loop(self, mlx_ptr: Display) -> int:
        """Run until `mlx_loop_exit` or until no window is left. Ctrl+C raises KeyboardInterrupt.

        The exception of a hook is printed, and the loop goes on; with the option `strict` it is raised from here.
        """
        mlx_ptr.loop()
        return 0

    def mlx_loop_exit(self, mlx_ptr: Display) -> int:
        """End the loop, or the next one where none runs; no hook is called after this."""
        mlx_ptr.ending = True
        return 0

    mlx_loop_end = mlx_loop_exit

    def mlx_do_sync(self, mlx_ptr: Display) -> int:
        """Show all windows as they are drawn now."""
        for window in mlx_ptr.windows:
            window.show()
        return 0

    def mlx_sync(self, mlx_ptr: Display, cmd: Integer, img_or_win_ptr: MlxImage | Window) -> int:
        """Show a window now, or later if it is hidden. `cmd` is one of SYNC_…; images are always writable."""
        if isinstance(img_or_win_ptr, Window) and img_or_win_ptr.is_open and img_or_win_ptr.visible:
            img_or_win_ptr.show()
        return 0

    # --- images ---

    def mlx_new_image(self, mlx_ptr: Host, width: Integer, height: Integer) -> MlxImage | MaybeNone:
        """Return an image that is all transparent, or None for a size below 1 or above 32767 pixels."""
        columns, rows = integer(width), integer(height)
        if not (0 < columns <= GREATEST and 0 < rows <= GREATEST):
            return self._mlx_failed(MlxError(f"an image cannot be of {columns}x{rows} pixels"))
        return MlxImage(np.zeros((rows, columns, 4), np.uint8))

    def mlx_get_data_addr(self, img_ptr: MlxImage) -> tuple[memoryview, int, int, int]:
        """Return (bytes, bits per pixel, bytes per row, 0). The bytes of a pixel are blue, green, red, alpha."""
        return img_ptr.pixels.reshape(-1).data, 32, 4 * img_ptr.width, 0

    def mlx_put_image_to_window(
        self, mlx_ptr: Host, win_ptr: Window, img_ptr: MlxImage | None, x: Integer, y: Integer
    ) -> int | MaybeNone:
        """Blend the image, as it is now, into the window with its top left corner at x, y; alpha 255 is opaque. The
        image that could not be read, None, is told."""
        if img_ptr is None:
            return self._mlx_failed(MlxError("mlx_put_image_to_window got None in place of an image"))
        win_ptr.canvas.put(img_ptr.pixels, integer(x), integer(y))
        return 0

    def mlx_destroy_image(self, mlx_ptr: Host, img_ptr: MlxImage) -> int:
        """Do nothing: Python frees an image without references."""
        return 0

    def mlx_png_file_to_image(self, mlx_ptr: Host, filename: FileName) -> ImageAndSize:
        """Return (image, width, height) of a picture file of any format that Pillow reads."""
        return self._mlx_image_of(filename, lambda: _read_picture(filename))

    def mlx_xpm_file_to_image(self, mlx_ptr: Host, filename: FileName) -> ImageAndSize:
        """Return (image, width, height) of an XPM file."""
        return self._mlx_image_of(filename, lambda: _read_xpm(Path(filename).read_bytes()))

    def mlx_xpm_to_image(self, mlx_ptr: Host, xpm_data: Sequence[str]) -> ImageAndSize:
        """Return (image, width, height) of the strings of an XPM file."""
        strings = (text.encode("latin-1", "replace") for text in xpm_data)
        return self._mlx_image_of("the strings of an XPM file", lambda: _read_xpm(strings))

    def _mlx_image_of(self, name: FileName, read: Callable[[], NDArray[np.uint8]]) -> ImageAndSize:
        """Return the image that `read` makes, in BGRA, with its size, or (None, 0, 0)."""
        try:
            image = MlxImage(read())
        except Exception as error:  # decoders have errors of many kinds
            return self._mlx_failed(MlxError(f"{name} cannot be read as a picture: {error}")), 0, 0
        return image, image.width, image.height


def _read_picture(filename: FileName) -> NDArray[np.uint8]:
    from PIL import Image as Pillow

    with Pillow.open(filename) as picture:
        return np.ascontiguousarray(np.asarray(picture.convert("RGBA"))[..., [2, 1, 0, 3]])


def _read_xpm(source: bytes | Iterator[bytes]) -> NDArray[np.uint8]:
    from minirt.formats.xpm import read_header, read_pixels, strings_of

    strings = strings_of(source) if isinstance(source, bytes) else source
    return read_pixels(strings, read_header(strings))
