"""Mlx: MiniLibX's functions under their own names, with the arguments and results of its official Python wrapper.

    m = Mlx()
    mlx = m.mlx_init()
    win = m.mlx_new_window(mlx, 640, 480, "hello")
    m.mlx_string_put(mlx, win, 10, 10, 0xFFFFFF, "press a key")
    m.mlx_key_hook(win, lambda key, _: m.mlx_loop_exit(mlx), None)
    m.mlx_loop(mlx)

Handles, which are numbers in the wrapper, are objects here: `Display`, `Window`, `Image`. Failures raise MlxError.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from minirt.errors import MlxError
from minirt.mlx.display import Display
from minirt.mlx.events import Event
from minirt.mlx.extensions import Extensions
from minirt.mlx.image import Image
from minirt.mlx.text import draw_text
from minirt.mlx.window import Window

if TYPE_CHECKING:
    from os import PathLike

    from minirt.mlx.backend import Backend
    from minirt.mlx.hooks import Hook
    from minirt.mlx.window import WindowHost


class Mlx(Extensions):
    """MiniLibX's functions as methods; those without a result return 0. Colours are 0xAARRGGBB; x goes right, y down.

    backend: the window system; None is the screen, `minirt.mlx.memory.Memory()` needs none.
    """

    SYNC_IMAGE_WRITABLE = 1
    SYNC_WIN_FLUSH = 2
    SYNC_WIN_COMPLETED = 3

    def __init__(self, backend: Backend | None = None) -> None:
        self._backend = backend

    # --- opening and closing ---

    def mlx_init(self) -> Display:
        """Open the display. Raises MlxError with the reason if there is none."""
        backend = self._backend or _pyglet_backend()
        display = Display(backend)
        backend.open(display)
        return display

    def mlx_release(self, mlx: Display) -> int:
        """Close all windows and the display."""
        mlx.close()
        return 0

    mlx_destroy_display = mlx_release

    def mlx_new_window(self, mlx: Display, width: int, height: int, title: str, *, resizable: bool = False) -> Window:
        """Open a window; several may be open. A resizable window may get another size: read it back."""
        if width < 1 or height < 1:
            raise MlxError(f"a window of {width}x{height} pixels cannot be opened")
        window = Window(mlx, width, height, title, resizable)
        mlx.backend.open_window(window)
        mlx.windows.append(window)
        mlx.show(window)
        return window

    def mlx_destroy_window(self, mlx: Display, win: Window) -> int:
        """Close a window. May be called inside any hook, and twice for the same window."""
        mlx.destroy(win)
        return 0

    # --- drawing on a window, which is shown at the end of the loop's turn; `mlx` is unused, as in MiniLibX ---

    def mlx_clear_window(self, mlx: WindowHost, win: Window) -> int:
        win.canvas.clear()
        return 0

    def mlx_pixel_put(self, mlx: WindowHost, win: Window, x: int, y: int, color: int) -> int:
        win.canvas.point(x, y, color)
        return 0

    def mlx_string_put(self, mlx: WindowHost, win: Window, x: int, y: int, color: int, string: str) -> int:
        """Draw text with its top left corner at x, y."""
        canvas = win.canvas
        width, height = draw_text(canvas.pixels, x, y, string, color)
        canvas.touch(x, y, x + width, y + height)
        return 0

    def mlx_put_image_to_window(self, mlx: WindowHost, win: Window, img: Image, x: int, y: int) -> int:
        """Copy the image into the window with its top left corner at x, y. Alpha is ignored."""
        win.canvas.put(img.pixels, x, y)
        return 0

    # --- images ---

    def mlx_new_image(self, mlx: WindowHost, width: int, height: int) -> Image:
        return Image(np.zeros((height, width, 4), np.uint8))

    def mlx_get_data_addr(self, img: Image) -> tuple[memoryview, int, int, int]:
        """Return (bytes, bits per pixel, bytes per row, 0). The bytes of a pixel are blue, green, red, alpha."""
        return img.pixels.reshape(-1).data, 32, 4 * img.width, 0

    def mlx_destroy_image(self, mlx: Display, img: Image) -> int:
        """Do nothing: Python frees an image without references."""
        return 0

    def mlx_png_file_to_image(self, mlx: Display, filename: str | PathLike[str]) -> tuple[Image, int, int]:
        """Return (image, width, height) of a picture file. Raises MlxError if it cannot be read."""
        from PIL import Image as Pillow

        try:
            with Pillow.open(filename) as picture:
                rgba = np.asarray(picture.convert("RGBA"))
        except (OSError, ValueError, SyntaxError) as error:
            raise MlxError(f"{filename} cannot be read as a picture: {error}") from error
        image = Image(np.ascontiguousarray(rgba[..., [2, 1, 0, 3]]))
        return image, image.width, image.height

    mlx_xpm_file_to_image = mlx_png_file_to_image

    # --- hooks and the loop ---

    def mlx_hook(self, win: Window, x_event: int, x_mask: int, f: Hook | None, param: object) -> int:
        """Set the one hook of an event and window; None removes it. `Event` lists the arguments before `param`."""
        if f is None:
            win.hooks.pop(x_event, None)
        else:
            win.hooks[x_event] = (f, param)
        return 0

    def mlx_key_hook(self, win: Window, f: Hook | None, param: object) -> int:
        """Call f(keycode, param) when a key is released."""
        return self.mlx_hook(win, Event.KEY_RELEASE, 0, f, param)

    def mlx_mouse_hook(self, win: Window, f: Hook | None, param: object) -> int:
        """Call f(button, x, y, param) when a button is pressed or the wheel turned."""
        return self.mlx_hook(win, Event.BUTTON_PRESS, 0, f, param)

    def mlx_expose_hook(self, win: Window, f: Hook | None, param: object) -> int:
        """Call f(param) when the window has to be drawn; its earlier content is still there."""
        return self.mlx_hook(win, Event.EXPOSE, 0, f, param)

    def mlx_loop_hook(self, mlx: Display, f: Hook | None, param: object) -> int:
        """Call f(param) about 60 times a second; with None the loop sleeps until an event."""
        mlx.loop_hook = None if f is None else (f, param)
        return 0

    def mlx_loop(self, mlx: Display) -> int:
        """Run until `mlx_loop_exit` or until no window is left. Raises the exception of a hook."""
        mlx.loop()
        return 0

    def mlx_loop_exit(self, mlx: Display) -> int:
        """End the loop; no hook is called after this."""
        mlx.ending = True
        return 0

    mlx_loop_end = mlx_loop_exit

    def mlx_do_sync(self, mlx: Display) -> int:
        """Show all windows as they are drawn now."""
        for window in mlx.windows:
            mlx.show(window)
        return 0

    def mlx_sync(self, mlx: Display, cmd: int, img_or_win: Image | Window) -> int:
        """Show a window now, or later if it is hidden. `cmd` is one of SYNC_…; images are always writable."""
        if isinstance(img_or_win, Window) and img_or_win.is_open and img_or_win.visible:
            mlx.show(img_or_win)
        return 0

    # --- mouse, keyboard, screen ---

    def mlx_mouse_get_pos(self, win: Window) -> tuple[int, int, int]:
        """Return (0, x, y) of the pointer, as of the last event."""
        return 0, *win.pointer

    def mlx_mouse_move(self, win: Window, x: int, y: int) -> int:
        win.display.backend.move_pointer(win, x, y)
        return 0

    def mlx_mouse_hide(self, mlx: Display) -> int:
        for window in mlx.windows:
            mlx.backend.show_pointer(window, False)
        return 0

    def mlx_mouse_show(self, mlx: Display) -> int:
        for window in mlx.windows:
            mlx.backend.show_pointer(window, True)
        return 0

    def mlx_do_key_autorepeaton(self, mlx: Display) -> int:
        """Let held keys repeat, each time as a release and a press; off by default, and in this program only."""
        mlx.autorepeat = True
        return 0

    def mlx_do_key_autorepeatoff(self, mlx: Display) -> int:
        mlx.autorepeat = False
        return 0

    def mlx_get_screen_size(self, mlx: Display) -> tuple[int, int, int]:
        """Return (0, width, height) of the screen in pixels."""
        return 0, *mlx.backend.screen_size()


def _pyglet_backend() -> Backend:
    """Make the back end on a real screen, imported only now because its import opens the display."""
    from minirt.mlx.on_pyglet.interrupt import signal_handlers_preserved

    try:
        with signal_handlers_preserved():
            from minirt.mlx.on_pyglet.loop import PygletBackend
    except Exception as error:  # any error of the window system means that there is no window
        missing = type(error).__name__ == "NoSuchDisplayException" and not os.environ.get("DISPLAY")
        reason = "there is no display" if missing else str(error) or type(error).__name__
        raise MlxError(f"no window can be opened ({reason}); -o FILE renders without one") from error
    return PygletBackend()
